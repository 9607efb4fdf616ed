import math

import pytest

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.longitudinal import Pedals, brake_for, finite_or, integrate, pedals_for
from simconsole.values.signals import VehicleState

STATE = VehicleState(*(0.0,) * len(VehicleState._fields))


def vehicle(coast: float = -0.3, throttle: float = 3.0, brake: float = -9.0) -> VehicleState:
    return STATE._replace(coast_accel_mps2=coast, full_throttle_accel_mps2=throttle, full_brake_accel_mps2=brake)


@pytest.mark.parametrize("wanted", [-8.0, -2.5, -0.41, -0.2, 0.0, 1.0, 3.0])
def test_pedals_invert_what_the_vehicle_states(wanted: float, control: ControlSettings) -> None:
    pedals = pedals_for(wanted, 1.0, vehicle(), control)
    accel = -0.3 + pedals.throttle * 3.3 - pedals.brake * 8.7
    assert math.isclose(accel, wanted, abs_tol=1e-12)
    assert pedals.throttle == 0.0 or pedals.brake == 0.0


def test_beyond_full_pedals_they_are_full(control: ControlSettings) -> None:
    assert pedals_for(20.0, 1.0, vehicle(), control) == Pedals(1.0, 0.0)
    assert pedals_for(-20.0, 1.0, vehicle(), control) == Pedals(0.0, 1.0)


def test_near_coasting_both_are_released(control: ControlSettings) -> None:
    assert pedals_for(-0.35, 1.0, vehicle(), control) == Pedals(0.0, 0.0)
    assert pedals_for(-0.3, 1.0, vehicle(), control) == Pedals(0.0, 0.0)


def test_in_reverse_the_body_accelerations_turn_round(control: ControlSettings) -> None:
    backward = vehicle(coast=0.3, throttle=-3.0, brake=9.0)
    assert pedals_for(1.0, -1.0, backward, control) == pedals_for(1.0, 1.0, vehicle(), control)
    assert pedals_for(-3.0, -1.0, backward, control) == pedals_for(-3.0, 1.0, vehicle(), control)


@pytest.mark.parametrize("bad", [-0.3, -5.0, -0.2, math.nan, math.inf, -math.inf, 1e308])
def test_without_a_usable_statement_the_nominal_throttle_serves(bad: float, control: ControlSettings) -> None:
    assert pedals_for(1.2, 1.0, vehicle(throttle=bad), control).throttle == 1.5 / 3.0


@pytest.mark.parametrize("bad", [-0.3, 5.0, -0.4, math.nan, math.inf, -math.inf, -1e308])
def test_without_a_usable_statement_the_nominal_brake_serves(bad: float, control: ControlSettings) -> None:
    assert math.isclose(pedals_for(-4.3, 1.0, vehicle(brake=bad), control).brake, 4.0 / 8.0)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e308, -1e308])
def test_nonsense_everywhere_still_gives_pedals(bad: float, control: ControlSettings) -> None:
    for wanted in (-4.0, 0.0, 4.0):
        pedals = pedals_for(wanted, 1.0, vehicle(bad, bad, bad), control)
        assert 0.0 <= pedals.throttle <= 1.0
        assert 0.0 <= pedals.brake <= 1.0


def test_the_integral_is_bounded(control: ControlSettings) -> None:
    integral = 0.0
    for _ in range(10_000):
        integral = integrate(integral, 1e300, control, 0.004)
    assert integral == control.integral_max_mps2
    one = integrate(0.0, -1.0, control, 0.004)
    assert math.isclose(one, -control.integral_gain_per_s * 0.004)
    for _ in range(10_000):
        integral = integrate(integral, -3.0, control, 0.004)
    assert integral == -control.integral_max_mps2


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_coasting_that_is_no_number_counts_as_none(bad: float, control: ControlSettings) -> None:
    assert pedals_for(1.0, 1.0, vehicle(coast=bad), control).throttle == pytest.approx(1.0 / 3.0)
    assert brake_for(-4.5, 1.0, vehicle(coast=bad), control) == pytest.approx(0.5)


def test_the_least_and_the_greatest_statement_that_is_usable(control: ControlSettings) -> None:
    assert pedals_for(0.1, 1.0, vehicle(coast=0.0, throttle=0.2), control).throttle == 0.5
    assert pedals_for(25.0, 1.0, vehicle(coast=0.0, throttle=50.0), control).throttle == 0.5
    assert brake_for(-0.1, 1.0, vehicle(coast=0.0, brake=-0.2), control) == 0.5
    assert brake_for(-25.0, 1.0, vehicle(coast=0.0, brake=-50.0), control) == 0.5


def test_the_coasting_band_ends_where_braking_begins(control: ControlSettings) -> None:
    edge = -0.5 - control.coast_band_mps2
    assert pedals_for(edge, 1.0, vehicle(coast=-0.5), control).brake == pytest.approx(0.1 / 8.5)
    assert pedals_for(edge + 1e-9, 1.0, vehicle(coast=-0.5), control) == Pedals(0.0, 0.0)


def test_known_replaces_only_what_is_not_finite() -> None:
    assert [finite_or(value, 7.0) for value in (1.5, math.nan, math.inf, -math.inf)] == [1.5, 7.0, 7.0, 7.0]
