"""Pure pursuit and Stanley in plain form."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from simconsole.drivers.path_tracker.geometric import GeometricTracker, Law, pure_pursuit, stanley
from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.drivers.path_tracker.tracker_settings import HATCHBACK
from simconsole.world.course import Course

WHEELBASE_M = HATCHBACK.wheelbase_m


@pytest.mark.parametrize("law", [pure_pursuit, stanley])
def test_both_follow_the_course(course: Course, laps: Callable[..., Any], nominal: Any, law: Law) -> None:
    trace = laps(GeometricTracker(law, course, HATCHBACK), nominal, 700.0)
    assert trace.s_m[-1] > 700.0
    assert np.abs(trace.lateral_m).max() < 0.6


@pytest.mark.parametrize("law", [pure_pursuit, stanley])
@pytest.mark.parametrize("aside_m", [0.5, -0.5])
def test_both_steer_back_to_a_straight(course: Course, law: Law, aside_m: float) -> None:
    tracker = GeometricTracker(law, course, HATCHBACK)
    answer = tracker.step(VehicleMotion(30.0, aside_m, 0.0, 8.0, 0.0, 0.0))
    assert answer.road_wheel_rad * aside_m < 0.0
    assert tracker.lateral_m == pytest.approx(aside_m)


def test_pure_pursuit_drives_the_arc_to_its_goal(course: Course) -> None:
    """On a straight, beside it: the goal is `ahead` further on, and the circle through both is tangent to the car."""
    seen = VehicleMotion(30.0, 0.4, 0.0, 10.0, 0.0, 0.0)
    angle = pure_pursuit(course, course.project(30.0, 0.4, 30.0, 0.0), seen, WHEELBASE_M)
    radius = (6.0**2 + 0.4**2) / (2.0 * 0.4)
    assert math.tan(angle) == pytest.approx(-WHEELBASE_M / radius)


def test_stanley_turns_the_front_wheels_along_the_path(course: Course) -> None:
    seen = VehicleMotion(30.0, 0.0, 0.1, 10.0, 0.0, 0.0)
    angle = stanley(course, course.project(30.0, 0.0, 30.0, 0.1), seen, WHEELBASE_M)
    assert angle == pytest.approx(-0.1 - math.atan(1.5 * WHEELBASE_M * math.sin(0.1) / 11.0), abs=1e-6)


def test_the_angle_is_limited_and_nothing_is_asked_along_the_way_while_a_person_drives(course: Course) -> None:
    tracker = GeometricTracker(stanley, course, HATCHBACK)
    for _ in range(50):
        answer = tracker.step(VehicleMotion(30.0, 2.0, 1.5, 1.0, 0.0, 0.0), engaged=False)
        assert answer.road_wheel_rad == -HATCHBACK.max_road_wheel_rad
        assert answer.accel_mps2 <= 0.06
