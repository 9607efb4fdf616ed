"""Driving at the planned speed: acceleration from plan and speed, never with more jerk than is comfortable."""

from typing import Final, NamedTuple

from simconsole.drivers.path_tracker.speed_profile import plan_speed
from simconsole.drivers.path_tracker.tracker_settings import Comfort
from simconsole.values.kernels import approach, clip
from simconsole.world.route import Route

_GAIN_1PS: Final = 1.2
_LEAD_S: Final = 0.15
_JERK_MPS3: Final = 2.8


class Longitudinal(NamedTuple):
    """What is asked for along the path."""

    speed_mps: float
    accel_mps2: float
    jerk_mps3: float


class SpeedControl:
    """Follows the plan of a course; every tracker has one, however it steers."""

    def __init__(self, course: Route, comfort: Comfort, period_s: float) -> None:
        """Plan the speed; `step` is called once in `period_s`."""
        self.profile = plan_speed(course, comfort)
        self.accel_mps2 = 0.0
        """What was asked for last."""
        self._comfort, self._period_s = comfort, period_s

    def step(self, s_m: float, speed_mps: float) -> Longitudinal:
        """Return what to ask for in the coming period, from place and speed."""
        target, _ = self.profile.at(s_m)
        _, planned = self.profile.at(s_m + speed_mps * _LEAD_S)
        wanted = planned + _GAIN_1PS * (target - speed_mps)
        wanted = clip(wanted, -self._comfort.brake_most_mps2, self._comfort.accelerate_mps2)
        before, self.accel_mps2 = self.accel_mps2, approach(self.accel_mps2, wanted, _JERK_MPS3 * self._period_s)
        return Longitudinal(target, self.accel_mps2, (self.accel_mps2 - before) / self._period_s)
