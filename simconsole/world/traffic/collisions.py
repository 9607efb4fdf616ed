"""Which road users overlap: oriented boxes by the separating axis theorem.

Gottschalk, Lin, Manocha: OBBTree, SIGGRAPH 1996, in the plane:
two rectangles are apart exactly if their projections onto one of the four directions of their sides are.
"""

import math

import numpy as np

from simconsole.world.roads.road_map import Array
from simconsole.world.traffic.road_users import Box, RoadUser


def overlap(one: Box | RoadUser, other: Box | RoadUser) -> bool:
    """Return whether two footprints have a point in common."""
    dx, dy = other.x_m - one.x_m, other.y_m - one.y_m
    reach = 0.5 * (math.hypot(one.length_m, one.width_m) + math.hypot(other.length_m, other.width_m))
    if dx * dx + dy * dy > reach * reach:
        return False
    cosine, sine = math.cos(other.yaw_rad - one.yaw_rad), math.sin(other.yaw_rad - one.yaw_rad)
    for first, second, towards in ((one, other, 1.0), (other, one, -1.0)):
        forward, left = math.cos(first.yaw_rad), math.sin(first.yaw_rad)
        along = abs(towards * (dx * forward + dy * left))
        aside = abs(towards * (dy * forward - dx * left))
        if along > 0.5 * (first.length_m + second.length_m * abs(cosine) + second.width_m * abs(sine)):
            return False
        if aside > 0.5 * (first.width_m + second.length_m * abs(sine) + second.width_m * abs(cosine)):
            return False
    return True


def struck(ego: Box, users: Array) -> list[RoadUser]:
    """Return the road users of a table, float64 [users, FIELDS], that overlap the ego."""
    if not len(users):
        return []
    reach = 0.5 * (math.hypot(ego.length_m, ego.width_m) + np.hypot(users[:, 6], users[:, 7]))
    near = np.hypot(users[:, 2] - ego.x_m, users[:, 3] - ego.y_m) <= reach
    return [user for user in (RoadUser(*row) for row in users[near].tolist()) if overlap(ego, user)]


def overlapping(users: Array) -> list[tuple[int, int]]:
    """Return the pairs of rows of a table that overlap."""
    found = []
    apart = np.hypot(users[:, None, 2] - users[None, :, 2], users[:, None, 3] - users[None, :, 3])
    radius = 0.5 * np.hypot(users[:, 6], users[:, 7])
    for first, second in np.argwhere(np.triu(apart <= radius[:, None] + radius, 1)).tolist():
        if overlap(RoadUser(*users[first].tolist()), RoadUser(*users[second].tolist())):
            found.append((first, second))
    return found
