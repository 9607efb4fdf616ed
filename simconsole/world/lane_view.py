"""A vehicle beside its path, for a learner that looks after every step: the place is followed, never searched for."""

import math
from typing import Final, NamedTuple

import numpy as np

from simconsole.values.kernels import Row, clip, kernel
from simconsole.values.layout import read
from simconsole.values.signals import Mode
from simconsole.values.state_vector import LAYOUT
from simconsole.world.route import Route

STEP_M: Final = 0.5
AHEAD_M: Final = (5.0, 10.0, 20.0)
"""Where the path's curvature is seen, from base_link on."""

_PI: Final = 3.141592653589793
_X, _Y, _COS, _SIN, _YAW, _CURVATURE = range(6)
_CELL, _LAPS, _S, _LATERAL = range(4)


class LaneView(NamedTuple):
    """What is seen of a path and of the vehicle on it; also the places of an observation, in their order."""

    speed_mps: float
    lateral_m: float  # left of the path
    heading_rad: float  # turned left of it
    yaw_rate_radps: float
    road_wheel_rad: float
    curvature_5m_1pm: float  # of the path so far ahead, left-positive
    curvature_10m_1pm: float
    curvature_20m_1pm: float


MOST: Final = LaneView(
    speed_mps=100.0,
    lateral_m=100.0,
    heading_rad=3.1416,
    yaw_rate_radps=10.0,
    road_wheel_rad=2.0,
    curvature_5m_1pm=1.0,
    curvature_10m_1pm=1.0,
    curvature_20m_1pm=1.0,
)
"""Bounds of what is seen, both ways: what lies beyond is shown as the bound."""


class Path(NamedTuple):
    """A route cut into cells of equal length, for `lane_view`."""

    cells: Row  # [cells, 6]: x m, y m, cosine and sine of the heading, heading rad, curvature 1/m
    cell_m: float
    closed: float  # 1: after the last cell comes the first


def path_of(route: Route) -> Path:
    """Return a route as cells of about half a metre."""
    count = max(2, round(route.length_m / STEP_M))
    cell_m = route.length_m / count
    points = [route.at(number * cell_m) for number in range(count)]
    cells = [(p.x_m, p.y_m, math.cos(p.yaw_rad), math.sin(p.yaw_rad), p.yaw_rad, p.curvature_1pm) for p in points]
    return Path(np.array(cells), cell_m, float(route.closed))


def place_at(path: Path, s_m: float) -> Row:
    """Return the place for `lane_view` of a vehicle that starts `s_m` along the path."""
    cell = min(int(s_m / path.cell_m), len(path.cells) - 1)
    return np.array([cell, 0.0, s_m, 0.0])


@kernel
def lane_view(path: Path, vector: Row, place: Row, seen: Row) -> bool:
    """Write what is seen after a tick into `seen` and follow `place`; return whether automation drives.

    Args:
        path: beside which the vehicle is; first, so that compiled code can hold it (`kernels.holding`).
        vector: the state vector.
        place: cell, laps, distance along the path in m (laps included) and left of it in m, from `place_at` or the call
            before.
        seen: float32 or float64 [fields of LaneView].
    """
    cells, cell_m, closed = path.cells, path.cell_m, path.closed
    vehicle = read(vector, LAYOUT.vehicle)
    count, cell, laps = len(cells), int(place[_CELL]), place[_LAPS]
    along, turned = 0.0, 0
    for _ in range(count):
        dx, dy = vehicle.x_m - cells[cell, _X], vehicle.y_m - cells[cell, _Y]
        along = dx * cells[cell, _COS] + dy * cells[cell, _SIN]
        step = 1 if along >= cell_m else -1 if along < 0.0 else 0
        beyond = cell + step < 0 or cell + step >= count
        if step == 0 or step == -turned or (beyond and closed == 0.0):
            break  # in this cell, in the wedge between two of them, or beyond an open path's end
        cell, turned = cell + step, step
        if beyond:
            cell -= step * count
            laps += step
    place[_CELL], place[_LAPS] = cell, laps
    place[_S] = (laps * count + cell) * cell_m + along
    dx, dy = vehicle.x_m - cells[cell, _X], vehicle.y_m - cells[cell, _Y]
    curvature = cells[cell, _CURVATURE]
    heading = vehicle.yaw_rad - cells[cell, _YAW] - curvature * along
    while heading > _PI:
        heading -= 2.0 * _PI
    while heading < -_PI:
        heading += 2.0 * _PI
    lateral = dy * cells[cell, _COS] - dx * cells[cell, _SIN] - 0.5 * curvature * along * along
    place[_LATERAL] = lateral
    seen[0] = clip(vehicle.vx_mps, -MOST.speed_mps, MOST.speed_mps)
    seen[1] = clip(lateral, -MOST.lateral_m, MOST.lateral_m)
    seen[2] = heading
    seen[3] = clip(vehicle.yaw_rate_radps, -MOST.yaw_rate_radps, MOST.yaw_rate_radps)
    seen[4] = clip(vehicle.road_wheel_rad, -MOST.road_wheel_rad, MOST.road_wheel_rad)
    for index in range(len(AHEAD_M)):
        further = cell + int((along + AHEAD_M[index]) / cell_m)
        if further >= count:
            further = further - count if closed > 0.0 else count - 1
        seen[5 + index] = cells[further, _CURVATURE]
    return read(vector, LAYOUT.arbitration).mode == Mode.AUTONOMOUS
