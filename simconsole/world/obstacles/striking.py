"""What fixed things do to the vehicle that runs into them: an impulse in each tick in which it moves on into them.

What of an outline lies in the vehicle's footprint is taken as a chord: the sum of its sides' normals, each as long as
the side there, is the direction in which the thing pushes, and the sides' common middle is where. Sides that look away
from the footprint's middle are the far ones of something thin. A kernel, a stage of the tick.
"""

import math
from typing import Final, NamedTuple

from simconsole.values.kernels import Row, kernel
from simconsole.values.layout import read, write
from simconsole.values.signals import ObstacleImpact, VehicleState
from simconsole.values.state_vector import LAYOUT
from simconsole.values.trigonometry import direction
from simconsole.world.obstacles.impulse import RESTITUTION, Mobility, impulse
from simconsole.world.obstacles.sides import BODY, CELL_M, Body, FixedThings

OUT_PER_S: Final = 2.0
OUT_MPS: Final = 0.2
"""Who is inside a thing and goes on into it leaves it at so much of the depth per second, at most so fast: else an
engine that pushes a car against a wall would press it through, a little in each tick (stabilisation as of Baumgarte,
Computer Methods in Applied Mechanics and Engineering 1 (1972), 1-16)."""
_THING, _PER_KG = 5, 6
_TOUCHES_AT: Final = LAYOUT.obstacle.at("touches")
_EVEN: Final = 1e-6  # share of a chord's length: its sides look in opposite directions


class Chord(NamedTuple):
    """The sides of one thing inside the vehicle's footprint: sums, each side counting by its length.

    Places are relative to the footprint's middle, x forward.
    """

    length_m: float
    x_m2: float
    y_m2: float
    normal_x_m: float
    normal_y_m: float


class Motion(NamedTuple):
    """How the vehicle moves, by its centre of gravity and in its own axes, and whether something touches it."""

    vx_mps: float
    vy_mps: float
    yaw_rate_radps: float
    touches: float


@kernel
def strike(previous: Row, row: Row, things: FixedThings) -> None:
    """Write into `row` what fixed things do to the vehicle, which is where `previous` says."""
    write(row, LAYOUT.obstacle, struck_by(read(previous, LAYOUT.vehicle), previous[_TOUCHES_AT], things))


@kernel
def struck_by(vehicle: VehicleState, touched: float, things: FixedThings) -> ObstacleImpact:
    """Return what fixed things do to a vehicle in one tick; `touched`: they did in the tick before."""
    columns, rows = things.grid[2], things.grid[3]
    column, row = (vehicle.x_m - things.grid[0]) / CELL_M, (vehicle.y_m - things.grid[1]) / CELL_M
    first = last = 0
    # No number is in no cell.
    if 0.0 <= column < columns and 0.0 <= row < rows:
        cell = int(row) * int(columns) + int(column)
        first, last = things.starts[cell], things.starts[cell + 1]
    if first == last:
        return ObstacleImpact(0.0, 0.0, 0.0, 0.0)
    body, heading = read(things.body, BODY), direction(vehicle.yaw_rad)
    middle_x = vehicle.x_m + body.middle_ahead_m * heading.cos
    middle_y = vehicle.y_m + body.middle_ahead_m * heading.sin
    before = Motion(
        vehicle.vx_mps, vehicle.vy_mps + body.cg_ahead_m * vehicle.yaw_rate_radps, vehicle.yaw_rate_radps, 0.0
    )
    motion, chord = before, Chord(0.0, 0.0, 0.0, 0.0, 0.0)
    for place in range(first, last):
        side = things.sides[things.items[place]]
        dx, dy = side[0] - middle_x, side[1] - middle_y
        inside = inside_footprint(
            dx * heading.cos + dy * heading.sin,
            dy * heading.cos - dx * heading.sin,
            side[2] * heading.cos + side[3] * heading.sin,
            side[3] * heading.cos - side[2] * heading.sin,
            side[4],
            body,
        )
        chord = Chord(
            chord.length_m + inside.length_m,
            chord.x_m2 + inside.x_m2,
            chord.y_m2 + inside.y_m2,
            chord.normal_x_m + inside.normal_x_m,
            chord.normal_y_m + inside.normal_y_m,
        )
        if place + 1 == last or things.sides[things.items[place + 1], _THING] != side[_THING]:
            motion = pushed(motion, chord, side[_PER_KG], touched, body)
            chord = Chord(0.0, 0.0, 0.0, 0.0, 0.0)
    return ObstacleImpact(
        motion.touches,
        motion.vx_mps - before.vx_mps,
        motion.vy_mps - before.vy_mps,
        motion.yaw_rate_radps - before.yaw_rate_radps,
    )


