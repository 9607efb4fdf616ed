"""Whom the console's vehicle follows: the nearest road user in its way, and the gap to them."""

import math
from typing import Final

import numpy as np

from simconsole.values.signals import NO_AHEAD, AheadInput
from simconsole.world.roads.road_map import Array
from simconsole.world.route import Route
from simconsole.world.traffic.road_users import Box

AHEAD_M: Final = 150.0
MARGIN_M: Final = 0.2
_STEP_M: Final = 0.5
_BESIDE_M: Final = 5.0  # further beside its route, the vehicle's way is straight on
_TURNED_RAD: Final = 1.0  # likewise


def leader(route: Route | None, ego: Box, users: Array) -> AheadInput:
    """Return the nearest road user on the way ahead, bumper to bumper along it.

    Args:
        route: what the vehicle follows; far beside it, or without one, it goes straight on.
        ego: its footprint.
        users: the road users, float64 [users, FIELDS].
    """
    near = users[np.hypot(users[:, 2] - ego.x_m, users[:, 3] - ego.y_m) < AHEAD_M]
    if not len(near):
        return NO_AHEAD
    way = _way_ahead(route, ego)
    dx, dy = near[:, None, 2] - way[None, :, 0], near[:, None, 3] - way[None, :, 1]
    place = np.argmin(dx * dx + dy * dy, axis=1)
    rows = np.arange(len(near))
    cosine, sine = np.cos(way[place, 2]), np.sin(way[place, 2])
    along = dx[rows, place] * cosine + dy[rows, place] * sine
    aside = np.abs(dy[rows, place] * cosine - dx[rows, place] * sine)
    turned = near[:, 4] - way[place, 2]
    ahead, across = np.abs(np.cos(turned)), np.abs(np.sin(turned))
    length = near[:, 6] * ahead + near[:, 7] * across
    width = near[:, 6] * across + near[:, 7] * ahead
    gap = place * _STEP_M + along - 0.5 * (ego.length_m + length)
    before = (place > 0) & (np.abs(along) <= _STEP_M) & (aside <= 0.5 * (ego.width_m + width) + MARGIN_M)
    if not before.any():
        return NO_AHEAD
    chosen = int(np.flatnonzero(before)[np.argmin(gap[before])])
    gap_m = max(0.0, float(gap[chosen]))
    speed_mps = float(near[chosen, 5] * np.cos(turned[chosen]))
    return NO_AHEAD._replace(lead_gap_m=gap_m, lead_speed_mps=speed_mps)


def _way_ahead(route: Route | None, ego: Box) -> Array:
    """Return the way ahead of the middle of the vehicle as x, y, yaw, float64 [N, 3], one row each _STEP_M."""
    distance = np.arange(0.0, AHEAD_M, _STEP_M)
    if route is not None:
        at = route.project(ego.x_m, ego.y_m, yaw_rad=ego.yaw_rad)
        if abs(at.lateral_m) < _BESIDE_M and abs(at.heading_error_rad) < _TURNED_RAD:
            s = at.s_m + distance
            if not route.closed:
                s = s[s < route.length_m]
            if len(s):
                within = route.within(s)
                cell = np.searchsorted(route.s, within, side="right") - 1
                u, yaw = within - route.s[cell], route.yaw[cell]
                middle = yaw + 0.5 * u * route.curvature[cell]
                x, y = route.x[cell] + u * np.cos(middle), route.y[cell] + u * np.sin(middle)
                return np.column_stack((x, y, yaw + u * route.curvature[cell]))
    x, y = ego.x_m + distance * math.cos(ego.yaw_rad), ego.y_m + distance * math.sin(ego.yaw_rad)
    return np.column_stack((x, y, np.full(len(distance), ego.yaw_rad)))
