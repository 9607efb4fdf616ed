"""The path tracker: linear-quadratic steering with preview of the path's curvature, and a planned speed.

Model, in the frame of the path at base_link: offset, heading error, lateral speed and yaw rate of a linear
single-track car, first-order steering, a command that takes effect `delay_s` late; the input is the change of the
command per period, so that a constant curve costs nothing. The known curvature ahead enters as the model's
disturbance. Gains are designed per speed and interpolated. What they work on is the car as it will be when the command
takes effect (state_estimator.py), and no command turns the wheels faster or further than the console's gate lets pass:
what is asked for is what is done, so nothing winds up. Errors are small by construction: a car that is handed over
beside the path, or is pushed off it, is led back along a smooth line (approach.py), which is what is tracked.
"""

import math
from copy import copy
from typing import Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.drivers.path_tracker.approach import ON_PATH, approach_from
from simconsole.drivers.path_tracker.riccati import Gains, design, discretised
from simconsole.drivers.path_tracker.speed_control import SpeedControl
from simconsole.drivers.path_tracker.speed_profile import SpeedProfile
from simconsole.drivers.path_tracker.state_estimator import StateEstimator, VehicleMotion
from simconsole.drivers.path_tracker.tracker_settings import (
    COMFORT,
    GATE,
    HATCHBACK,
    TIMING,
    WEIGHTS,
    CarModel,
    Comfort,
    Gate,
    Timing,
    Weights,
    asked_at_most,
    planned_within,
)
from simconsole.values.kernels import clip
from simconsole.world.route import Route

Array = NDArray[np.float64]

_SPEEDS_MPS: Final = (1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 10.0, 11.5, 13.0, 14.5, 17.0, 20.0, 24.0, 29.0, 36.0)
_SPEED_STEP_MPS: Final = 0.02
_STATES: Final = 6
_CURVATURE_STEP_M: Final = 0.1
_PUSHED_OFF_M: Final = 0.3
_STEERING_RATE_RADPS: Final = 0.8


class TrackerCommand(NamedTuple):
    """What the tracker asks for."""

    road_wheel_rad: float
    road_wheel_radps: float
    speed_mps: float
    accel_mps2: float
    jerk_mps3: float


