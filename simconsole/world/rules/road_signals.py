"""The traffic lights of a road map as they are told to those who cannot see them: states by tick, and stop lines."""

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from simconsole.values.signals import FAR, SignalState
from simconsole.world.roads.road_map import Connection, RoadMap, active
from simconsole.world.rules.timetable import Signals, durations_ticks, greens, link_states, until_change

IN_REACH_M: Final = 300.0
"""Radio and eyes reach no further."""
NEVER_S: Final = -1.0


class StopLinePlace(NamedTuple):
    """Where a lane ends before a signal."""

    lane: str
    signal: str
    links: tuple[int, ...]
    x_m: float  # of its middle, in map
    y_m: float
    yaw_rad: float
    width_m: float


class SignalShown(NamedTuple):
    """What a signal shows: one value for each of its links."""

    id: str
    states: list[int]
    next_states: list[int]
    change_s: list[float]  # NEVER_S: it does not change
    green_from_s: list[float]  # the next time of green, 0: it is green; NEVER_S: there is none
    green_to_s: list[float]  # NEVER_S: it lasts, or nobody knows
    later_green_from_s: list[float]  # the one after that, likewise
    later_green_to_s: list[float]


class _PhaseShown(NamedTuple):
    """What a signal shows during one phase."""

    states: list[int]
    next_states: list[int]
    later_ticks: list[float]  # after the phase's end, until a link changes; FAR: never
    later_states: list[list[tuple[SignalState, float]]]  # of each link, what follows and for how long, in ticks


class RoadSignals:
    """All signals of a map, for whoever asks again and again."""

    def __init__(self, road_map: RoadMap, tick_hz: int) -> None:
        self._signals = Signals(road_map.signals, tick_hz)
        self._shown = [_phases(self._signals, number) for number in range(len(road_map.signals))]
        held = _held(road_map)
        self.stop_lines = tuple(_stop_lines(road_map, held))
        self._places = [
            [tuple(road_map.lanes[one.from_lane].line[-1, :2].tolist()) for one in held.get(number, ())]
            for number in range(len(road_map.signals))
        ]

    def in_reach(self, x_m: float, y_m: float, tick: int) -> list[SignalShown]:
        """Return what the signals show of which a stop line is within IN_REACH_M of a place."""
        near = (number for number, places in enumerate(self._places) if _reaches(places, x_m, y_m))
        return [self.shown(number, tick) for number in near]

    def shown(self, number: int, tick: int) -> SignalShown:
        """Return what one signal shows in a tick."""
        phase, left_ticks = self._signals.phase(number, tick)
        now, tick_hz = self._shown[number][phase], self._signals.tick_hz
        change_s = [NEVER_S if later >= FAR else (left_ticks + later) / tick_hz for later in now.later_ticks]
        coming = [
            greens(SignalState(state), float(left_ticks), later)
            for state, later in zip(now.states, now.later_states, strict=True)
        ]
        times = green_times(coming, tick_hz)
        return SignalShown(self._signals.signals[number].id, now.states, now.next_states, change_s, *times)


def green_times(coming: Sequence[Sequence[tuple[float, float]]], tick_hz: int) -> tuple[list[float], ...]:
    """Return the last fields of `SignalShown` for the times of green of each link in ticks, as `greens` has them."""

    def told(number: int, place: int) -> list[float]:
        ticks = [some[number][place] if number < len(some) else FAR for some in coming]
        return [NEVER_S if one >= FAR else one / tick_hz for one in ticks]

    return told(0, 0), told(0, 1), told(1, 0), told(1, 1)


def _reaches(places: list[tuple[float, float]], x_m: float, y_m: float) -> bool:
    return any(math.hypot(x - x_m, y - y_m) <= IN_REACH_M for x, y in places)


def _phases(signals: Signals, number: int) -> list[_PhaseShown]:
    program = active(signals.signals[number])
    durations = durations_ticks(program, signals.tick_hz)
    links = [link_states(program, (link,)) for link in range(len(program.phases[0].state))]
    later = [until_change(states, durations) for states in links]
    return [
        _PhaseShown(
            [int(states[phase]) for states in links],
            [int(one[phase][1]) for one in later],
            [one[phase][0] for one in later],
            [
                [
                    (states[other % len(states)], float(durations[other % len(states)]))
                    for other in range(phase + 1, phase + 1 + len(states))
                ]
                for states in links
            ],
        )
        for phase in range(len(durations))
    ]


def _held(road_map: RoadMap) -> dict[int, list[Connection]]:
    """Return the movements of cars that each signal holds back."""
    held: dict[int, list[Connection]] = defaultdict(list)
    for one in road_map.connections:
        if one.signal >= 0 and road_map.lanes[one.from_lane].drivable:
            held[one.signal].append(one)
    return held


def _stop_lines(road_map: RoadMap, held: dict[int, list[Connection]]) -> Iterator[StopLinePlace]:
    for number, connections in sorted(held.items()):
        for place in sorted({one.from_lane for one in connections}):
            lane = road_map.lanes[place]
            x, y = lane.line[-1, :2].tolist()
            before_x, before_y = lane.line[-2, :2].tolist()
            yield StopLinePlace(
                lane=lane.id,
                signal=road_map.signals[number].id,
                links=tuple(sorted(one.link for one in connections if one.from_lane == place)),
                x_m=x,
                y_m=y,
                yaw_rad=math.atan2(y - before_y, x - before_x),
                width_m=lane.width_m,
            )
