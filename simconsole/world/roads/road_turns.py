"""The turns of a way over a road map: junctions at which a driver has a choice and does not just go on."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from simconsole.world.roads.lane_graph import Leg
from simconsole.world.roads.road_map import ROAD, RoadMap
from simconsole.world.route import Route, Turn

_STRAIGHT_ON: Final = "s"
_HEADING_M: Final = 3.0
"""Headings are taken over this much of a lane: the last piece of a line may be a few centimetres long."""


def turns(road_map: RoadMap, legs: Sequence[Leg], route: Route) -> Iterator[Turn]:
    """Yield the turns of a way, in driving order."""
    rings = [set(ring) for ring in road_map.roundabouts]
    s_m, place = 0.0, 0
    while place < len(legs) - 1:
        after = _end_of_ring(road_map, legs, place, rings)
        before, next_leg = legs[place], legs[after]
        if after > place + 1 or _is_choice(road_map, before):
            x, y = road_map.lanes[before.lanes[-1]].line[-1, :2].tolist()
            s_m = max(s_m, route.project(x, y, None).s_m)
            x, y = road_map.lanes[next_leg.lanes[0]].line[0, :2].tolist()
            end_m = max(s_m, route.project(x, y, s_m).s_m)
            turned = _heading(road_map, next_leg.lanes[0], 0) - _heading(road_map, before.lanes[-1], -1)
            exits = sum(_leads_out(road_map, leg, rings) for leg in legs[place + 1 : after])
            yield Turn(s_m, end_m, math.remainder(turned, math.tau), exits)
        place = after


def _end_of_ring(road_map: RoadMap, legs: Sequence[Leg], place: int, rings: Sequence[set[int]]) -> int:
    """Return the place of the leg after `place`; where a roundabout follows, of the one behind it."""
    after = place + 1
    while after < len(legs) - 1 and any(_edge(road_map, legs[after]) in ring for ring in rings):
        after += 1
    return after


def _edge(road_map: RoadMap, leg: Leg) -> int:
    return road_map.lanes[leg.lanes[0]].edge


def _ways_on(road_map: RoadMap, edge: int) -> set[int]:
    """Return the edges that a car may take after an edge; turning on the spot counts for none."""
    lanes = road_map.lanes
    return {
        lanes[one.to_lane].edge
        for one in road_map.connections
        if lanes[one.from_lane].edge == edge
        and lanes[one.to_lane].drivable
        and road_map.edges[lanes[one.to_lane].edge].function == ROAD
        and one.direction != "t"
    }


def _is_choice(road_map: RoadMap, leg: Leg) -> bool:
    assert leg.connection is not None
    return leg.connection.direction != _STRAIGHT_ON and len(_ways_on(road_map, _edge(road_map, leg))) > 1


def _leads_out(road_map: RoadMap, leg: Leg, rings: Sequence[set[int]]) -> bool:
    """Return whether a roundabout has an exit at the end of this edge of it."""
    edge = _edge(road_map, leg)
    own: set[int] = next((ring for ring in rings if edge in ring), set())
    return bool(_ways_on(road_map, edge) - own)


def _heading(road_map: RoadMap, lane: int, end: int) -> float:
    """Return the heading of a lane at its beginning (0) or end (-1)."""
    line = road_map.lanes[lane].line[:, :2]
    away = np.hypot(*(line - line[end]).T)
    far = np.flatnonzero(away >= min(_HEADING_M, float(away.max())))
    other = line[int(far[0] if end == 0 else far[-1])]
    dx, dy = (other - line[0]) if end == 0 else (line[-1] - other)
    return math.atan2(float(dy), float(dx))
