"""The plan of the next seconds: the way on which the applied command leads the vehicle. Pure arrays, no rerun."""

from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.scene.entities import Array

AHEAD_S: Final = 3.0
POINTS: Final = 13
RATE_HZ: Final = 10
LIFT_M: Final = 0.25

WAY_COLUMNS: Final = (
    "vehicle.x_m",
    "vehicle.y_m",
    "vehicle.z_m",
    "vehicle.yaw_rad",
    "vehicle.vx_mps",
    "command.road_wheel_rad",
    "command.target_yaw_rate_radps",
)
"""The columns of a state vector that the way is made of."""


class Ways(NamedTuple):
    """Ways in `map`, each from base_link."""

    times_ns: NDArray[np.int64]  # [ways]
    points: Array  # [ways, POINTS, 3] m


def ways(
    table: Mapping[str, Array],
    ticks: NDArray[np.int64],
    times_ns: NDArray[np.int64],
    tick_hz: int,
    wheelbase_m: float,
) -> Ways:
    """Return the ways on from some ticks: as far as AHEAD_S lead, with speed and command as they are.

    Args:
        table: WAY_COLUMNS columns of state vectors in their order.
        ticks: of each of them.
        times_ns: of each of them.
        tick_hz: ticks per second.
        wheelbase_m: of a car, which its road wheels turn; 0: the vehicle turns at the yaw rate it is told.
    """
    at = np.flatnonzero(ticks % max(1, round(tick_hz / RATE_HZ)) == 0)
    x, y, z, yaw, speed, road_wheel, asked = (table[name][at] for name in WAY_COLUMNS)
    turning = speed * np.tan(road_wheel) / wheelbase_m if wheelbase_m > 0.0 else asked
    passed = np.linspace(0.0, AHEAD_S, POINTS)
    # An arc as its chord: of this length, half of the turn to the side.
    half = 0.5 * turning[:, None] * passed
    chord = speed[:, None] * passed * np.sinc(half / np.pi)
    heading = yaw[:, None] + half
    points = np.stack(
        (x[:, None] + chord * np.cos(heading), y[:, None] + chord * np.sin(heading), z[:, None] + 0.0 * chord), axis=-1
    )
    points[..., 2] += LIFT_M
    return Ways(times_ns[at], points)