@kernel
def inside_footprint(x_m: float, y_m: float, towards_x: float, towards_y: float, length_m: float, body: Body) -> Chord:
    """Return what of a side lies in the footprint and looks towards its middle (clipped as of Liang and Barsky 1984).

    The side begins at (x_m, y_m) from the middle and leads `length_m` towards a direction of length 1.
    """
    low, high = 0.0, length_m
    for axis in range(2):
        half = body.half_length_m if axis == 0 else body.half_width_m
        at = x_m if axis == 0 else y_m
        towards = towards_x if axis == 0 else towards_y
        if towards == 0.0:
            if abs(at) >= half:
                high = low
        else:
            enters, leaves = (-half - at) / towards, (half - at) / towards
            if enters > leaves:
                enters, leaves = leaves, enters
            low = enters if enters > low else low
            high = leaves if leaves < high else high
    length = high - low
    middle = 0.5 * (low + high)
    x, y = x_m + middle * towards_x, y_m + middle * towards_y
    if length <= 0.0 or towards_y * x - towards_x * y >= 0.0:
        return Chord(0.0, 0.0, 0.0, 0.0, 0.0)
    return Chord(length, length * x, length * y, length * towards_y, -length * towards_x)


@kernel
def pushed(motion: Motion, chord: Chord, per_kg: float, touched: float, body: Body) -> Motion:
    """Return how the vehicle moves after one thing has pushed it; what is not fixed pushes only once."""
    size = math.sqrt(chord.normal_x_m * chord.normal_x_m + chord.normal_y_m * chord.normal_y_m)
    if size <= _EVEN * chord.length_m:
        return motion
    nx, ny = chord.normal_x_m / size, chord.normal_y_m / size
    x, y = chord.x_m2 / chord.length_m, chord.y_m2 / chord.length_m
    arm_x, arm_y = x + body.middle_ahead_m - body.cg_ahead_m, y
    vx, vy = motion.vx_mps - motion.yaw_rate_radps * arm_y, motion.vy_mps + motion.yaw_rate_radps * arm_x
    normal_mps, sliding_mps = vx * nx + vy * ny, vy * nx - vx * ny
    if normal_mps >= 0.0:
        return motion
    if body.per_kg == 0.0 or (per_kg > 0.0 and touched > 0.0):
        return Motion(motion.vx_mps, motion.vy_mps, motion.yaw_rate_radps, 1.0)
    depth_m = body.half_length_m * abs(nx) + body.half_width_m * abs(ny) + nx * x + ny * y
    leaving_mps = OUT_PER_S * depth_m if OUT_PER_S * depth_m < OUT_MPS else OUT_MPS
    if leaving_mps < -RESTITUTION * normal_mps:
        leaving_mps = -RESTITUTION * normal_mps
    turn_n, turn_t = arm_x * ny - arm_y * nx, arm_x * nx + arm_y * ny
    at = Mobility(
        normal=body.per_kg + per_kg + turn_n * turn_n * body.per_kgm2,
        along=body.per_kg + per_kg + turn_t * turn_t * body.per_kgm2,
        mixed=turn_n * turn_t * body.per_kgm2,
    )
    push = impulse(normal_mps, sliding_mps, leaving_mps - normal_mps, at)
    x_ns, y_ns = push.normal_ns * nx - push.along_ns * ny, push.normal_ns * ny + push.along_ns * nx
    return Motion(
        motion.vx_mps + x_ns * body.per_kg,
        motion.vy_mps + y_ns * body.per_kg,
        motion.yaw_rate_radps + (arm_x * y_ns - arm_y * x_ns) * body.per_kgm2,
        1.0,
    )
