import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.drivers.path_tracker.tracker import Tracker
from simconsole.drivers.path_tracker.tracker_settings import COMFORT, HATCHBACK
from simconsole.profiles.course_plan import CoursePlan, Curve, Straight
from simconsole.world.course import Course
from simconsole.world.planning import solve

Drive = Callable[..., Any]


def rms(values: np.ndarray) -> float:
    return math.sqrt(float(np.mean(values * values)))


def test_lap_from_standstill_to_well_within_the_bars(course: Course, laps: Drive, nominal: Any) -> None:
    trace = laps(Tracker(course), nominal, 2610.0)
    assert trace.s_m[-1] > 2610.0
    assert rms(trace.lateral_m) < 0.005
    assert np.abs(trace.lateral_m).max() < 0.02
    assert trace.s_m[-1] / trace.time_s[-1] > 35.0 / 3.6
    assert trace.speed_mps.max() < 50.0 / 3.6
    assert np.abs(trace.lateral_mps2).max() < 1.2 * COMFORT.lateral_mps2
    assert np.abs(np.diff(trace.accel_mps2) / 0.02).max() < 5.0


@pytest.mark.parametrize(
    "changes",
    [
        {"delay_ms": 4, "steering_lag_s": 0.03},
        {"delay_ms": 40, "steering_lag_s": 0.06},
        {"friction": 0.5},
        {"car": HATCHBACK._replace(mass_kg=1600.0, yaw_inertia_kgm2=2500.0)},
        {"car": HATCHBACK._replace(front_stiffness_nprad=85_000.0, rear_stiffness_nprad=95_000.0)},
    ],
    ids=["quick", "slow", "wet", "heavy", "soft"],
)
def test_corner_and_roundabout_with_another_car_than_the_model(
    course: Course, laps: Drive, nominal: Any, changes: dict[str, Any]
) -> None:
    tracker = Tracker(course)
    start = course.at(560.0)
    trace = laps(
        tracker,
        nominal._replace(**changes),
        1200.0,
        VehicleMotion(start.x_m, start.y_m, start.yaw_rad, 7.0, 0.0, 0.0),
    )
    assert trace.s_m[-1] > 1200.0
    assert rms(trace.lateral_m) < 0.02
    assert np.abs(trace.lateral_m).max() < 0.08


@pytest.mark.parametrize(("offset_m", "speed_mps"), [(0.4, 10.0), (-1.5, 8.0), (1.0, 13.0)])
def test_offset_at_engagement_is_led_back_without_overshoot(
    course: Course, laps: Drive, nominal: Any, offset_m: float, speed_mps: float
) -> None:
    trace = laps(Tracker(course), nominal, 180.0, VehicleMotion(50.0, offset_m, 0.0, speed_mps, 0.0, 0.0))
    assert abs(trace.lateral_m[-1]) < 0.001
    assert (trace.lateral_m * math.copysign(1.0, offset_m)).min() > -0.02
    assert np.abs(trace.lateral_m).max() < abs(offset_m) + 0.01
    assert np.abs(trace.lateral_mps2).max() < 2.5


def test_command_stays_ready_while_a_person_drives(course: Course) -> None:
    tracker = Tracker(course)
    for step in range(200):  # the person drives beside the path, which must not wind anything up
        answer = tracker.step(VehicleMotion(0.2 * step, 0.5, 0.0, 10.0, 0.0, 0.0), engaged=False)
        assert abs(answer.road_wheel_rad) < 0.03
        assert -0.1 <= answer.accel_mps2 <= 0.1
    first = tracker.step(VehicleMotion(40.0, 0.5, 0.0, 10.0, 0.0, 0.0), engaged=True)
    assert abs(first.road_wheel_rad - answer.road_wheel_rad) < 0.01


def test_engagement_in_a_bend_begins_with_the_bends_angle(course: Course) -> None:
    tracker = Tracker(course)
    arc = course.world.path[2]
    point = course.at(arc.s_m + 12.0)
    car, speed = HATCHBACK, 8.0
    push_mps2 = speed * speed * point.curvature_1pm
    slip_rad = -push_mps2 * car.mass_kg * car.front_m / car.wheelbase_m / car.rear_stiffness_nprad
    steady = VehicleMotion(
        *(point.x_m, point.y_m, point.yaw_rad - slip_rad),
        *(speed, speed * slip_rad, speed * point.curvature_1pm),
    )
    needed = car.wheelbase_m * point.curvature_1pm + car.understeer_radps2pm * push_mps2
    assert tracker.step(steady, engaged=False).road_wheel_rad == pytest.approx(needed, rel=0.02)


def test_command_is_limited_however_wrong_the_pose(course: Course) -> None:
    tracker = Tracker(course)
    before = 0.0
    for _ in range(200):
        answer = tracker.step(VehicleMotion(30.0, 8.0, 2.0, 14.0, 0.0, 0.0))
        assert abs(answer.road_wheel_rad) <= HATCHBACK.max_road_wheel_rad + 1e-12
        assert abs(math.tan(answer.road_wheel_rad) - math.tan(before)) <= 0.8 * 0.02 + 1e-12
        assert abs(math.tan(answer.road_wheel_rad)) * 14.0**2 / HATCHBACK.wheelbase_m <= 4.52
        before = answer.road_wheel_rad
    assert math.tan(before) * 14.0**2 / HATCHBACK.wheelbase_m == pytest.approx(-4.5, rel=0.01)


def test_standing_car_is_asked_to_drive_off(course: Course) -> None:
    tracker = Tracker(course)
    answer = tracker.step(VehicleMotion(10.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert 0.0 < answer.accel_mps2 <= COMFORT.accelerate_mps2
    assert answer.speed_mps > 10.0


def test_two_trackers_answer_equally(course: Course, laps: Drive, nominal: Any) -> None:
    first = laps(Tracker(course), nominal, 60.0)
    second = laps(Tracker(course), nominal, 60.0)
    assert all(np.array_equal(a, b) for a, b in zip(first, second, strict=True))


def test_the_end_of_an_open_course_is_no_bend(laps: Drive, nominal: Any) -> None:
    """A course that ends within a curve: beyond its end the way is straight, and the car stops there."""
    elements = (Straight(length_m=60.0), Curve(radius_m=20.0, angle_deg=60.0, ramp_m=5.0), Straight(length_m=0.5))
    plan = CoursePlan(schema=1, title="t", lane_width_m=3.5, speed_limit_kmh=40.0, elements=elements)
    course = Course(solve(plan, "t"))
    trace = laps(Tracker(course), nominal, 1000.0, VehicleMotion(0.0, 0.0, 0.0, 5.0, 0.0, 0.0), 40.0)
    assert trace.s_m[-1] == pytest.approx(course.length_m, abs=0.3)
    assert trace.speed_mps[-1] < 0.05
    assert np.abs(trace.lateral_m).max() < 0.03