class Tracker:
    """Follows a course. One `step` per control period; it remembers its last commands and where it was."""

    def __init__(
        self,
        course: Route,
        car: CarModel = HATCHBACK,
        comfort: Comfort = COMFORT,
        timing: Timing = TIMING,
        weights: Weights = WEIGHTS,
        gate: Gate = GATE,
    ) -> None:
        self.course = course
        self.s_m: float | None = None
        self.lateral_m = 0.0
        self.heading_error_rad = 0.0
        self._car, self._timing, self._asked = car, timing, asked_at_most(gate)
        self._wheelbase_m, self._most_tangent = car.wheelbase_m, math.tan(car.max_road_wheel_rad)
        self.along = SpeedControl(course, planned_within(comfort, gate), timing.period_s)
        self._feedback, self._preview = _gains_by_speed(car, timing, weights)
        self._curvature_step_m, self._curvature = _curvatures(course)
        ahead_s = (np.arange(timing.preview_steps) + 0.5) * timing.period_s
        # Where the car will be, in steps of the curvature: by its place, its speed and its acceleration.
        self._steps_per_m = 1.0 / self._curvature_step_m
        self._steps_per_mps = ahead_s / self._curvature_step_m
        self._steps_per_mps2 = 0.5 * ahead_s * ahead_s / self._curvature_step_m
        self._beyond: Literal["wrap", "clip"] = "wrap" if course.closed else "clip"
        self._command = 0.0  # the last command, as the tangent of the road-wheel angle
        self._wheel = 0.0  # where the wheels will be when the next command takes effect, by the model; a tangent too
        self._estimator = StateEstimator(car, timing)
        self._line = ON_PATH

    def __copy__(self) -> "Tracker":
        """Return a tracker that goes on from here by itself; course, plan and gains are shared, they never change."""
        other = Tracker.__new__(Tracker)
        other.__dict__.update(self.__dict__)
        other._estimator, other.along = copy(self._estimator), copy(self.along)
        return other

    @property
    def profile(self) -> SpeedProfile:
        """The planned speed."""
        return self.along.profile

    @property
    def acts_after_s(self) -> float:
        """How long after what was seen last the car is at `s_m`: when the command takes effect."""
        return self._timing.delay_s

    def offset_at(self, s_m: float) -> tuple[float, float]:
        """Return the offset (m) of the line that is tracked from the course at `s_m`, and its slope against it."""
        return self._line.at(s_m)

    def step(self, seen: VehicleMotion, engaged: bool = True, time_s: float | None = None) -> TrackerCommand:
        """Return the command for the coming period.

        While not `engaged` the command is the one to begin with at an engagement: the memory of steering and
        acceleration follows the car instead of the tracker's own commands. `time_s` is the stamp of what was seen; None
        is one period after the one before.
        """
        found = self.s_m is not None
        if not (engaged and found):  # at its first sight of the car, too: somebody has steered it so far
            self._follow(seen, max(seen.vx_mps, 0.0))
        now, self._wheel = self._estimator.observe(seen, time_s, self.along.accel_mps2 if engaged else 0.0)
        place = self.course.project(now.x_m, now.y_m, self.s_m, now.yaw_rad)
        self.s_m, self.lateral_m, self.heading_error_rad = place
        speed = now.vx_mps
        offset, slope = self._line.at(place.s_m)
        if not (engaged and found) or abs(place.lateral_m - offset) > _PUSHED_OFF_M:
            course_rad = place.heading_error_rad + (now.vy_mps / speed if speed > 1.0 else 0.0)
            turning = now.yaw_rate_radps / max(speed, 1.0) - self.course.curvature_at(place.s_m)
            self._line = approach_from(place.s_m, place.lateral_m, course_rad, speed, turning)
            offset, slope = self._line.at(place.s_m)
        heading = place.heading_error_rad - math.atan(slope)
        before = self._command
        change = self._change(now, place.s_m, place.lateral_m - offset, heading)
        self._command = self._limited(change, speed, engaged)
        self._estimator.sent(self._command)
        turned = (math.atan(self._command) - math.atan(before)) / self._timing.period_s
        return TrackerCommand(math.atan(self._command), turned, *self.along.step(place.s_m, speed))

    def _change(self, seen: VehicleMotion, s_m: float, lateral_m: float, heading_rad: float) -> float:
        """Return by how much the command's tangent should change in the coming period."""
        speed = seen.vx_mps
        row = min(max(int((speed - _SPEEDS_MPS[0]) / _SPEED_STEP_MPS + 0.5), 0), len(self._feedback) - 1)
        steps = self._steps_per_mps * speed + self._steps_per_m * s_m + self._steps_per_mps2 * self.along.accel_mps2
        ahead = self._curvature.take(steps.astype(np.int64), mode=self._beyond)
        if not self._line.is_over(s_m):
            ahead += self._line.curvature(steps * self._curvature_step_m)
        offset, heading, across, turning, wheel, command = self._feedback[row]
        fed_back: float = (
            offset * lateral_m
            + heading * heading_rad
            + across * seen.vy_mps
            + turning * seen.yaw_rate_radps
            + wheel * self._wheel
            + command * self._command
        )
        return -fed_back - float(np.add.reduce(self._preview[row] * ahead))  # not `dot`: its order is the processor's

    def _limited(self, change: float, speed: float, engaged: bool) -> float:
        """Return the command after a change, as far as steering and gate go; while not engaged no gate holds it."""
        tightest = self._wheelbase_m / max(speed * speed, 1.0)
        rate = min(_STEERING_RATE_RADPS, self._asked.lateral_jerk_mps3 * tightest) if engaged else _STEERING_RATE_RADPS
        step = rate * self._timing.period_s
        limit = min(self._most_tangent, self._asked.lateral_mps2 * tightest)
        return clip(self._command + clip(change, -step, step), -limit, limit)

    def _follow(self, seen: VehicleMotion, speed: float) -> None:
        """Take steering and acceleration from the car's motion: someone else drives it."""
        if speed > _SPEEDS_MPS[0]:
            needed = self._car.wheelbase_m + self._car.understeer_radps2pm * speed * speed
            limit = self._most_tangent
            self._wheel = self._command = clip(seen.yaw_rate_radps / speed * needed, -limit, limit)
        else:
            self._wheel = self._command = 0.0
        self._estimator.reset(self._command)
        self.along.accel_mps2 = 0.0


