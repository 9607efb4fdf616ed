"""Where a drive was, tick by tick: what most figures need of it, and the only columns of it that stay in memory."""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.values.signals import Mode
from simconsole.world.route import Route

JUMP_M: Final = 1.0
"""A vehicle that moved further in one tick was put there (a restart): it did not drive."""

_COLUMNS: Final = ("vehicle.x_m", "vehicle.y_m", "vehicle.vx_mps", "vehicle.vy_mps", "arbitration.mode")


class Track(NamedTuple):
    """A drive along its route, [ticks] each: 25 bytes a tick, 33 where limits change."""

    distance_m: Array  # driven since the first tick
    speed_mps: Array
    mode: NDArray[np.int8]
    lateral_m: Array  # left of the theoretical path; empty without a route
    limit_mps: Array  # the speed limit there; infinite without a route

    @property
    def autonomous(self) -> NDArray[np.bool_]:
        """Where the controller on the ROS side had the car."""
        found: NDArray[np.bool_] = self.mode == np.int8(Mode.AUTONOMOUS)
        return found

    @property
    def manual(self) -> NDArray[np.bool_]:
        """Where the person had the car alone."""
        found: NDArray[np.bool_] = self.mode == np.int8(Mode.MANUAL)
        return found


def track(drive: Drive, route: Route | None) -> Track:
    """Return where the drive was, tick by tick."""
    x, y, speed = np.empty(drive.ticks), np.empty(drive.ticks), np.empty(drive.ticks)
    mode, at = np.empty(drive.ticks, np.int8), 0
    for block in drive.read(_COLUMNS):
        part = slice(at, at + len(block))
        x[part], y[part], mode[part] = block[:, 0], block[:, 1], block[:, 4]
        np.hypot(block[:, 2], block[:, 3], out=speed[part])
        at += len(block)
    lateral, limit = np.zeros(0), np.broadcast_to(np.array(math.inf), len(x))
    if route is not None:
        places, lateral = route.project_all(x, y)
        one = bool((route.limit == route.speed_limit_mps).all())
        limit = np.broadcast_to(np.array(route.speed_limit_mps), len(x)) if one else route.limits_at(places)
    return Track(
        distance_m=_distance_m(x, y),
        speed_mps=speed,
        mode=mode,
        lateral_m=lateral,
        limit_mps=limit,
    )


def _distance_m(x: Array, y: Array) -> Array:
    steps = np.diff(x, prepend=x[0])
    np.hypot(steps, np.diff(y, prepend=y[0]), out=steps)
    steps[steps > JUMP_M] = 0.0
    return np.cumsum(steps, out=steps)
