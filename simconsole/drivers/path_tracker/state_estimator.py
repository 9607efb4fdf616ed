"""Where the car will be when the next command takes effect: noisy, late odometry made smooth and brought forward.

Two steps. A complementary filter: between two measurements the pose moves by the measured velocities, which are smooth;
the measured pose, which is noisy, corrects it by a small share. Where the measured positions keep going to one side of
where the measured yaw points, the yaw is wrong: its bias is integrated, so that a drifting localisation is followed
without a lag. And a prediction by the controller's own linear
single-track car through the delay, with the commands that are under way (Smith, Chem. Eng. Progress 53(5), 1957).
"""

import math
from typing import Final, NamedTuple

from simconsole.drivers.path_tracker.tracker_settings import CarModel, Timing
from simconsole.values.kernels import clip

_SUBSTEP_S: Final = 0.005
_KINEMATIC_MPS: Final = 1.5
"""Below this the tyres' slip angles are no use: the rear axle follows the wheels."""
_LOST_M: Final = 0.5
_LOST_RAD: Final = 0.2
_LONGEST_S: Final = 0.5
"""A longer silence is not integrated: the pose after it is believed."""
_MOST_BIAS_RAD: Final = 0.05
_ROUNDING_S: Final = 1e-9
"""A pose further off than this from the expected one is not noise: the car was put there, or the filter is new."""


class VehicleMotion(NamedTuple):
    """What the tracker is told: pose and body velocities of base_link."""

    x_m: float
    y_m: float
    yaw_rad: float
    vx_mps: float
    vy_mps: float
    yaw_rate_radps: float


class Predicted(NamedTuple):
    """The car at the moment at which the next command takes effect; `wheel` is the tangent of the road-wheel angle."""

    motion: VehicleMotion
    wheel: float


