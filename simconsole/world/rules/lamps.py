"""Which lamps of the drawn traffic lights shine at a tick: those of their programs, as `timetable` has them."""

from collections.abc import Sequence
from typing import Final, NamedTuple

from simconsole.world.drawing_layers import Light
from simconsole.world.roads.road_map import Phase, Program, Signal
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
        self._running: Signals | None = None

    def lit(self, tick: int, tick_hz: int) -> list[Lit]:
        """Return the lamps that shine at a tick; one that blinks does so once a second."""
        if self._running is None or self._running.tick_hz != tick_hz:
            self._running = Signals(self._signals, tick_hz)
        found: list[Lit] = []
        for number, place in enumerate(self._places):
            letter = self._running.letters(number, tick)
            if letter == _BLINKS and 2 * (tick % tick_hz) >= tick_hz:
                continue
            found += [Lit(place, lamp) for lamp in _SHINING.get(letter, ())]
        return found
