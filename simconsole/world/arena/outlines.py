"""What stands in an arena as straight pieces and circles: what rays hit, robots touch and maps show."""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.profiles.world import ArenaProfile

Array = NDArray[np.float64]

ROUND_STEPS: Final = 24
"""Corners of a circle that is drawn."""


class Outlines(NamedTuple):
    """Obstacles in m of map."""

    segments: Array  # [N, 4]: x, y of both ends
    circles: Array  # [M, 3]: x, y, radius


def outlines_of(profile: ArenaProfile, least_m: float = 0.0) -> Outlines:
    """Return the obstacles of an arena that are at least so high."""
    walls = [wall for wall in profile.walls if wall.height_m >= least_m]
    sides = [(a.x_m, a.y_m, b.x_m, b.y_m) for wall in walls for a, b in wall.sides]
    circles = [(one.x_m, one.y_m, one.radius_m) for one in profile.pillars if one.height_m >= least_m]
    return Outlines(
        segments=np.array(sides, dtype=np.float64).reshape(-1, 4),
        circles=np.array(circles, dtype=np.float64).reshape(-1, 3),
    )


def bounds(outlines: Outlines) -> tuple[float, float, float, float]:
    """Return least x, least y, most x and most y of all obstacles."""
    ends = outlines.segments.reshape(-1, 2)
    radius = outlines.circles[:, 2:]
    points = np.vstack((ends, outlines.circles[:, :2] - radius, outlines.circles[:, :2] + radius))
    (west, south), (east, north) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return west, south, east, north


def wall_lines(profile: ArenaProfile) -> tuple[Array, ...]:
    """Return every wall and the rim of every pillar as a line [N, 3]: x, y, height, all in m."""
    lines = []
    for wall in profile.walls:
        corners = (*wall.points, wall.points[0]) if wall.closed else wall.points
        lines.append(np.array([(corner.x_m, corner.y_m, wall.height_m) for corner in corners]))
    turns = np.linspace(0.0, math.tau, ROUND_STEPS + 1)
    for one in profile.pillars:
        x, y = one.x_m + one.radius_m * np.cos(turns), one.y_m + one.radius_m * np.sin(turns)
        lines.append(np.column_stack((x, y, np.full(len(turns), one.height_m))))
    return tuple(lines)
