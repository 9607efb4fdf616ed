"""The engine by itself and in plain Python: its curve, its idle, its limiter."""

import pytest

from simconsole.values.units import RADPS_PER_RPM
from simconsole.vehicle.car.engine import EngineDrive, engine_drive, engine_friction, full_torque, torques_at
from tests.vehicle.parts import CAR


def drive_at(speed_radps: float, running: float, throttle: float, driveline_open: bool) -> EngineDrive:
    can = torques_at(CAR.engine, speed_radps)
    return engine_drive(CAR.engine, can, speed_radps, running, throttle, driveline_open)


def test_full_throttle_torque_goes_through_the_points_of_the_profile() -> None:
    for rpm, torque in [(1000, 95), (2000, 130), (4000, 152), (6000, 133)]:
        assert full_torque(CAR.engine, rpm * RADPS_PER_RPM) == pytest.approx(torque)
    beyond = 6700 * RADPS_PER_RPM
    assert full_torque(CAR.engine, beyond) == -engine_friction(CAR.engine, beyond)


def test_idle_is_an_equilibrium_and_the_dead_engine_needs_an_open_driveline() -> None:
    idle = CAR.engine.idle_radps
    drive = drive_at(idle, 1.0, 0.0, False)
    assert drive.torque_nm == drive.friction_nm
    assert drive_at(0.9 * idle, 1.0, 0.0, False).torque_nm > drive.torque_nm
    assert drive_at(1.1 * idle, 1.0, 0.0, False).torque_nm < drive.friction_nm
    assert drive_at(10.0, 1.0, 1.0, False).running == 0.0
    assert drive_at(10.0, 0.0, 1.0, False).torque_nm == 0.0
    cranked = drive_at(10.0, 0.0, 0.0, True)
    assert cranked.torque_nm > cranked.friction_nm
    assert cranked.running == 0.0
    assert drive_at(CAR.engine.fire_radps, 0.0, 0.0, True).running == 1.0


def test_full_throttle_and_none_are_linear_in_between() -> None:
    for rpm in (900.0, 2500.0, 5000.0):
        speed = rpm * RADPS_PER_RPM
        none, half, full = (drive_at(speed, 1.0, t, False).torque_nm for t in (0.0, 0.5, 1.0))
        assert half == pytest.approx(0.5 * (none + full))
        assert full - engine_friction(CAR.engine, speed) == pytest.approx(full_torque(CAR.engine, speed))
