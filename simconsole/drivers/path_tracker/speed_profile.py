"""How fast to drive where: speed limit, lateral acceleration, acceleration and braking, smoothed against jerk."""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.drivers.path_tracker.tracker_settings import Comfort
from simconsole.world.course import Course

Array = NDArray[np.float64]

STEP_M: Final = 0.5
_PASSES: Final = 2  # the second lap starts at the speed with which the first ended


class SpeedProfile(NamedTuple):
    """Speed and acceleration every `step_m` along one lap, float64 [N]."""

    step_m: float
    speed_mps: Array
    accel_mps2: Array

    def at(self, s_m: float) -> tuple[float, float]:
        """Return (speed in m/s, acceleration in m/s2) at `s_m` of any lap, linear between the points."""
        place = s_m / self.step_m
        index = int(place // 1.0)
        share, count = place - index, len(self.speed_mps)
        here, there = index % count, (index + 1) % count
        speed = float(self.speed_mps[here]) * (1.0 - share) + float(self.speed_mps[there]) * share
        accel = float(self.accel_mps2[here]) * (1.0 - share) + float(self.accel_mps2[there]) * share
        return speed, accel

    @property
    def lap_s(self) -> float:
        """Time of one lap in s."""
        return float(np.sum(self.step_m / self.speed_mps))


def plan_speed(course: Course, comfort: Comfort, top_mps: float | None = None) -> SpeedProfile:
    """Return the profile of a flying lap: never above the limits of `comfort` and of the course (or `top_mps`)."""
    count = round(course.length_m / STEP_M)
    step = course.length_m / count
    curvature = np.array([course.curvature_at((index + 0.5) * step) for index in range(count)])
    top = (course.speed_limit_mps if top_mps is None else top_mps) - comfort.margin_mps
    bend = np.sqrt(comfort.lateral_mps2 / np.maximum(np.abs(curvature), 1e-9))
    bending = np.abs(np.roll(curvature, -1) - np.roll(curvature, 1)) / (2.0 * step)
    ramp = np.cbrt(comfort.lateral_jerk_mps3 / np.maximum(bending, 1e-9))
    speed = np.minimum(top, np.minimum(bend, ramp))
    # The smoothing below averages over a bend's neighbourhood: there, too, no speed may exceed the bend's own.
    reach = max(1, round(0.25 * comfort.smoothing_s * float(speed.min()) / step))
    speed = np.min([np.roll(speed, shift) for shift in range(-reach, reach + 1)], axis=0)
    speed = _limited(speed, comfort.accelerate_mps2, step)
    speed = _limited(speed[::-1], comfort.brake_mps2, step)[::-1]
    speed = _smoothed(speed, comfort.smoothing_s, step)
    accel = (np.roll(speed, -1) ** 2 - np.roll(speed, 1) ** 2) / (4.0 * step)
    return SpeedProfile(step, speed, accel)


def _limited(speed: Array, accel_mps2: float, step_m: float) -> Array:
    """Cut the speed so that it never rises faster than `accel_mps2` in the direction of the array, round the loop."""
    result = speed.tolist()
    rise = 2.0 * accel_mps2 * step_m
    for _ in range(_PASSES):
        before = result[-1]
        for index, value in enumerate(result):
            reachable = (before * before + rise) ** 0.5
            before = result[index] = reachable if reachable < value else value
    return np.array(result)


def _smoothed(speed: Array, window_s: float, step_m: float) -> Array:
    """Average the speed over a window of time, centred: the acceleration's steps become ramps."""
    laps = np.concatenate((speed, speed, speed))
    time = np.concatenate(((0.0,), np.cumsum(step_m / laps)))
    way = np.arange(len(time)) * step_m
    middle = time[len(speed) : 2 * len(speed)]
    ahead = np.interp(middle + 0.5 * window_s, time, way)
    behind = np.interp(middle - 0.5 * window_s, time, way)
    return np.asarray((ahead - behind) / window_s)
