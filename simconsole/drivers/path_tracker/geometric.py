"""Pure pursuit and Stanley in plain form: steering by geometry alone, for comparison with `tracker`.

Both take the odometry as it comes: they know nothing of noise, delay, tyres or the console's gate. They drive at the
same planned speed as `tracker`.
"""

import math
from collections.abc import Callable
from typing import Final

from simconsole.drivers.path_tracker.speed_control import SpeedControl
from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.drivers.path_tracker.tracker import TrackerCommand
from simconsole.drivers.path_tracker.tracker_settings import COMFORT, GATE, TIMING, CarModel, Gate, planned_within
from simconsole.values.kernels import clip
from simconsole.world.route import Projection, Route

AHEAD_S: Final = 0.6
LEAST_AHEAD_M: Final = 4.0
GAIN_1PS: Final = 1.5
SOFT_MPS: Final = 1.0

Law = Callable[[Route, Projection, VehicleMotion, float], float]
"""Takes the course, where base_link is beside it, the motion and the wheelbase in m; returns the road-wheel angle."""


def pure_pursuit(course: Route, place: Projection, seen: VehicleMotion, wheelbase_m: float) -> float:
    """Return the road-wheel angle (rad) of the arc to the point of the path that is 0.6 s, at least 4 m, ahead.

    Coulter, Implementation of the Pure Pursuit Path Tracking Algorithm, CMU-RI-TR-92-01.
    """
    goal = course.at(place.s_m + max(LEAST_AHEAD_M, AHEAD_S * seen.vx_mps))
    dx, dy = goal.x_m - seen.x_m, goal.y_m - seen.y_m
    aside_m = dy * math.cos(seen.yaw_rad) - dx * math.sin(seen.yaw_rad)
    return math.atan(2.0 * wheelbase_m * aside_m / (dx * dx + dy * dy))


def stanley(course: Route, place: Projection, seen: VehicleMotion, wheelbase_m: float) -> float:
    """Return the road-wheel angle (rad) that turns the front wheels along the path, and towards it.

    Thrun et al., Stanley: The Robot that Won the DARPA Grand Challenge, J. Field Robotics 23(9), 2006.
    """
    x_m = seen.x_m + wheelbase_m * math.cos(seen.yaw_rad)
    y_m = seen.y_m + wheelbase_m * math.sin(seen.yaw_rad)
    front = course.project(x_m, y_m, place.s_m + wheelbase_m, seen.yaw_rad)
    return -front.heading_error_rad - math.atan(GAIN_1PS * front.lateral_m / (SOFT_MPS + max(seen.vx_mps, 0.0)))


class GeometricTracker:
    """Follows a course by a law of geometry; the same interface as `Tracker`."""

    def __init__(self, law: Law, course: Route, car: CarModel, gate: Gate = GATE) -> None:
        """Steer a car by `law` along `course`, at a speed for `gate`."""
        self.course = course
        self.s_m: float | None = None
        self.lateral_m = 0.0
        self.heading_error_rad = 0.0
        self._law, self._car = law, car
        self.along = SpeedControl(course, planned_within(COMFORT, gate), TIMING.period_s)
        self._before_rad = 0.0

    @property
    def acts_after_s(self) -> float:
        """How long after what was seen last the car is at `s_m`: not at all, for delays are not known here."""
        return 0.0

    def offset_at(self, s_m: float) -> tuple[float, float]:
        """Return (0, 0): the course itself is tracked."""
        return 0.0, 0.0

    def step(self, seen: VehicleMotion, engaged: bool = True, time_s: float | None = None) -> TrackerCommand:
        """Return the command for the coming period; `time_s` is not used."""
        place = self.course.project(seen.x_m, seen.y_m, self.s_m, seen.yaw_rad)
        self.s_m, self.lateral_m, self.heading_error_rad = place
        if not engaged:
            self.along.accel_mps2 = 0.0
        most_rad = self._car.max_road_wheel_rad
        road_wheel_rad = clip(self._law(self.course, place, seen, self._car.wheelbase_m), -most_rad, most_rad)
        turned_radps, self._before_rad = (road_wheel_rad - self._before_rad) / TIMING.period_s, road_wheel_rad
        return TrackerCommand(road_wheel_rad, turned_radps, *self.along.step(place.s_m, seen.vx_mps))
