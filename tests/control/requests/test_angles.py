import math

import pytest

from simconsole.control.requests.angles import limited_angle, limited_step
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.values.signals import VehicleState

STANDING = VehicleState(*(0.0,) * len(VehicleState._fields))


def at(speed_mps: float) -> VehicleState:
    return STANDING._replace(vx_mps=speed_mps)


@pytest.mark.parametrize("speed", [-20.0, 20.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_angle_gives_the_lateral_acceleration_of_the_limit(
    speed: float, side: float, control: ControlSettings
) -> None:
    angle = limited_angle(side, 4.0, at(speed), control)
    assert speed**2 * math.tan(angle) / control.wheelbase_m == pytest.approx(side * 4.0)
    assert limited_angle(0.02, 4.0, at(speed), control) == 0.02


def test_an_angle_is_free_without_limit_or_speed(control: ControlSettings) -> None:
    assert limited_angle(0.5, 0.0, at(30.0), control) == 0.5
    assert limited_angle(0.5, 0.001, at(control.standstill_speed_mps), control) == 0.5
    assert limited_angle(0.5, 0.001, at(control.standstill_speed_mps * 1.01), control) < 0.5
    assert limited_angle(0.5, 0.1, at(math.nan), control) == 0.5
    assert limited_angle(1.0, 5.0, at(math.inf), control) == 1.0


def test_beyond_100_mps_limits_fall_no_further(control: ControlSettings) -> None:
    assert limited_angle(0.5, 5.0, at(1e300), control) == limited_angle(0.5, 5.0, at(100.0), control)
    assert limited_step(0.0, 1.0, 7.0, at(-1e300), control, 0.004) == limited_step(
        0.0, 1.0, 7.0, at(100.0), control, 0.004
    )


@pytest.mark.parametrize("speed", [-20.0, 20.0])
@pytest.mark.parametrize("angle", [-0.4, 0.0, 0.4])
def test_a_step_gives_the_lateral_jerk_of_the_limit(speed: float, angle: float, control: ControlSettings) -> None:
    tick_s = 1e-6
    step = limited_step(angle, 1.0, 7.0, at(speed), control, tick_s)
    turned = math.tan(angle + step) - math.tan(angle)
    assert speed**2 / control.wheelbase_m * turned / tick_s == pytest.approx(7.0, rel=1e-5)


def test_a_step_is_never_longer_than_the_rate_allows(control: ControlSettings) -> None:
    assert limited_step(0.0, 0.002, 7.0, at(1.0), control, 0.004) == 0.002
    assert limited_step(0.0, 0.002, 0.0, at(30.0), control, 0.004) == 0.002
    assert limited_step(0.0, 1.0, 0.001, at(control.standstill_speed_mps), control, 0.004) == 1.0
    assert limited_step(0.0, 1.0, 0.001, at(control.standstill_speed_mps * 1.01), control, 0.004) < 1.0
    assert limited_step(0.0, 1.0, 0.001, at(math.nan), control, 0.004) == 1.0
