"""Which road users overlap: oriented boxes by the separating axis theorem.

Gottschalk, Lin, Manocha: OBBTree, SIGGRAPH 1996, in the plane:
two rectangles are apart exactly if their projections onto one of the four directions of their sides are.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from simconsole.values.kernels import Row, kernel
from simconsole.values.trigonometry import direction
from simconsole.world.roads.road_map import Array
from simconsole.world.traffic.road_users import CAPACITY, Box, RoadUser


@kernel
def overlap(one: Box, other: Box) -> bool:
    """Return whether two footprints have a point in common."""
    dx, dy = other.x_m - one.x_m, other.y_m - one.y_m
    reach = _radius(one.length_m, one.width_m) + _radius(other.length_m, other.width_m)
    if dx * dx + dy * dy > reach * reach:
        return False
    turned = direction(other.yaw_rad - one.yaw_rad)
    if _apart(one, other, dx, dy, turned.cos, turned.sin):
        return False
    return not _apart(other, one, dx, dy, turned.cos, turned.sin)


@kernel
def _radius(length_m: float, width_m: float) -> float:
    return 0.5 * math.sqrt(length_m * length_m + width_m * width_m)


@kernel
def _apart(one: Box, other: Box, dx: float, dy: float, cosine: float, sine: float) -> bool:
    """Return whether the sides of `one` have a direction in which the two are apart."""
    heading = direction(one.yaw_rad)
    along, aside = abs(dx * heading.cos + dy * heading.sin), abs(dy * heading.cos - dx * heading.sin)
    length = one.length_m + other.length_m * abs(cosine) + other.width_m * abs(sine)
    width = one.width_m + other.length_m * abs(sine) + other.width_m * abs(cosine)
    return along > 0.5 * length or aside > 0.5 * width


@kernel
def find_struck(
    users: Row, rows: Row, x_m: float, y_m: float, yaw_rad: float, speed_mps: float, length_m: float, width_m: float
) -> int:
    """Write which rows of `users`, float64 [users, FIELDS], overlap the ego, a `Box`, into `rows`; return how many."""
    ego = Box(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad, speed_mps=speed_mps, length_m=length_m, width_m=width_m)
    count = 0
    for row in range(len(users)):
        user = users[row]
        other = Box(x_m=user[2], y_m=user[3], yaw_rad=user[4], speed_mps=user[5], length_m=user[6], width_m=user[7])
        if overlap(ego, other):
            rows[count] = row
            count += 1
    return count


class Struck:
    """Finds whom a vehicle strikes."""

    def __init__(self, execution: Callable[[Any], Any]) -> None:
        """Search by a kernel; `execution` is `jit.compiled` or `jit.plain`."""
        self._find, self._rows = execution(find_struck), np.zeros(CAPACITY, np.int64)

    def by(self, ego: Box, users: Array) -> list[RoadUser]:
        """Return the road users of a table, float64 [users, FIELDS], that overlap the ego."""
        count = self._find(users, self._rows, *ego)  # by its fields: Python hands over numbers faster than a tuple
        return [RoadUser(*users[row].tolist()) for row in self._rows[:count].tolist()] if count else []


def box_of(user: RoadUser) -> Box:
    """Return a road user's footprint."""
    return Box(
        x_m=user.x_m,
        y_m=user.y_m,
        yaw_rad=user.yaw_rad,
        speed_mps=user.speed_mps,
        length_m=user.length_m,
        width_m=user.width_m,
    )


def overlapping(users: Array) -> list[tuple[int, int]]:
    """Return the pairs of rows of a table that overlap."""
    found = []
    apart = np.hypot(users[:, None, 2] - users[None, :, 2], users[:, None, 3] - users[None, :, 3])
    radius = 0.5 * np.hypot(users[:, 6], users[:, 7])
    for first, second in np.argwhere(np.triu(apart <= radius[:, None] + radius, 1)).tolist():
        if overlap(box_of(RoadUser(*users[first].tolist())), box_of(RoadUser(*users[second].tolist()))):
            found.append((first, second))
    return found
