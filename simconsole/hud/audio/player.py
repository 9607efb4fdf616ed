"""Keeps loudspeakers supplied: a block whenever there is room for one."""

from collections.abc import Callable
from typing import Final

from simconsole.hud.audio.speakers import Loudspeakers
from simconsole.hud.sound.heard import Heard
from simconsole.hud.sound.mix import Mixer

BLOCK: Final = 1024
"""Samples: 21 ms. One sounds and one waits, so a process may be held up for that long before there is a gap."""
POLL_S: Final = 0.003


def play(
    heard: Callable[[], Heard],
    mixer: Mixer,
    speakers: Loudspeakers,
    stop: Callable[[], bool],
    pause: Callable[[float], None],
) -> None:
    """Play what is heard until `stop`.

    Args:
        heard: the newest moment.
        mixer: makes sound of it.
        speakers: where it goes.
        stop: asked before each look at the loudspeakers.
        pause: waits for so many s.
    """
    while not stop():
        if speakers.wants():
            speakers.play(mixer.block(heard(), BLOCK))
        else:
            pause(POLL_S)
