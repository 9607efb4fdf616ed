"""The rules of a road map as arrays: what the tick looks up to know where the vehicle is and what it owes."""

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from simconsole.values.kernels import Row
from simconsole.world.obstacles.sides import NOBODY, Body, FixedThings, fixed_things
from simconsole.world.roads.lane_graph import Leg
from simconsole.world.roads.lane_index import LaneArrays, LaneIndex, nearest_segment
from simconsole.world.roads.road_map import ROAD, RoadMap, active
from simconsole.world.rules.approaches import Approach, ahead_of_lanes
from simconsole.world.rules.timetable import (
    Timetable,
    durations_ticks,
    link_states,
    timetable_of,
    until_change,
)


class LaneRow(NamedTuple):
    """One row of the table of lanes."""

    edge: float
    length_m: float
    half_width_m: float
    limit_mps: float
    in_junction: float  # 1: inside a junction, whose lanes cross each other
    approach: float  # row of the table of approaches; -1: no signal ahead
    beyond_m: float  # from the lane's end to the stop line


class ApproachRow(NamedTuple):
    """One row of the table of approaches."""

    signal: float
    shown: float  # row of the table of what is shown, in the first phase of the signal's program


class RoadRules(NamedTuple):
    """Everything that the tick looks up; float64 but for the index of lanes."""

    segments: LaneArrays
    lanes: Row  # [lanes, fields of LaneRow]
    approaches: Row  # [approaches, fields of ApproachRow]
    shown: Row  # [phases of all approaches, 2]: `SignalState`, ticks after the phase's end until it changes
    timetable: Timetable
    front_m: Row  # [1]: from base_link to the vehicle's front
    things: FixedThings


EDGE, LENGTH, HALF_WIDTH, LIMIT, IN_JUNCTION, APPROACH, BEYOND = range(len(LaneRow._fields))
SIGNAL, SHOWN = range(len(ApproachRow._fields))
_NONE: Final = -1.0


def road_rules(road_map: RoadMap, legs: Sequence[Leg], tick_hz: int, front_m: float, body: Body = NOBODY) -> RoadRules:
    """Return the rules of a map for a vehicle whose front is `front_m` ahead of base_link and who takes this way.

    Raises:
        ValueError: the vehicle is too long to look for fixed things.
    """
    drivable = [place for place, lane in enumerate(road_map.lanes) if lane.drivable]
    ahead = ahead_of_lanes(road_map, legs)
    rows: dict[Approach, float] = {}
    approaches: list[ApproachRow] = []
    shown: list[tuple[float, float]] = []
    for one in ahead:
        if one is None or one.approach in rows:
            continue
        rows[one.approach] = float(len(rows))
        approaches.append(ApproachRow(float(one.approach.signal), float(len(shown))))
        program = active(road_map.signals[one.approach.signal])
        states = link_states(program, one.approach.links)
        later = until_change(states, durations_ticks(program, tick_hz))
        shown += [(float(state), more) for state, (more, _) in zip(states, later, strict=True)]
    lanes = [
        LaneRow(
            edge=float(lane.edge),
            length_m=lane.length_m,
            half_width_m=0.5 * lane.width_m,
            limit_mps=lane.limit_mps,
            in_junction=float(road_map.edges[lane.edge].function != ROAD),
            approach=_NONE if one is None else rows[one.approach],
            beyond_m=0.0 if one is None else one.beyond_m,
        )
        for lane, one in zip(road_map.lanes, ahead, strict=True)
    ]
    return RoadRules(
        segments=LaneIndex(road_map.lanes, drivable, nearest_segment).arrays,
        lanes=_table(lanes, LaneRow),
        approaches=_table(approaches, ApproachRow),
        shown=np.array(shown, dtype=np.float64).reshape(-1, 2),
        timetable=timetable_of(road_map.signals, tick_hz),
        front_m=np.array((front_m,)),
        things=fixed_things(road_map.obstacles, road_map.lanes, body),
    )


def _table(rows: Sequence[tuple[float, ...]], kind: type[tuple[float, ...]]) -> Row:
    return np.array(rows, dtype=np.float64).reshape(-1, len(kind._fields))  # type: ignore[attr-defined]