class StateEstimator:
    """Follows one car. `observe` once per measurement, `sent` for each command that answers one."""

    def __init__(self, car: CarModel, timing: Timing) -> None:
        self._car, self._timing = car, timing
        self._time_s = 0.0  # stamp of the newest measurement; pose, velocity, wheel and acting are of this moment
        self._pose: tuple[float, float, float] | None = None  # its yaw is as measured
        self._bias = 0.0  # to be added to that yaw: the direction in which the positions go
        self._velocity = (0.0, 0.0, 0.0)
        self._wheel = 0.0
        self._acting = 0.0
        self._under_way: list[tuple[float, float]] = []  # (when it takes effect, command), oldest first
        self._single_track = _single_track(car)

    def __copy__(self) -> "StateEstimator":
        """Return an estimator that goes on from here by itself."""
        other = StateEstimator(self._car, self._timing)
        other.__dict__.update(self.__dict__)
        other._under_way = list(self._under_way)
        return other

    def reset(self, wheel: float) -> None:
        """Forget the commands: the wheels stand at `wheel` (a tangent), somebody else steers."""
        self._under_way.clear()
        self._acting = self._wheel = wheel

    def observe(self, seen: VehicleMotion, time_s: float | None, accel_mps2: float) -> Predicted:
        """Take one measurement in; return the car when the command that is computed now takes effect.

        Args:
            seen: as measured.
            time_s: its stamp; None: one period after the one before. An interval without measurements is integrated; a
                stamp before the last one begins anew.
            accel_mps2: what has been asked of the car.
        """
        time_s = self._time_s + self._timing.period_s if time_s is None else time_s
        if time_s < self._time_s:  # another drive begins
            self._pose, self._time_s, self._bias = None, time_s, 0.0
            self.reset(self._acting)
        passed_s = min(time_s - self._time_s, _LONGEST_S)
        self._pose = self._filtered(seen, passed_s)
        self._velocity = (seen.vx_mps, seen.vy_mps, seen.yaw_rate_radps)
        while self._under_way and self._under_way[0][0] <= time_s + _ROUNDING_S:
            at, command = self._under_way.pop(0)
            self._turn_wheel(at)
            self._acting = command
        self._turn_wheel(time_s)
        return self._predicted(seen, accel_mps2)

    def sent(self, command: float) -> None:
        """Note the answer (a tangent) to the newest measurement: it takes effect `delay_s` after its stamp."""
        self._under_way.append((self._time_s + self._timing.delay_s, command))

    def _turn_wheel(self, until_s: float) -> None:
        if until_s > self._time_s:
            self._wheel = self._lagged(self._wheel, self._acting, until_s - self._time_s)
            self._time_s = until_s

    def _filtered(self, seen: VehicleMotion, passed_s: float) -> tuple[float, float, float]:
        if self._pose is None:
            return seen.x_m, seen.y_m, seen.yaw_rad
        x, y, yaw = self._pose
        vx, vy, rate = self._velocity
        turned = 0.5 * passed_s * (rate + seen.yaw_rate_radps)
        forward = 0.5 * passed_s * (vx + seen.vx_mps)
        x, y = _moved(x, y, yaw + self._bias + 0.5 * turned, forward, 0.5 * passed_s * (vy + seen.vy_mps))
        yaw += turned
        off_yaw = math.remainder(seen.yaw_rad - yaw, math.tau)
        if math.hypot(seen.x_m - x, seen.y_m - y) > _LOST_M or abs(off_yaw) > _LOST_RAD:
            self._bias = 0.0
            return seen.x_m, seen.y_m, seen.yaw_rad
        share = self._timing.pose_share
        if forward > passed_s * _KINEMATIC_MPS:
            left_m = (seen.y_m - y) * math.cos(yaw) - (seen.x_m - x) * math.sin(yaw)
            learned = self._bias + 0.25 * share * share * left_m / forward  # a quarter: two equal poles
            self._bias = clip(learned, -_MOST_BIAS_RAD, _MOST_BIAS_RAD)
        return x + share * (seen.x_m - x), y + share * (seen.y_m - y), yaw + self._timing.yaw_share * off_yaw

    def _predicted(self, seen: VehicleMotion, accel_mps2: float) -> Predicted:
        """Drive the model from the newest measurement through the delay."""
        assert self._pose is not None
        x, y, yaw = self._pose
        yaw += self._bias
        vx, vy, rate = max(seen.vx_mps, 0.0), seen.vy_mps, seen.yaw_rate_radps
        wheel, command, time = self._wheel, self._acting, self._time_s
        coming, end = list(self._under_way), self._time_s + self._timing.delay_s
        while time < end - _ROUNDING_S:
            while coming and coming[0][0] <= time + _ROUNDING_S:
                command = coming.pop(0)[1]
            until = min(end, time + _SUBSTEP_S, coming[0][0] if coming else end)
            h, wheel_before, vy_before, rate_before = until - time, wheel, vy, rate
            wheel = self._lagged(wheel, command, h)
            vx += h * accel_mps2
            if vx < 0.0:
                vx = 0.0
            vy, rate = self._turned(vx, vy, rate, 0.5 * (wheel_before + wheel), h)
            turned = 0.5 * h * (rate_before + rate)
            x, y = _moved(x, y, yaw + 0.5 * turned, h * vx, 0.5 * h * (vy_before + vy))
            yaw, time = yaw + turned, until
        motion = VehicleMotion(x_m=x, y_m=y, yaw_rad=yaw, vx_mps=vx, vy_mps=vy, yaw_rate_radps=rate)
        return Predicted(motion, wheel)

    def _lagged(self, wheel: float, command: float, duration_s: float) -> float:
        return command + (wheel - command) * math.exp(-duration_s / self._car.steering_lag_s)

    def _turned(self, vx: float, vy: float, rate: float, wheel: float, h: float) -> tuple[float, float]:
        """Return lateral speed and yaw rate of base_link after `h` s: one implicit step of the linear single track."""
        if vx < _KINEMATIC_MPS:
            return 0.0, vx * wheel / self._car.wheelbase_m
        yaw_v, yaw_r, yaw_w, side_v, side_r, side_w = self._single_track
        g = h / vx
        a, b, c, d = 1.0 - g * side_v, h * vx - g * side_r, -g * yaw_v, 1.0 - g * yaw_r
        p, q = vy + h * side_w * wheel, rate + h * yaw_w * wheel
        determinant = a * d - b * c
        return (p * d - b * q) / determinant, (a * q - c * p) / determinant


class _SingleTrack(NamedTuple):
    """Accelerations of base_link per lateral speed, yaw rate and road-wheel angle; the first two times forward speed.

    What turning the velocity with the car costs, vx per yaw rate, comes on top of `side_r`.
    """

    yaw_v: float
    yaw_r: float
    yaw_w: float
    side_v: float
    side_r: float
    side_w: float


def _single_track(car: CarModel) -> _SingleTrack:
    m, j, lf, lr = car.mass_kg, car.yaw_inertia_kgm2, car.front_m, car.rear_m
    cf, cr = car.front_stiffness_nprad, car.rear_stiffness_nprad
    # front = cf (wheel - (vy + L r) / vx), rear = -cr vy / vx, at base_link as in the tracker's design
    front_r = -cf * car.wheelbase_m
    yaw_v, yaw_r, yaw_w = (lr * cr - lf * cf) / j, lf * front_r / j, lf * cf / j
    return _SingleTrack(
        yaw_v=yaw_v,
        yaw_r=yaw_r,
        yaw_w=yaw_w,
        side_v=-(cf + cr) / m - lr * yaw_v,
        side_r=front_r / m - lr * yaw_r,
        side_w=cf / m - lr * yaw_w,
    )


def _moved(x: float, y: float, yaw: float, forward: float, left: float) -> tuple[float, float]:
    cosine, sine = math.cos(yaw), math.sin(yaw)
    return x + forward * cosine - left * sine, y + forward * sine + left * cosine
