"""How fast to drive where: speed limit, lateral acceleration, acceleration and braking, smoothed against jerk.

An open course ends with a stop: the speed from which its end is reached with a deceleration that fades out.
"""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.drivers.path_tracker.tracker_settings import Comfort
from simconsole.values.numerics.array_functions import cube_root
from simconsole.world.route import Route

Array = NDArray[np.float64]

STEP_M: Final = 0.5
_PASSES: Final = 2  # the second lap starts at the speed with which the first ended
_STOP_MPS2: Final = 1.2
_STOP_JERK_MPS3: Final = 0.8
EMERGENCY_MPS2: Final = 3.0
"""Who must brake harder than this brakes for an emergency: comfort no longer bounds the jerk."""
EMERGENCY_JERK_MPS3: Final = 20.0
_SLOWEST_MPS: Final = 1.0  # that is smoothed over time; slower than this the car is about to stop
_STOPPED_S: Final = 0.3
"""So long before a stop the deceleration fades no more: what is asked of a standing car is to brake."""


class SpeedProfile(NamedTuple):
    """Speed and acceleration every `step_m` along one lap, float64 [N]."""

    step_m: float
    speed_mps: Array
    accel_mps2: Array
    end_m: float | None = None  # where to stop; None: the course is a loop

    def at(self, s_m: float) -> tuple[float, float]:
        """Return (speed in m/s, acceleration in m/s2) at `s_m` of any lap, linear between the points."""
        place = s_m / self.step_m
        index = int(place // 1.0)
        share, count = place - index, len(self.speed_mps)
        if self.end_m is None:
            here, there = index % count, (index + 1) % count
        else:
            here, there = min(max(index, 0), count - 1), min(max(index + 1, 0), count - 1)
        speed = self.speed_mps.item(here) * (1.0 - share) + self.speed_mps.item(there) * share
        accel = self.accel_mps2.item(here) * (1.0 - share) + self.accel_mps2.item(there) * share
        if self.end_m is None:
            return speed, accel
        return min((speed, accel), stopping(self.end_m - s_m))

    @property
    def lap_s(self) -> float:
        """Time of one lap in s."""
        return float(np.sum(self.step_m / self.speed_mps))


class Stop(NamedTuple):
    """A place on the course to stop at, and the deceleration on the way there."""

    s_m: float
    brake_mps2: float


def stopping(left_m: float, brake_mps2: float = _STOP_MPS2) -> tuple[float, float]:
    """Return (speed in m/s, acceleration in m/s2) with `left_m` to go to a stop.

    A deceleration of `brake_mps2` that fades out in the last part with constant jerk: s = j t^3 / 6 before the end. In
    an emergency that part is short.
    """
    if left_m <= 0.0:
        return 0.0, -_STOP_JERK_MPS3 * _STOPPED_S
    fade_mps3 = EMERGENCY_JERK_MPS3 if brake_mps2 > EMERGENCY_MPS2 else _STOP_JERK_MPS3
    fade_s = brake_mps2 / fade_mps3
    fade_m, fade_mps = fade_mps3 * fade_s**3 / 6.0, 0.5 * brake_mps2 * fade_s
    if left_m >= fade_m:
        return math.sqrt(fade_mps**2 + 2.0 * brake_mps2 * (left_m - fade_m)), -brake_mps2
    left_s = math.cbrt(6.0 * left_m / fade_mps3)
    return 0.5 * fade_mps3 * left_s**2, -max(fade_mps3 * left_s, _STOP_JERK_MPS3 * _STOPPED_S)


def plan_speed(course: Route, comfort: Comfort, top_mps: float | None = None) -> SpeedProfile:
    """Return the profile of a flying lap: never above the limits of `comfort` and of the course (or `top_mps`).

    An open course is entered at any speed that the profile has, and ends with a stop.
    """
    count = round(course.length_m / STEP_M)
    step, closed = course.length_m / count, course.closed
    curvature = np.array([course.curvature_at((index + 0.5) * step) for index in range(count)])
    limits = course.limits_at(np.arange(count, dtype=np.float64) * step)
    top = (limits if top_mps is None else np.full(count, top_mps)) - comfort.margin_mps
    bend = np.sqrt(comfort.lateral_mps2 / np.maximum(np.abs(curvature), 1e-9))
    bending = np.abs(_shifted(curvature, -1, closed) - _shifted(curvature, 1, closed)) / (2.0 * step)
    ramp = cube_root(comfort.lateral_jerk_mps3 / np.maximum(bending, 1e-9))
    speed = np.minimum(top, np.minimum(bend, ramp))
    # The smoothing below averages over a bend's neighbourhood: there, too, no speed may exceed the bend's own.
    reach = max(1, round(0.25 * comfort.smoothing_s * float(speed.min()) / step))
    speed = np.min([_shifted(speed, shift, closed) for shift in range(-reach, reach + 1)], axis=0)
    if not closed:
        ends = [stopping(course.length_m - index * step)[0] for index in range(count)]
        speed = np.minimum(speed, np.maximum(ends, _SLOWEST_MPS))
    speed = _limited(speed, comfort.accelerate_mps2, step, closed)
    speed = _limited(speed[::-1], comfort.brake_mps2, step, closed)[::-1]
    speed = _smoothed(speed, comfort.smoothing_s, step, closed)
    accel = (_shifted(speed, -1, closed) ** 2 - _shifted(speed, 1, closed) ** 2) / (4.0 * step)
    return SpeedProfile(step, speed, accel, None if closed else course.length_m)


def _shifted(values: Array, by: int, closed: bool) -> Array:
    """Return the values `by` places on, round the loop or, of an open course, with those at its ends repeated."""
    if closed:
        return np.roll(values, by)
    return np.asarray(values[np.clip(np.arange(len(values)) - by, 0, len(values) - 1)])


def _limited(speed: Array, accel_mps2: float, step_m: float, closed: bool) -> Array:
    """Cut the speed so that it never rises faster than `accel_mps2` in the direction of the array, round a loop."""
    result = speed.tolist()
    rise = 2.0 * accel_mps2 * step_m
    for _ in range(_PASSES):
        before = result[-1] if closed else result[0]
        for index, value in enumerate(result):
            reachable = (before * before + rise) ** 0.5
            before = result[index] = reachable if reachable < value else value
    return np.array(result)


def _smoothed(speed: Array, window_s: float, step_m: float, closed: bool) -> Array:
    """Average the speed over a window of time, centred: the acceleration's steps become ramps."""
    if closed:
        laps = np.concatenate((speed, speed, speed))
    else:
        laps = np.concatenate((np.full_like(speed, speed[0]), speed, np.full_like(speed, speed[-1])))
    time = np.concatenate(((0.0,), np.cumsum(step_m / laps)))
    way = np.arange(len(time)) * step_m
    middle = time[len(speed) : 2 * len(speed)]
    ahead = np.interp(middle + 0.5 * window_s, time, way)
    behind = np.interp(middle - 0.5 * window_s, time, way)
    return np.asarray((ahead - behind) / window_s)
