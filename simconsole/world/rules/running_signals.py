"""The signals of a map as another simulator runs them: what they show as of its last step."""

import json
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from simconsole.values.signals import FAR, SignalState
from simconsole.world.roads.road_map import Phase, RoadMap
from simconsole.world.rules.approaches import Approach
from simconsole.world.rules.road_signals import NEVER_S, RoadSignals, SignalShown
from simconsole.world.rules.timetable import PERMISSIVENESS, state_of


class Running(NamedTuple):
    """A signal as it runs now."""

    letters: str  # of its links, as SUMO writes them
    phases: tuple[Phase, ...]  # of its program
    phase: int
    switch_tick: float  # when this phase ends; FAR: nobody knows


class Shown(NamedTuple):
    """What some links of a signal show together."""

    state: SignalState  # the most permissive of theirs
    next_state: SignalState
    change_tick: float  # when it changes, as far as the program says; FAR: never, or nobody knows


class RunningSignals(RoadSignals):
    """Another simulator's signals, in the words of our own; `take` renews them after each of its steps."""

    def __init__(self, road_map: RoadMap, tick_hz: int) -> None:
        super().__init__(road_map, tick_hz)
        self._names = [signal.id for signal in road_map.signals]
        self._tick_hz = tick_hz
        self._now: dict[str, Running] = {}
        self._changed: dict[str, Running] = {}

    def take(self, now: Mapping[str, Running]) -> None:
        """Take what the simulator's signals show now."""
        for name, running in now.items():
            if self._now.get(name) != running:
                self._now[name] = self._changed[name] = running

    def changed(self) -> bytes | None:
        """Return those that have changed since the last call as JSON, None where none has."""
        if not self._changed:
            return None
        said = {name: {"states": one.letters, "switch_tick": one.switch_tick} for name, one in self._changed.items()}
        self._changed = {}
        return json.dumps(said, sort_keys=True, separators=(",", ":")).encode()

    def of(self, approach: Approach) -> Shown:
        """Return what holds for whoever comes to a stop line."""
        return self._together(approach.signal, approach.links)

    def state(self, signal: int, link: int, tick: int) -> SignalState:
        """Return what a link of a signal shows; the tick is that of the last step."""
        del tick
        return self._together(signal, (link,)).state

    def shown(self, number: int, tick: int) -> SignalShown:
        """Return what one signal shows in a tick."""
        running = self._now.get(self._names[number])
        links = [self._together(number, (link,)) for link in range(0 if running is None else len(running.letters))]
        return SignalShown(
            id=self._names[number],
            states=[int(one.state) for one in links],
            next_states=[int(one.next_state) for one in links],
            change_s=[
                NEVER_S if one.change_tick >= FAR else max(one.change_tick - tick, 0.0) / self._tick_hz for one in links
            ],
        )

    def _together(self, signal: int, links: Sequence[int]) -> Shown:
        running = self._now.get(self._names[signal])
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
