"""A lidar that turns while its robot moves: each ray starts where and as the robot was at its time."""

from typing import Final, NamedTuple

from simconsole.values.kernels import Row, kernel
from simconsole.values.trigonometry import cos, sin, wrap_angle
from simconsole.world.arena.raycast import NO_HIT_M, RayGrid, cast

TWO_PI: Final = 6.283185307179586
NOTHING_M: Final = 0.0
"""Range of a ray without an echo, as the LDS-01's driver gives it: below the least range, so that nobody takes it for
one."""


class End(NamedTuple):
    """The robot at one end of a turn, in map."""

    x_m: float
    y_m: float
    yaw_rad: float
    vx_map_mps: float
    vy_map_mps: float
    yaw_rate_radps: float


class Beam(NamedTuple):
    """What a lidar is like."""

    x_m: float  # ahead of the robot's pose
    min_m: float
    max_m: float
    turn_s: float


@kernel
def sweep(begin: End, end: End, beam: Beam, grid: RayGrid, others: Row, noise_m: Row, ranges: Row) -> None:
    """Write the ranges of one turn, anticlockwise from straight ahead.

    Args:
        begin: the robot when the turn began.
        end: the robot when it had ended.
        beam: the lidar.
        grid: what stands in the arena.
        others: other robots: float64 [N, 3], x, y, radius in m of map.
        noise_m: the error of each ray.
        ranges: filled with the range of each ray in m, or NOTHING_M.
    """
    count = len(ranges)
    turned = wrap_angle(end.yaw_rad - begin.yaw_rad)
    for index in range(count):
        share = index / count
        x = between(begin.x_m, end.x_m, begin.vx_map_mps, end.vx_map_mps, beam.turn_s, share)
        y = between(begin.y_m, end.y_m, begin.vy_map_mps, end.vy_map_mps, beam.turn_s, share)
        yaw = begin.yaw_rad + between(0.0, turned, begin.yaw_rate_radps, end.yaw_rate_radps, beam.turn_s, share)
        x += beam.x_m * cos(yaw)
        y += beam.x_m * sin(yaw)
        angle = yaw + share * TWO_PI
        # A little further than it measures: noise may bring an echo back into its range.
        found = cast(x, y, cos(angle), sin(angle), beam.max_m + 1.0, grid, others)
        if found < NO_HIT_M:
            found += noise_m[index]
        ranges[index] = found if beam.min_m <= found <= beam.max_m else NOTHING_M


@kernel
def between(begin: float, end: float, begin_rate: float, end_rate: float, span_s: float, share: float) -> float:
    """Return the cubic between two values with these rates, `share` (0 to 1) of the way: Hermite's."""
    square = share * share
    cube = square * share
    bend = 3.0 * square - 2.0 * cube
    lean = span_s * ((cube - 2.0 * square + share) * begin_rate + (cube - square) * end_rate)
    return begin + bend * (end - begin) + lean
