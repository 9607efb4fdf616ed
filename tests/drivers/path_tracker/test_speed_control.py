"""The acceleration asked for: towards the plan, within comfort, without jerk."""

import numpy as np
import pytest

from simconsole.drivers.path_tracker.speed_control import Leader, SpeedControl
from simconsole.drivers.path_tracker.speed_profile import Stop
from simconsole.drivers.path_tracker.tracker_settings import COMFORT
from simconsole.world.course import Course

PERIOD_S = 0.02


@pytest.mark.parametrize("speed_mps", [0.0, 8.0, 30.0])
def test_acceleration_and_jerk_are_limited_however_wrong_the_speed(course: Course, speed_mps: float) -> None:
    control = SpeedControl(course, COMFORT, PERIOD_S)
    asked = [control.step(30.0 + 0.1 * step, speed_mps) for step in range(200)]
    accel = np.array([0.0, *(one.accel_mps2 for one in asked)])
    assert accel.min() >= -COMFORT.brake_most_mps2
    assert accel.max() <= COMFORT.accelerate_mps2
    assert np.abs(np.diff(accel) / PERIOD_S).max() <= 2.8 + 1e-9
    assert [one.jerk_mps3 for one in asked] == pytest.approx((np.diff(accel) / PERIOD_S).tolist())


def test_at_the_planned_speed_it_asks_for_the_planned_acceleration(course: Course) -> None:
    control = SpeedControl(course, COMFORT, PERIOD_S)
    s_m = 300.0
    for _ in range(200):
        speed, _ = control.profile.at(s_m)
        answer = control.step(s_m, speed)
    assert answer.accel_mps2 == pytest.approx(control.profile.at(s_m + 0.15 * speed)[1])
    assert answer.speed_mps == speed


def test_behind_a_vehicle_it_slows_down_with_comfort_and_stops_before_it(course: Course) -> None:
    control = SpeedControl(course, COMFORT, PERIOD_S)
    s_m, speed_mps, rear_m, accel = 300.0, 10.0, 400.0, []
    for _ in range(3000):
        control.leader = Leader(rear_m - s_m, 0.0)
        answer = control.step(s_m, speed_mps)
        accel.append(answer.accel_mps2)
        speed_mps = max(0.0, speed_mps + answer.accel_mps2 * PERIOD_S)
        s_m += speed_mps * PERIOD_S
    assert speed_mps < 0.01
    assert 2.5 < rear_m - s_m < 4.5
    assert min(accel) >= -2.5
    assert np.abs(np.diff(accel) / PERIOD_S).max() <= 2.8 + 1e-9


def test_a_vehicle_that_is_suddenly_near_is_braked_for_at_once_and_a_gone_one_forgotten(course: Course) -> None:
    control = SpeedControl(course, COMFORT, PERIOD_S)
    control.leader = Leader(6.0, 0.0)
    hard = [control.step(300.0, 10.0).accel_mps2 for _ in range(25)]
    assert hard[-1] == -6.0
    control.leader = None
    assert [control.step(300.0, 10.0).accel_mps2 for _ in range(400)][-1] > -0.5


@pytest.mark.parametrize(
    ("past_m", "speed_mps", "beyond_m"), [(0.2, 2.4, 1.0), (-2.0, 3.3, 0.0), (-12.0, 10.0, 0.0), (-20.0, 10.0, 0.0)]
)
def test_a_stop_that_takes_an_emergency_is_made_in_time_and_one_driven_past_at_once(
    course: Course, past_m: float, speed_mps: float, beyond_m: float
) -> None:
    control = SpeedControl(course, COMFORT, PERIOD_S)
    control.stop = Stop(300.0, 6.0)
    s_m = 300.0 + past_m
    while speed_mps > 0.0:
        speed_mps = max(0.0, speed_mps + control.step(s_m, speed_mps).accel_mps2 * PERIOD_S)
        s_m += speed_mps * PERIOD_S
    assert -1.0 < s_m - 300.0 < beyond_m
    assert control.step(s_m, 0.0).accel_mps2 < 0.0, "it stays"
