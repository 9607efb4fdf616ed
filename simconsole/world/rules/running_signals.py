"""The signals of a map as another simulator runs them: what they show as of its last step."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from simconsole.values.signals import FAR, SignalState
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.roads.running import NONE_RUNNING, Running, RunningNow, changes
from simconsole.world.rules.approaches import Approach
from simconsole.world.rules.road_signals import NEVER_S, RoadSignals, SignalShown, green_times
from simconsole.world.rules.timetable import PERMISSIVENESS, greens, state_of


class Shown(NamedTuple):
    """What some links of a signal show together."""

    state: SignalState  # the most permissive of theirs
    next_state: SignalState
    change_tick: float  # when it changes, as far as the program says; FAR: never, or nobody knows


class RunningSignals(RoadSignals):
    """Another simulator's signals, in the words of our own; `take` renews them after each of its steps.

    As long as it runs none, and once it has failed, they run the map's own programs.
    """

    def __init__(self, road_map: RoadMap, tick_hz: int, newest: Callable[[], RunningNow] | None = None) -> None:
        """Take the signals by `take` or, for those who ask now and then, whatever `newest` returns."""
        super().__init__(road_map, tick_hz)
        self._names = [signal.id for signal in road_map.signals]
        self._tick_hz = tick_hz
        self._newest = newest
        self.now: RunningNow = NONE_RUNNING
        self._told: RunningNow = NONE_RUNNING

    def take(self, now: RunningNow) -> None:
        """Take what the simulator's signals show now, all of them; none: it has failed."""
        if now is not self.now and now != self.now:
            self.now = now

    def changed(self) -> bytes | None:
        """Return what has changed since the last call as JSON (`running.changes`), None where nothing has."""
        if self._told is self.now:
            return None
        told, self._told = self._told, self.now
        return changes(told, self.now)

    def in_reach(self, x_m: float, y_m: float, tick: int) -> list[SignalShown]:
        """Return what the signals show of which a stop line is within IN_REACH_M of a place."""
        if self._newest is not None:
            self.take(self._newest())
        return super().in_reach(x_m, y_m, tick)

    def of(self, approach: Approach) -> Shown:
        """Return what holds for whoever comes to a stop line."""
        return self._together(approach.signal, approach.links)

    def state(self, signal: int, link: int, tick: int) -> SignalState:
        """Return what a link of a signal shows; the tick is that of the last step."""
        if not self.now:
            return self._signals.state(signal, link, tick)
        return self._together(signal, (link,)).state

    def shown(self, number: int, tick: int) -> SignalShown:
        """Return what one signal shows in a tick."""
        if not self.now:
            return super().shown(number, tick)
        running = self.now.get(self._names[number])
        links = [self._together(number, (link,)) for link in range(0 if running is None else len(running.letters))]
        change_s = [
            NEVER_S if one.change_tick >= FAR else max(one.change_tick - tick, 0.0) / self._tick_hz for one in links
        ]
        times = green_times([self._greens(running, link, tick) for link in range(len(links))], self._tick_hz)
        states, following = [int(one.state) for one in links], [int(one.next_state) for one in links]
        return SignalShown(self._names[number], states, following, change_s, *times)

    def _greens(self, running: Running | None, link: int, tick: int) -> list[tuple[float, float]]:
        if running is None:
            return []
        now, known = state_of(running.letters, link), running.switch_tick < FAR
        phases = running.phases
        coming = [phases[(running.phase + step) % len(phases)] for step in range(1, len(phases) + 1)]
        later = [(state_of(one.state, link), float(np.rint(one.duration_s * self._tick_hz))) for one in coming]
        return greens(now, max(running.switch_tick - tick, 0.0) if known else FAR, later)

    def _together(self, signal: int, links: Sequence[int]) -> Shown:
        running = self.now.get(self._names[signal])
        if running is None:
            return Shown(SignalState.UNAVAILABLE, SignalState.UNAVAILABLE, FAR)
        now = _most_permissive(running.letters, links)
        at, phases = running.switch_tick, running.phases
        if at >= FAR:
            return Shown(now, now, FAR)
        for step in range(1, len(phases)):
            phase = phases[(running.phase + step) % len(phases)]
            later = _most_permissive(phase.state, links)
            if later != now:
                return Shown(now, later, at)
            at += float(np.rint(phase.duration_s * self._tick_hz))
        return Shown(now, now, FAR)


def _most_permissive(letters: str, links: Sequence[int]) -> SignalState:
    return max((state_of(letters, link) for link in links), key=PERMISSIVENESS.index)
