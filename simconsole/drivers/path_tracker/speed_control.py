"""Driving at the planned speed: acceleration from plan and speed; only an emergency brings more jerk than comfort."""

import math
from copy import copy
from typing import Final, NamedTuple

from simconsole.drivers.car_following import Following, following_mps2
from simconsole.drivers.path_tracker.speed_profile import (
    EMERGENCY_JERK_MPS3,
    EMERGENCY_MPS2,
    Stop,
    plan_speed,
    stopping,
)
from simconsole.drivers.path_tracker.tracker_settings import Comfort
from simconsole.values.kernels import approach, clip
from simconsole.world.route import Route
from simconsole.world.rules.speed_advice import DOWN_MPS2

_GAIN_1PS: Final = 1.2
_LEAD_S: Final = 0.15
_JERK_MPS3: Final = 2.8
_CORRECTION_MPS2: Final = 0.4  # more than a stop on the way plans with
_GAP_M: Final = 3.0
_HEADWAY_S: Final = 1.5
_HARDEST_MPS2: Final = 6.0
_ROLLS_MPS: Final = 0.5
"""Faster than this nobody creeps to the place where they stop: who is beyond it has driven past."""
_LOOK_S: Final = 0.05


class Longitudinal(NamedTuple):
    """What is asked for along the path."""

    speed_mps: float
    accel_mps2: float
    jerk_mps3: float


class Leader(NamedTuple):
    """The vehicle ahead."""

    gap_m: float  # bumper to bumper
    speed_mps: float  # along the course


class SpeedControl:
    """Follows the plan of a course; every tracker has one, however it steers."""

    def __init__(self, course: Route, comfort: Comfort, period_s: float) -> None:
        """Plan the speed; `step` is called once in `period_s`."""
        self.profile = plan_speed(course, comfort)
        self.accel_mps2 = 0.0
        """What was asked for last."""
        self.stop: Stop | None = None
        """Where to stop before the course's end, for as long as it is so."""
        self.leader: Leader | None = None
        """Whom to keep behind."""
        self.advised_mps: float | None = None
        """Not to drive faster than this, for a light to come; None: nothing is advised."""
        self._comfort, self._period_s = comfort, period_s
        self._following = Following(
            gap_m=_GAP_M,
            headway_s=_HEADWAY_S,
            accelerate_mps2=comfort.accelerate_mps2,
            brake_mps2=comfort.brake_mps2,
            hardest_mps2=_HARDEST_MPS2,
        )

    def step(self, s_m: float, speed_mps: float) -> Longitudinal:
        """Return what to ask for in the coming period, from place and speed."""
        lead_m = speed_mps * _LEAD_S
        now, ahead = self.profile.at(s_m), self.profile.at(s_m + lead_m)
        if self.stop is not None:
            brake = self.stop.brake_mps2
            rising_s = 0.5 * max(self.accel_mps2 + brake, 0.0) / _jerk_mps3(brake)  # so much later the brake is there
            left_m = self.stop.s_m - s_m - speed_mps * rising_s
            now, ahead = min(now, stopping(left_m, brake)), min(ahead, stopping(left_m - lead_m, brake))
        target, planned = now[0], ahead[1]
        wanted = planned + _GAIN_1PS * (target - speed_mps)
        most, jerk_mps3 = self._comfort.brake_most_mps2, _JERK_MPS3
        if self.stop is not None:
            most = max(most, self.stop.brake_mps2 + _CORRECTION_MPS2)
            if s_m > self.stop.s_m and speed_mps > _ROLLS_MPS:
                wanted = min(wanted, -_at_once_mps2(self.stop.brake_mps2, speed_mps))
            jerk_mps3 = _jerk_mps3(self.stop.brake_mps2)
        wanted = clip(wanted, -most, self._comfort.accelerate_mps2)
        if self.advised_mps is not None and self.advised_mps < target:
            target = self.advised_mps
            wanted = min(wanted, max(_GAIN_1PS * (target - speed_mps), -DOWN_MPS2))
        if self.leader is not None:
            allowed = following_mps2(self.leader.gap_m, self.leader.speed_mps, speed_mps, self._following)
            if allowed < wanted:
                wanted, target = allowed, clip(speed_mps + allowed / _GAIN_1PS, 0.0, target)
                jerk_mps3 = max(jerk_mps3, _jerk_mps3(-wanted))
        before, self.accel_mps2 = self.accel_mps2, approach(self.accel_mps2, wanted, jerk_mps3 * self._period_s)
        return Longitudinal(target, self.accel_mps2, (self.accel_mps2 - before) / self._period_s)

    def ahead(self, s_m: float, speed_mps: float, count: int, every_s: float) -> list[float]:
        """Return `count` places (s_m) of the coming time, `every_s` apart, if car and leader go on as they are to.

        What this remembers does not change.
        """
        other = copy(self)
        other._period_s = _LOOK_S
        found = []
        for _ in range(count):
            for _ in range(round(every_s / _LOOK_S)):
                after_mps = max(0.0, speed_mps + _LOOK_S * other.step(s_m, speed_mps).accel_mps2)
                moved_m = 0.5 * _LOOK_S * (speed_mps + after_mps)
                s_m, speed_mps = s_m + moved_m, after_mps
                if other.leader is not None:
                    gap_m = other.leader.gap_m + _LOOK_S * other.leader.speed_mps - moved_m
                    other.leader = Leader(gap_m, other.leader.speed_mps)
            found.append(s_m)
        return found


def _jerk_mps3(brake_mps2: float) -> float:
    """Return how fast a deceleration may change."""
    return EMERGENCY_JERK_MPS3 if brake_mps2 > EMERGENCY_MPS2 else _JERK_MPS3


def _at_once_mps2(brake_mps2: float, speed_mps: float) -> float:
    """Return the deceleration with which to stop at once: `brake_mps2`, and less as it fades out at the end."""
    return min(brake_mps2, math.sqrt(2.0 * _jerk_mps3(brake_mps2) * speed_mps))
