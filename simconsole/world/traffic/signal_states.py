"""What signals show: the states of their links at a time, and what these ask of whoever comes to them."""

from bisect import bisect_right
from collections.abc import Callable, Sequence
from itertools import accumulate
from typing import Final, NamedTuple

import numpy as np

from simconsole.world.roads.road_map import Program, RoadMap
from simconsole.world.traffic.junctions import GIVE_WAY, GO, STOP, STOP_IF_POSSIBLE
from simconsole.world.traffic.network import Numbers

SignalStates = Callable[[float], Sequence[str]]
"""Returns what each signal of the map shows at a time (s): one letter, as SUMO writes them, for each of its links."""

_MEANINGS: Final = {"G": GO, "g": GIVE_WAY, "o": GIVE_WAY, "O": GIVE_WAY, "y": STOP_IF_POSSIBLE, "Y": STOP_IF_POSSIBLE}


def by_programs(road_map: RoadMap) -> SignalStates:
    """Return the states of signals that run the first program of each for ever."""
    tables = [_table(signal.programs[0]) if signal.programs else _DARK for signal in road_map.signals]
    return lambda time_s: [_shown(one, time_s) for one in tables]


class _Table(NamedTuple):
    """A program: its phases' states, and when each ends."""

    offset_s: float
    ends_s: list[float]
    states: list[str]


_DARK: Final = _Table(0.0, [1.0], [""])


def _table(program: Program) -> _Table:
    ends = list(accumulate(phase.duration_s for phase in program.phases))
    states = [phase.state for phase in program.phases]
    return _Table(program.offset_s, ends, states) if ends[-1] > 0.0 else _Table(0.0, [1.0], states[-1:])


def _shown(table: _Table, time_s: float) -> str:
    return table.states[bisect_right(table.ends_s, (time_s - table.offset_s) % table.ends_s[-1])]


class Lights:
    """What the signals of a map ask at each of its connections."""

    def __init__(self, road_map: RoadMap, states: SignalStates) -> None:
        self._links = [(one.signal, one.link) for one in road_map.connections]
        self._states = states
        self.shown: Sequence[str] | None = None
        self._lights: Numbers = np.full(len(self._links), GIVE_WAY, np.int64)

    def at(self, time_s: float) -> Numbers:
        """Return GO, GIVE_WAY, STOP_IF_POSSIBLE or STOP for each connection."""
        shown = self._states(time_s)
        if shown != self.shown:
            self.shown = shown
            self._lights[:] = [self._meaning(shown, signal, link) for signal, link in self._links]
        return self._lights

    def _meaning(self, shown: Sequence[str], signal: int, link: int) -> int:
        if not 0 <= signal < len(shown) or not 0 <= link < len(shown[signal]):
            return GIVE_WAY
        return _MEANINGS.get(shown[signal][link], STOP)
