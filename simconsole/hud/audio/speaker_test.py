"""`simconsole devices speakers`: a tone from each loudspeaker in turn, by its name."""

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from simconsole.hud.audio.player import BLOCK, POLL_S
from simconsole.hud.audio.speakers import Loudspeakers
from simconsole.hud.sound.directions import CHANNELS, LOW, NAMES
from simconsole.hud.sound.loops import RATE_HZ

TONE_S: Final = 1.0
GAP_S: Final = 0.3
TONE_HZ: Final = 440.0
LOW_TONE_HZ: Final = 50.0
LEVEL: Final = 0.4
EDGE_S: Final = 0.02


def play_tones(speakers: Loudspeakers, say: Callable[[str], None], pause: Callable[[float], None]) -> dict[str, Any]:
    """Play a tone on each of six loudspeakers and say which."""
    for channel, name in enumerate(NAMES):
        say(name)
        tone_hz = LOW_TONE_HZ if channel == LOW else TONE_HZ
        times_s = np.arange(round((TONE_S + GAP_S) * RATE_HZ)) / RATE_HZ
        inside_s = np.minimum(times_s, TONE_S - times_s)
        tone = LEVEL * np.clip(inside_s / EDGE_S, 0.0, 1.0) * np.sin(2.0 * math.pi * tone_hz * times_s)
        columns = np.zeros((len(tone), CHANNELS), np.float32)
        columns[:, channel] = tone
        for start in range(0, len(columns), BLOCK):
            while not speakers.wants():
                pause(POLL_S)
            speakers.play(columns[start : start + BLOCK])
    return {"loudspeakers": list(NAMES), "starved": speakers.starved}
