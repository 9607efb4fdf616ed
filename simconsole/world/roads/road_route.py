"""From a way over lanes to a route that a car can follow: lanes, changes and junctions as one smooth path."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from simconsole.world.roads.lane_graph import Leg
from simconsole.world.roads.path_fit import Corridor, fit
from simconsole.world.roads.road_map import CROSSING, Array, Connection, Lane, RoadMap
from simconsole.world.roads.road_turns import turns
from simconsole.world.route import Landmark, Route, Stretch

LANE_ROOM_M: Final = 0.15
"""How far the path may be from a lane's centre outside junctions and lane changes."""
JUNCTION_ROOM_M: Final = 0.8
_CHANGE_ROOM_M: Final = 0.3
_STEP_M: Final = 1.0
_NEAR_M: Final = 6.0  # a crossing whose middle is as near as this to the path leads over it
_MOST_LANDMARKS: Final = 200
MAX_CURVATURE_1PM: Final = 0.21
"""Of a route: what a passenger car can follow and still correct itself."""


def route_over(road_map: RoadMap, legs: Sequence[Leg]) -> Route:
    """Return the route over the lanes of a way, an open one."""
    parts = list(_parts(road_map, legs))
    corridor = Corridor(
        np.vstack([line for line, _, _ in parts]),
        np.concatenate([room for _, room, _ in parts]),
        np.concatenate([limit for _, _, limit in parts]),
    )
    stretches, s = [], 0.0
    for start, piece, limit in fit(corridor):
        stretches.append(Stretch(s, start, piece, limit))
        s += piece.length_m
    route = Route(stretches)
    route.landmarks = tuple(_landmarks(road_map, legs, route))[:_MOST_LANDMARKS]
    route.turns = tuple(turns(road_map, legs, route))
    return route


def too_tight(road_map: RoadMap, legs: Sequence[Leg], route: Route) -> Connection | None:
    """Return the connection of the way whose turn is too tight for a car, None where there is none."""
    worst = int(np.abs(route.curvature).argmax())
    if abs(float(route.curvature[worst])) <= MAX_CURVATURE_1PM:
        return None
    place = np.array((route.x[worst], route.y[worst]))
    turns = [leg.connection for leg in legs if leg.connection is not None]

    def away_m(turn: Connection) -> float:
        lines = [road_map.lanes[lane].line[:, :2] for lane in turn.via or (turn.to_lane,)]
        return min(float(np.hypot(*(line - place).T).min()) for line in lines)

    return min(turns, key=away_m, default=None)


def _parts(road_map: RoadMap, legs: Sequence[Leg]) -> Iterator[tuple[Array, Array, Array]]:
    """Yield (line [N, 2], room [N], limit [N]) of each edge and each junction of the way."""
    for leg in legs:
        driven = [road_map.lanes[place] for place in leg.lanes]
        line, changing = _along(driven)
        yield line, np.where(changing, _CHANGE_ROOM_M, LANE_ROOM_M), np.full(len(line), driven[0].limit_mps)
        if leg.connection is None:
            continue
        for place in leg.connection.via:
            lane = road_map.lanes[place]
            inside = lane.line[:, :2]
            yield inside, np.full(len(inside), JUNCTION_ROOM_M), np.full(len(inside), lane.limit_mps)


def _along(lanes: Sequence[Lane]) -> tuple[Array, NDArray[np.bool_]]:
    """Return the centre line of the lanes of one edge, changing from each to the next, and where it changes."""
    if len(lanes) == 1:
        line = lanes[0].line[:, :2]
        return line, np.zeros(len(line), np.bool_)
    length = lanes[0].length_m
    share = np.linspace(0.0, 1.0, max(2, math.ceil(length / _STEP_M)) + 1)
    lines = [_at_shares(lane.line[:, :2], share) for lane in lanes]
    changes = len(lanes) - 1
    place = np.clip(share * changes, 0.0, changes - 1e-9)
    number = place.astype(np.int64)
    x = np.clip((place - number - 0.05) / 0.9, 0.0, 1.0)
    blend = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)
    stack = np.stack(lines)
    rows = np.arange(len(share))
    line = stack[number, rows] * (1.0 - blend)[:, None] + stack[number + 1, rows] * blend[:, None]
    return line, (x > 0.0) & (x < 1.0)


def _at_shares(line: Array, share: Array) -> Array:
    way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    return np.stack([np.interp(share * way[-1], way, line[:, axis]) for axis in (0, 1)], axis=1)


def _landmarks(road_map: RoadMap, legs: Sequence[Leg], route: Route) -> Iterator[Landmark]:
    edges = {road_map.lanes[leg.lanes[0]].edge for leg in legs}
    for ring in road_map.roundabouts:
        if edges.intersection(ring):
            lines = np.vstack([road_map.lanes[road_map.edges[edge].lanes[-1]].line for edge in ring])
            x, y = lines[:, :2].mean(axis=0).tolist()
            yield Landmark("roundabout", route.project(x, y).s_m, x, y)
    for leg, _ in pairwise(legs):
        if leg.connection is not None and leg.connection.signal >= 0:
            x, y = road_map.lanes[leg.lanes[-1]].line[-1, :2].tolist()
            yield Landmark("traffic lights", route.project(x, y).s_m, x, y)
    for edge in road_map.edges:
        if edge.function != CROSSING:
            continue
        ends = road_map.lanes[edge.lanes[0]].line[[0, -1], :2]
        middle = ends.mean(axis=0)
        near = np.hypot(route.x - middle[0], route.y - middle[1])
        if float(near.min()) < _NEAR_M:
            x, y = middle.tolist()
            across = tuple((float(one), float(other)) for one, other in ends)
            yield Landmark("crossing", float(route.s[int(near.argmin())]), x, y, across)
