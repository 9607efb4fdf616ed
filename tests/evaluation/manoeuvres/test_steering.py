"""Steady-state circle and step steer, on drives whose answer is known."""

from typing import Any

import numpy as np
import pytest

from simconsole.evaluation.manoeuvres.attempt import Driving
from simconsole.evaluation.manoeuvres.steering import steady_circle, step_steer
from simconsole.evaluation.metrics.table import Drive
from simconsole.profiles.manoeuvre import SteadyCircle, StepSteer
from tests.evaluation.manoeuvres.driven import CAR, HZ, drive


def evaluated(at_work: Driving, driven: Drive, began_tick: int | None = 1) -> Any:
    """Return the result of a manoeuvre whose run-up ended at this tick."""
    attempt = next(at_work)
    assert attempt.pilot is not None
    attempt.pilot.began_tick = began_tick  # type: ignore[attr-defined]  # as if the run-up were over
    with pytest.raises(StopIteration) as end:
        at_work.send(driven)
    return end.value.value


def circled(seconds: float = 20.0) -> Drive:
    """Return a drive whose lateral acceleration grows by 0.4 m/s2 a second, hand wheel and all else in proportion."""
    lateral = 0.4 * np.arange(seconds * HZ) / HZ
    return drive(
        seconds,
        vehicle__vx_mps=np.array(20.0),
        vehicle__ay_mps2=lateral,
        driver__hand_wheel_rad=np.radians(9.0) * lateral,
        platform__vx_mps=np.array(20.0),
        platform__vy_mps=-20.0 * np.tan(np.radians(0.5) * lateral),
        vehicle__roll_rad=np.radians(0.3) * lateral,
        vehicle__hand_wheel_torque_nm=-np.where(lateral < 6.0, lateral, 12.0 - lateral),
    )


def test_gradients_of_a_linear_car_are_its_slopes() -> None:
    found = evaluated(steady_circle(SteadyCircle(speed_kmh=72.0), CAR), circled()).values
    assert found["steering_wheel_angle_gradient_deg_per_mps2"] == pytest.approx(9.0)
    ackermann = np.degrees(CAR.wheelbase_m / 20.0**2)
    assert found["understeer_gradient_deg_per_mps2"] == pytest.approx(9.0 / CAR.steering_ratio - ackermann)
    assert found["sideslip_angle_gradient_deg_per_mps2"] == pytest.approx(-0.5)
    assert found["roll_angle_gradient_deg_per_mps2"] == pytest.approx(0.3)
    assert found["steering_wheel_torque_gradient_nm_per_mps2"] == pytest.approx(1.0)
    assert found["highest_lateral_acceleration_mps2"] == pytest.approx(8.0, abs=0.1)
    assert found["share_of_grip_at_highest_torque"] == pytest.approx(6.0 / 8.0, abs=0.01)


def test_a_step_is_timed_from_its_half() -> None:
    time_s = np.arange(4.0 * HZ) / HZ
    hand = 0.5 * np.clip((time_s - 0.5) / 0.1, 0.0, 1.0)  # half of it at 0.55 s
    grown = np.clip((time_s - 0.6) / 0.2, 0.0, 1.0)  # nine tenths at 0.78 s
    yaw_rate = 0.2 * grown + np.where((time_s > 0.8) & (time_s < 1.2), 0.05 * np.sin((time_s - 0.8) * np.pi / 0.4), 0.0)
    stepped = drive(4.0, vehicle__yaw_rate_radps=yaw_rate, vehicle__ay_mps2=4.0 * grown, driver__hand_wheel_rad=hand)
    found = evaluated(step_steer(StepSteer(), CAR), stepped).values
    assert found["steady_state_lateral_acceleration_mps2"] == pytest.approx(4.0)
    assert found["steady_state_yaw_rate_gain_per_s"] == pytest.approx(0.4)
    assert found["yaw_rate_response_time_s"] == pytest.approx(0.23)
    assert found["lateral_acceleration_response_time_s"] == pytest.approx(0.23)
    assert found["yaw_rate_peak_response_time_s"] == pytest.approx(1.0 - 0.55, abs=0.003)
    assert found["yaw_rate_overshoot_percent"] == pytest.approx(25.0, abs=0.1)


@pytest.mark.parametrize(
    ("at_work", "told"),
    [
        (steady_circle(SteadyCircle(speed_kmh=240.0), CAR), "steady-state circle: the car has not held 240 km/h"),
        (step_steer(StepSteer(speed_kmh=250.0), CAR), "step steer: the car has not held 250 km/h"),
    ],
)
def test_a_car_that_does_not_get_there_is_told(at_work: Driving, told: str) -> None:
    result = evaluated(at_work, drive(1.0, vehicle__vx_mps=np.array(9.0)), None)
    assert result.values == {}
    assert result.problem.startswith(told)
