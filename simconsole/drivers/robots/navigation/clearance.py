"""How near a robot comes to what its lidar sees, along an arc that it may drive."""

from math import sqrt
from typing import Final, NamedTuple

from simconsole.values.kernels import Row, kernel
from simconsole.values.trigonometry import cos, sin

_STRAIGHT_RADPS: Final = 1e-6
_STEPS: Final = 12


class Arc(NamedTuple):
    """Speeds that are held for a while."""

    speed_mps: float
    yaw_rate_radps: float
    time_s: float


class Room(NamedTuple):
    """Distances from the middle of the robot's body to the nearest point."""

    first_m: float
    least_m: float
    last_m: float


@kernel
def room_along(points_m: Row, body_x_m: float, arc: Arc) -> Room:
    """Return what room an arc leaves.

    Args:
        points_m: float64 [N, 2]: what stands, in the frame of the robot's base; none: there is room without end.
        body_x_m: the middle of the body, ahead of the base.
        arc: what is driven.
    """
    first = _nearest(points_m, body_x_m, 0.0)
    least = first
    last = first
    for step in range(1, _STEPS + 1):
        time = arc.time_s * step / _STEPS
        turn = arc.yaw_rate_radps * time
        x = arc.speed_mps * time
        y = 0.0
        if abs(arc.yaw_rate_radps) > _STRAIGHT_RADPS:
            x = arc.speed_mps / arc.yaw_rate_radps * sin(turn)
            y = arc.speed_mps / arc.yaw_rate_radps * (1.0 - cos(turn))
        last = _nearest(points_m, x + body_x_m * cos(turn), y + body_x_m * sin(turn))
        if last < least:
            least = last
    return Room(first, least, last)


@kernel
def _nearest(points_m: Row, x_m: float, y_m: float) -> float:
    square = 1e12
    for index in range(len(points_m)):
        away_x = points_m[index, 0] - x_m
        away_y = points_m[index, 1] - y_m
        found = away_x * away_x + away_y * away_y
        if found < square:
            square = found
    return sqrt(square)
