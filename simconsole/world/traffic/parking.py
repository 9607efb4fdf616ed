"""Parked cars: beside the rightmost lanes of roads, out of everybody's way."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from simconsole.world import traffic_columns as at
from simconsole.world.roads.road_map import ROAD, Array, Lane, RoadMap

LENGTH_M: Final = 4.4
WIDTH_M: Final = 1.8
_ASIDE_M: Final = 1.35  # of its middle from the edge of the lane
_FROM_ENDS_M: Final = 20.0
_FREE_M: Final = 2.4  # from its middle to the centre of every lane for cars
_APART_M: Final = 8.0
_TRIES: Final = 30


def parked_cars(road_map: RoadMap, count: int, rng: np.random.Generator) -> Array:
    """Return the boxes of up to `count` parked cars, float64 [cars, BOX], drawn from `rng`."""
    lanes = [lane for lane in road_map.lanes if _suits(road_map, lane)]
    points = np.vstack([_points(lane) for lane in road_map.lanes if lane.drivable] or [np.zeros((0, 2))])
    found: list[list[float]] = []
    for _ in range(_TRIES * count if lanes else 0):
        if len(found) == count:
            break
        lane = lanes[int(rng.integers(len(lanes)))]
        box = _beside(lane, float(rng.uniform(_FROM_ENDS_M, lane.length_m - _FROM_ENDS_M)))
        ends = [(box[at.X] + side * box[at.COSINE], box[at.Y] + side * box[at.SINE]) for side in (-1.5, 0.0, 1.5)]
        near = min(float(np.hypot(points[:, 0] - x, points[:, 1] - y).min()) for x, y in ends)
        apart = min((math.hypot(box[at.X] - one[at.X], box[at.Y] - one[at.Y]) for one in found), default=math.inf)
        if near > _FREE_M and apart > _APART_M:
            found.append(box)
    return np.array(found, np.float64).reshape(-1, at.BOX)


def _suits(road_map: RoadMap, lane: Lane) -> bool:
    edge = road_map.edges[lane.edge]
    first = next((place for place in edge.lanes if road_map.lanes[place].drivable), -1)
    rightmost = first >= 0 and road_map.lanes[first] is lane
    return rightmost and edge.function == ROAD and lane.length_m > 2.5 * _FROM_ENDS_M


def _points(lane: Lane, step_m: float = 0.5) -> Array:
    way = _way(lane)
    at_m = np.arange(0.0, way[-1], step_m)
    return np.column_stack([np.interp(at_m, way, lane.line[:, axis]) for axis in (0, 1)])


def _way(lane: Lane) -> Array:
    return np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(lane.line[:, :2], axis=0).T))))


def _beside(lane: Lane, s_m: float) -> list[float]:
    way: Sequence[float] = _way(lane).tolist()
    row = max(1, sum(1 for one in way[:-1] if one <= s_m))
    (x, y), (to_x, to_y) = lane.line[row - 1 : row + 1, :2].tolist()
    length = math.sqrt((to_x - x) ** 2 + (to_y - y) ** 2) or 1.0
    cosine, sine = (to_x - x) / length, (to_y - y) / length
    along, aside = s_m - way[row - 1], 0.5 * lane.width_m + _ASIDE_M
    x, y = x + along * cosine + aside * sine, y + along * sine - aside * cosine
    return [x, y, cosine, sine, 0.0, LENGTH_M, WIDTH_M, -1.0, 0.0]
