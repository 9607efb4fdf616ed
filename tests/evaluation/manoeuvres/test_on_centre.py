"""Weave and effort on the spot, on drives whose answer is known."""

from typing import Any

import numpy as np
import pytest

from simconsole.evaluation.manoeuvres.attempt import Driving
from simconsole.evaluation.manoeuvres.on_centre import parking_effort, weave
from simconsole.evaluation.metrics.table import Drive
from simconsole.profiles.manoeuvre import ParkingEffort, Weave
from tests.evaluation.manoeuvres.driven import CAR, HZ, drive


def woven(amplitude_mps2: float) -> Drive:
    """Return a weave with 2 N m per m/s2, 0.6 N m of friction, and a hand wheel 10 ms ahead at 6 deg per m/s2."""
    phase = 2.0 * np.pi * 0.2 * np.arange(25.0 * HZ) / HZ
    lateral = amplitude_mps2 * np.sin(phase)
    torque = 2.0 * lateral + 0.6 * np.where(np.cos(phase) > 0.0, 1.0, -1.0)
    hand = np.radians(6.0) * amplitude_mps2 * np.sin(phase + 2.0 * np.pi * 0.2 * 0.01)
    return drive(25.0, vehicle__ay_mps2=lateral, vehicle__hand_wheel_torque_nm=-torque, driver__hand_wheel_rad=hand)


def end(at_work: Driving, *drives: Drive) -> Any:
    """Return the result after these drives, each with its run-up over at once."""
    attempt = next(at_work)
    for driven in drives[:-1]:
        attempt.pilot.began_tick = 1  # type: ignore[union-attr]
        attempt = at_work.send(driven)
    attempt.pilot.began_tick = 1  # type: ignore[union-attr]
    with pytest.raises(StopIteration) as done:
        at_work.send(drives[-1])
    return done.value.value


def test_a_weave_of_a_known_loop_gives_its_slope_friction_and_width() -> None:
    at_work = weave(Weave(), CAR)
    values = end(at_work, woven(1.3), woven(2.0)).values
    assert values["lateral_acceleration_amplitude_mps2"] == pytest.approx(2.0, rel=1e-3)
    assert values["steering_torque_gradient_at_0_g_nm_per_g"] == pytest.approx(2.0 * 9.80665, rel=1e-3)
    assert values["steering_torque_at_0_g_nm"] == pytest.approx(0.6, rel=1e-3)
    assert values["steering_torque_at_01_g_nm"] == pytest.approx(2.0 * 0.980665 + 0.6, rel=1e-3)
    assert values["lateral_acceleration_at_0_nm_g"] == pytest.approx(0.3 / 9.80665, rel=1e-2)
    assert values["steering_sensitivity_g_per_100_deg"] == pytest.approx(100.0 / (6.0 * 9.80665), rel=1e-2)
    assert values["steering_angle_hysteresis_deg"] == pytest.approx(2.0 * 12.0 * np.sin(0.004 * np.pi), rel=0.03)


def test_the_second_weave_goes_as_far_as_the_first_one_asks_for() -> None:
    at_work = weave(Weave(), CAR)
    attempt = next(at_work)
    attempt.pilot.began_tick = 1  # type: ignore[union-attr]
    assert at_work.send(woven(1.0)).name == "weave, 16 deg"


def test_a_car_that_does_not_get_there_is_told() -> None:
    at_work = weave(Weave(speed_kmh=240.0), CAR)
    next(at_work)
    with pytest.raises(StopIteration) as done:
        at_work.send(woven(1.0))
    assert done.value.value.problem.startswith("weave: the car has not held 240 km/h")


def test_effort_on_the_spot_is_the_largest_torque_and_that_at_the_centre() -> None:
    at_work = parking_effort(ParkingEffort(), CAR)
    next(at_work)
    time_s = np.arange(16.0 * HZ) / HZ
    hand = 2.0 * np.pi * np.sin(time_s * np.pi / 8.0)
    torque = np.where(time_s % 16.0 < 4.0, 4.0, -3.0)
    with pytest.raises(StopIteration) as done:
        at_work.send(drive(16.0, vehicle__hand_wheel_torque_nm=-torque, driver__hand_wheel_rad=hand))
    assert done.value.value.values == {"parking_torque_nm": 4.0, "parking_torque_at_centre_nm": 3.0}