def _curvatures(course: Route) -> tuple[float, Array]:
    """Return (distance in m, curvatures in 1/m in the middle of each such part); an open course ends with one of 0."""
    count = round(course.length_m / _CURVATURE_STEP_M)
    step = course.length_m / count
    return step, np.array([course.curvature_at((i + 0.5) * step) for i in range(count + (not course.closed))])


def _gains_by_speed(car: CarModel, timing: Timing, weights: Weights) -> tuple[list[list[float]], Array]:
    """Return the gains of feedback and of preview [N, steps], one row for each _SPEED_STEP_MPS from the slowest speed.

    They are designed for a few speeds and linear between them.
    """
    designs = [_design(car, timing, weights, speed) for speed in _SPEEDS_MPS]
    designed = np.array([[*gains.feedback, *gains.preview] for gains in designs])
    speeds = np.arange(_SPEEDS_MPS[0], _SPEEDS_MPS[-1] + 0.5 * _SPEED_STEP_MPS, _SPEED_STEP_MPS)
    gains = np.array([np.interp(speeds, _SPEEDS_MPS, column) for column in designed.T]).T
    return gains[:, :_STATES].tolist(), np.ascontiguousarray(gains[:, _STATES:])


def _design(car: CarModel, timing: Timing, weights: Weights, speed: float) -> Gains:
    """Return the gains at one speed; states: offset, heading, lateral speed, yaw rate, wheels, last command."""
    a, b, d = _car(car, speed)
    inputs = np.hstack((b, d))
    step, step_in = discretised(a, inputs, timing.period_s)
    n = len(a)
    whole = np.zeros((n + 1, n + 1))
    whole[:n, :n] = step
    whole[:n, n:] = step_in[:, :1]
    whole[n, n] = 1.0
    command = np.vstack((step_in[:, :1], ((1.0,),)))
    curvature = np.vstack((step_in[:, 1:], ((0.0,),)))
    drift = np.zeros(n + 1)
    drift[1], drift[2] = speed, 1.0
    cost = weights.drift * np.outer(drift, drift)
    cost[0, 0] += weights.offset
    change = weights.change * max(1.0, (speed / weights.gentle_mps) ** 4)
    return design(whole, command, curvature, cost, change, timing.preview_steps)


def _car(car: CarModel, speed: float) -> tuple[Array, Array, Array]:
    """Return (a, b, d) of the continuous model for states offset, heading, lateral speed and yaw rate, wheels.

    Lateral speed is base_link's: the centre of gravity's is vy + l_r r.
    """
    m, j, lf, lr = car.mass_kg, car.yaw_inertia_kgm2, car.front_m, car.rear_m
    cf, cr = car.front_stiffness_nprad, car.rear_stiffness_nprad
    # Slip angles: front (vy + L r)/v - wheel, rear vy/v.
    front, rear = np.zeros(5), np.zeros(5)
    front[2], front[3], front[4] = -cf / speed, -cf * car.wheelbase_m / speed, cf
    rear[2] = -cr / speed
    yaw = (lf * front - lr * rear) / j
    across = (front + rear) / m
    across[3] -= speed
    a = np.zeros((5, 5))
    a[0, 1], a[0, 2] = speed, 1.0
    a[1, 3] = 1.0
    a[2] = across - lr * yaw
    a[3] = yaw
    a[4, 4] = -1.0 / car.steering_lag_s
    b, d = np.zeros((5, 1)), np.zeros((5, 1))
    b[4, 0] = 1.0 / car.steering_lag_s
    d[1, 0] = -speed
    return a, b, d
