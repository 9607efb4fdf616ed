"""Where a drive was, tick by tick: what most figures need of it, and the only columns of it that stay in memory."""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.values.signals import Mode
from simconsole.world.course import Course

JUMP_M: Final = 1.0
"""A vehicle that moved further in one tick was put there (a restart): it did not drive."""

_COLUMNS: Final = ("vehicle.x_m", "vehicle.y_m", "vehicle.vx_mps", "vehicle.vy_mps", "arbitration.mode")


class Track(NamedTuple):
    """A drive along its course, [ticks] each: 25 bytes a tick."""

    distance_m: Array  # driven since the first tick
    speed_mps: Array
    mode: NDArray[np.int8]
    lateral_m: Array  # left of the theoretical path; empty without a course

    @property
    def autonomous(self) -> NDArray[np.bool_]:
        """Where the controller on the ROS side had the car."""
        found: NDArray[np.bool_] = self.mode == np.int8(Mode.AUTONOMOUS)
        return found


def track(drive: Drive, course: Course | None) -> Track:
    """Return where the drive was, tick by tick."""
    x, y, speed = np.empty(drive.ticks), np.empty(drive.ticks), np.empty(drive.ticks)
    mode, at = np.empty(drive.ticks, np.int8), 0
    for block in drive.read(_COLUMNS):
        part = slice(at, at + len(block))
        x[part], y[part], mode[part] = block[:, 0], block[:, 1], block[:, 4]
        np.hypot(block[:, 2], block[:, 3], out=speed[part])
        at += len(block)
    lateral = course.project_all(x, y)[1] if course is not None else np.zeros(0)
    return Track(_distance_m(x, y), speed, mode, lateral)


def _distance_m(x: Array, y: Array) -> Array:
    steps = np.diff(x, prepend=x[0])
    np.hypot(steps, np.diff(y, prepend=y[0]), out=steps)
    steps[steps > JUMP_M] = 0.0
    return np.cumsum(steps, out=steps)
