"""How near robots came to what stands and to each other, rim to rim."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from simconsole.evaluation.metrics.map_errors import to_outlines
from simconsole.evaluation.metrics.table import Array
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.world.arena.outlines import Outlines


class Track(NamedTuple):
    """Where a round body was, tick by tick."""

    middles_m: Array  # [ticks, 2]
    radius_m: float


class Clearance(NamedTuple):
    """The least distances of a body's rim; below 0 it was pushed out of what it touched."""

    wall_m: float
    robot_m: float  # from another one's rim; infinite without another one


def track_of(poses: Array, robot: TurtlebotProfile) -> Track:
    """Return the body of a robot whose base had these poses [ticks, 3] (x, y in m, yaw in rad)."""
    ahead = robot.body_x_m * np.column_stack((np.cos(poses[:, 2]), np.sin(poses[:, 2])))
    return Track(poses[:, :2] + ahead, robot.body_radius_m)


def clearances(tracks: Sequence[Track], outlines: Outlines) -> list[Clearance]:
    """Return for each body how near it came to outlines and to the others, in as many ticks as all have."""
    found = []
    for track in tracks:
        others = [_apart_m(track, other) for other in tracks if other is not track]
        wall_m = float(to_outlines(track.middles_m, outlines).min()) - track.radius_m
        found.append(Clearance(wall_m, min(others, default=float("inf"))))
    return found


def _apart_m(a: Track, b: Track) -> float:
    ticks = min(len(a.middles_m), len(b.middles_m))
    away = a.middles_m[:ticks] - b.middles_m[:ticks]
    return float(np.hypot(away[:, 0], away[:, 1]).min()) - a.radius_m - b.radius_m
