"""From the console's frames to SUMO's and back: the one place that knows both.

SUMO names a vehicle by the middle of its front bumper and by a navigational angle (degrees, 0 north, clockwise); the
console by the middle of its footprint and a yaw (rad, 0 east, counter-clockwise). Its map may have been moved, too.
"""

import math
from typing import NamedTuple

import numpy as np

from simconsole.values.numerics.array_functions import cosine, sine
from simconsole.values.trigonometry import direction
from simconsole.world.roads.road_map import Array
from simconsole.world.traffic.road_users import Box

Moved = tuple[float, float]
"""What the console has taken away from the places of the map's file (m)."""


class Bumper(NamedTuple):
    """A vehicle as SUMO has it."""

    x_m: float
    y_m: float
    angle_deg: float  # 0 to 360


def bumper_of(box: Box, moved_m: Moved) -> Bumper:
    """Return the middle of a footprint's front, and where it looks."""
    heading = direction(box.yaw_rad)
    ahead_m = 0.5 * box.length_m
    return Bumper(
        x_m=box.x_m + ahead_m * heading.cos + moved_m[0],
        y_m=box.y_m + ahead_m * heading.sin + moved_m[1],
        angle_deg=(90.0 - math.degrees(box.yaw_rad)) % 360.0,
    )


def middles_of(bumpers: Array, lengths_m: Array, moved_m: Moved) -> Array:
    """Return the middles and yaws, float64 [N, 3], of vehicles by their bumpers, float64 [N, 3], and lengths [N]."""
    yaws = np.radians((270.0 - bumpers[:, 2]) % 360.0 - 180.0)
    found = np.empty((len(bumpers), 3))
    found[:, 0] = bumpers[:, 0] - 0.5 * lengths_m * cosine(yaws) - moved_m[0]
    found[:, 1] = bumpers[:, 1] - 0.5 * lengths_m * sine(yaws) - moved_m[1]
    found[:, 2] = yaws
    return found
