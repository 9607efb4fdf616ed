"""Which lamps of the drawn traffic lights shine at a tick: those of their programs, as `timetable` has them.

Where another simulator runs the signals, it says which.
"""

from collections.abc import Sequence
from typing import Final, NamedTuple

from simconsole.world.drawing_layers import Light
from simconsole.world.roads.road_map import Phase, Program, Signal
from simconsole.world.roads.running import NONE_RUNNING, RunningNow
from simconsole.world.rules.timetable import Signals

RED: Final = 0
AMBER: Final = 1
GREEN: Final = 2
_SHINING: Final[dict[str, tuple[int, ...]]] = {
    "r": (RED,),
    "s": (RED,),
    "u": (RED, AMBER),
    "y": (AMBER,),
    "Y": (AMBER,),
    "o": (AMBER,),
    "g": (GREEN,),
    "G": (GREEN,),
}
"""By SUMO's letters; a light that is switched off, or of no program, shows none."""
_BLINKS: Final = "o"


class Lit(NamedTuple):
    """A lamp that shines: of which light, by its place, and which of its three."""

    light: int
    lamp: int


class Lamps:
    """The lamps of some lights."""

    def __init__(self, lights: Sequence[Light]) -> None:
        self._places = [place for place, light in enumerate(lights) if light.program is not None]
        programs = [light.program for light in lights if light.program is not None]
        self._signals = [
            Signal(one.signal, (Program("", "", one.offset_s, tuple(map(Phase, one.durations_s, one.letters))),))
            for one in programs
        ]
        self._links = [(one.signal, one.link) for one in programs]
        self._running: Signals | None = None

    def lit(self, tick: int, tick_hz: int, running: RunningNow = NONE_RUNNING) -> list[Lit]:
        """Return the lamps that shine at a tick; one that blinks does so once a second.

        `running` are the signals as another simulator runs them then; of one that it does not know none shines.
        """
        if self._running is None or self._running.tick_hz != tick_hz:
            self._running = Signals(self._signals, tick_hz)
        found: list[Lit] = []
        for number, place in enumerate(self._places):
            letter = self._running.letters(number, tick) if not running else _shown(running, *self._links[number])
            if letter == _BLINKS and 2 * (tick % tick_hz) >= tick_hz:
                continue
            found += [Lit(place, lamp) for lamp in _SHINING.get(letter, ())]
        return found


def _shown(running: RunningNow, signal: str, link: int) -> str:
    one = running.get(signal)
    return one.letters[link] if one is not None and link < len(one.letters) else ""
