"""What every vehicle must do that the console drives, its own and those of other packages. Pure: calls and compares."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import numpy as np

from simconsole.values.kernels import Row
from simconsole.values.layout import Part, read, write
from simconsole.values.platform import Platform
from simconsole.values.signals import VehicleCommand, VehicleState
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT

SUBSTEPS: Final = 4
TICKS: Final = 500
STANDS_M: Final = 0.05
"""By how much a vehicle that nobody moves may settle."""
RELEASED: Final = VehicleCommand(*(0.0,) * len(VehicleCommand._fields))._replace(automatic=1.0, gear=1.0)


def problems(platform: Platform) -> list[str]:
    """Return what is wrong with a vehicle that was built at rest, nothing where it keeps the contract."""
    return list(shape(platform)) or list(_behaviour(platform))


def shape(platform: Platform) -> Iterator[str]:
    """Yield what is wrong with a vehicle before it is ever stepped."""
    if not isinstance(platform, Platform):
        yield f"{type(platform).__name__}: a Platform"
        return
    if not isinstance(platform.initial_vehicle, VehicleState):
        yield "initial_vehicle: a VehicleState"
        return
    if not hasattr(platform.state, "_fields"):
        yield "state: a NamedTuple of floats"
        return
    for name in ("parameters", "ground"):
        row = getattr(platform, name)
        if not isinstance(row, np.ndarray) or row.dtype != np.float64 or row.ndim != 1:
            yield f"{name}: a float64 array of one dimension"
    if not callable(platform.step):
        yield "step: a function"
    width, columns = len(platform.initial_state), Part(platform.state).width
    if width != columns:
        yield f"initial_state: {width} values, {columns} columns"
    if not np.isfinite(platform.initial_state).all() or not np.isfinite(platform.initial_vehicle).all():
        yield "initial_state: a value is not finite"
    for name in ("steering_ratio", "max_road_wheel_rad", "wheelbase_m", "length_m", "width_m", "height_m"):
        if not 0.0 < getattr(platform, name) < math.inf:
            yield f"{name}: not above 0"


def _behaviour(platform: Platform) -> Iterator[str]:
    rest = _driven(platform, RELEASED._replace(brake=1.0))
    if not np.isfinite(rest).all():
        yield "braked at rest: a value is not finite"
        return
    first, last = (read(row, LAYOUT.vehicle) for row in (rest[0], rest[-1]))
    if math.hypot(last.x_m - first.x_m, last.y_m - first.y_m) > STANDS_M:
        yield f"braked at rest: it moves {math.hypot(last.x_m - first.x_m, last.y_m - first.y_m):.3g} m"
    full = RELEASED._replace(throttle=1.0, target_speed_mps=1.0, target_x_m=10.0)
    rows = _driven(platform, full)
    if not np.isfinite(rows).all():
        yield "full throttle: a value is not finite"
        return
    if _driven(platform, full).tobytes() != rows.tobytes():
        yield "full throttle: the same commands from the same state give other bits"
    after = rows[-1].copy()
    platform.step(rows[TICKS // 2 - 1], after, platform.parameters, platform.ground, SUBSTEPS)
    if after[LAYOUT.vehicle.slice].tobytes() != rows[TICKS // 2][LAYOUT.vehicle.slice].tobytes():
        yield "a tick that is made again is another one: the step keeps something beside its state"
    yield from _turns(platform, rows[-1])


def _turns(platform: Platform, moving: Row) -> Iterator[str]:
    """Look whether a vehicle that moves is steered to the side that it is asked to."""
    seen = read(moving, LAYOUT.vehicle)
    if abs(seen.vx_mps) < 1.0 or platform.turns_in_place:
        return
    yaw = [
        read(_driven(platform, RELEASED._replace(road_wheel_rad=side * 0.05, throttle=0.5))[-1], LAYOUT.vehicle).yaw_rad
        for side in (1.0, -1.0)
    ]
    start = platform.initial_vehicle.yaw_rad
    if not yaw[0] > start > yaw[1]:
        yield f"steered left and right: it turns to {yaw[0]:.3g} and {yaw[1]:.3g} rad, left is positive"


def _driven(platform: Platform, command: VehicleCommand) -> Row:
    """Return the state vectors of a drive from rest with one command, float64 [TICKS + 1, columns]."""
    rows = np.zeros((TICKS + 1, PLATFORM_AT + len(platform.initial_state)))
    write(rows[0], LAYOUT.vehicle, VehicleState(*platform.initial_vehicle))
    rows[0, PLATFORM_AT:] = platform.initial_state
    for row in rows:
        write(row, LAYOUT.command, command)
    for before, row in pairwise(rows):
        platform.step(before, row, platform.parameters, platform.ground, SUBSTEPS)
    return rows
