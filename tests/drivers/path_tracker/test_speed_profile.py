import numpy as np
import pytest

from simconsole.drivers.path_tracker.speed_profile import plan_speed
from simconsole.drivers.path_tracker.tracker_settings import COMFORT
from simconsole.world.course import Course


def test_profile_keeps_every_limit(course: Course) -> None:
    profile = plan_speed(course, COMFORT)
    curvature = np.array([course.curvature_at((i + 0.5) * profile.step_m) for i in range(len(profile.speed_mps))])
    assert profile.speed_mps.max() <= course.speed_limit_mps
    assert profile.speed_mps.min() > 3.0
    assert (profile.speed_mps**2 * np.abs(curvature)).max() <= 1.05 * COMFORT.lateral_mps2
    assert profile.accel_mps2.max() <= 1.02 * COMFORT.accelerate_mps2
    assert profile.accel_mps2.min() >= -1.02 * COMFORT.brake_mps2
    jerk = np.gradient(profile.accel_mps2, profile.step_m) * profile.speed_mps
    assert np.abs(jerk).max() <= 4.0


def test_profile_is_fast_enough_and_closed(course: Course) -> None:
    profile = plan_speed(course, COMFORT)
    assert course.length_m / profile.lap_s > 35.0 / 3.6
    assert profile.at(course.length_m + 100.0) == pytest.approx(profile.at(100.0))
    assert abs(profile.speed_mps[0] - profile.speed_mps[-1]) < 0.1


def test_lower_top_speed_is_kept(course: Course) -> None:
    assert plan_speed(course, COMFORT, top_mps=6.0).speed_mps.max() <= 6.0 - COMFORT.margin_mps + 1e-9


def test_between_two_points_it_is_linear(course: Course) -> None:
    profile = plan_speed(course, COMFORT)
    i = 1250
    middle = profile.at((i + 0.5) * profile.step_m)
    assert middle[0] == pytest.approx((profile.speed_mps[i] + profile.speed_mps[i + 1]) / 2)
    assert middle[1] == pytest.approx((profile.accel_mps2[i] + profile.accel_mps2[i + 1]) / 2)
