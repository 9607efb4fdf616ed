import numpy as np
import pytest

from simconsole.drivers.path_tracker.speed_profile import plan_speed, stopping
from simconsole.drivers.path_tracker.tracker_settings import COMFORT
from simconsole.profiles.course_plan import CoursePlan, Curve, Straight
from simconsole.world.course import Course
from simconsole.world.planning import solve
from simconsole.world.roads.lane_graph import LaneGraph
from simconsole.world.roads.road_route import route_over
from tests.world.nets import straight_map


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


def open_course(*more: Straight | Curve) -> Course:
    elements = (Straight(length_m=150.0), *more)
    plan = CoursePlan(schema=1, title="t", lane_width_m=3.5, speed_limit_kmh=50.0, elements=elements)
    return Course(solve(plan, "t"))


def test_an_open_course_ends_with_a_stop() -> None:
    profile = plan_speed(open_course(), COMFORT)
    assert profile.at(150.0) == (0.0, pytest.approx(-0.24))
    assert profile.at(151.0)[0] == 0.0
    assert profile.at(0.0)[0] == pytest.approx(50.0 / 3.6 - COMFORT.margin_mps)
    assert profile.at(-5.0)[0] == pytest.approx(profile.at(0.0)[0])
    places = np.linspace(0.0, 149.5, 3000)
    speed, accel = np.array([profile.at(s) for s in places.tolist()]).T
    assert np.all(np.diff(speed) <= 1e-9)
    assert accel.min() >= -COMFORT.brake_most_mps2
    assert accel.max() <= 1e-9


def test_what_lies_at_the_end_of_an_open_course_does_not_slow_its_start() -> None:
    bend = (Curve(radius_m=12.0, angle_deg=90.0, ramp_m=6.0), Straight(length_m=1.0))
    profile = plan_speed(open_course(*bend), COMFORT)
    assert profile.speed_mps[0] == pytest.approx(50.0 / 3.6 - COMFORT.margin_mps)


def test_stopping_is_one_motion() -> None:
    """Driven as it says, from 5 m before the end, the car is at rest there, and its speed is what it says."""
    left, (speed, _) = 5.0, stopping(5.0)
    for _ in range(100_000):
        accel = stopping(left)[1]
        if speed <= 0.02:
            break
        left, speed = left - 1e-4 * speed, speed + 1e-4 * accel
        assert speed == pytest.approx(stopping(left)[0], abs=0.02)
    assert left == pytest.approx(0.0, abs=0.01)


def test_open_route_ends_with_a_stop_and_keeps_each_limit() -> None:
    road_map = straight_map()
    route = route_over(road_map, LaneGraph(road_map).drawn(1, 180.0))
    profile = plan_speed(route, COMFORT)
    assert profile.at(route.length_m)[0] == profile.at(route.length_m + 5.0)[0] == 0.0
    places = np.arange(len(profile.speed_mps), dtype=np.float64) * profile.step_m
    assert (profile.speed_mps <= route.limits_at(places)).all()
    assert float(profile.speed_mps[0]) > 10.0
