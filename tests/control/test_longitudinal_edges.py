"""Stops and speed commands at their edges: signs, thresholds and what the integral does."""

import math

import pytest

from simconsole.control.modes.takeover import WheelWatch, steering_taken, throttle_overrides, watch_wheel
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.remote import commanded_direction, remote_request, twist_road_wheel
from simconsole.control.requests.stops import safe_stop, stands, stop_start, travel_direction
from simconsole.control.shared import time_to_crossing
from simconsole.values.signals import NO_COMMAND, RemoteCommand, RemoteKind, VehicleState

TICK_S = 0.004
CAR = VehicleState(*(0.0,) * len(VehicleState._fields))._replace(
    coast_accel_mps2=-0.3, full_throttle_accel_mps2=3.0, full_brake_accel_mps2=-9.0
)
BACK = CAR._replace(coast_accel_mps2=0.3, full_throttle_accel_mps2=-3.0, full_brake_accel_mps2=9.0)


def at(speed_mps: float, car: VehicleState = CAR, **fields: float) -> VehicleState:
    return car._replace(vx_mps=speed_mps, **fields)


def test_slow_in_every_direction_up_to_the_limit_itself(control: ControlSettings) -> None:
    limit = control.standstill_speed_mps
    assert stands(at(limit), control)
    assert stands(at(-limit), control)
    assert not stands(at(limit * 1.001), control)
    assert not stands(at(0.8 * limit, vy_mps=0.8 * limit), control)
    assert not stands(at(0.0, vy_mps=-1.01 * limit), control)
    assert not stands(at(math.nan), control)
    assert [travel_direction(at(speed)) for speed in (-0.1, 0.0, 0.1)] == [-1.0, 1.0, 1.0]


def test_a_stop_begins_with_the_deceleration_there_is(control: ControlSettings) -> None:
    assert stop_start(at(9.0, ax_mps2=-1.5), control) == -1.5
    assert stop_start(at(-9.0, ax_mps2=1.5), control) == -1.5
    assert stop_start(at(9.0, ax_mps2=1.5), control) == 0.0
    assert stop_start(at(9.0, ax_mps2=-9.0), control) == -control.stop_decel_mps2
    assert stop_start(at(9.0, ax_mps2=math.nan), control) == 0.0


@pytest.mark.parametrize(("speed", "car", "sign"), [(9.0, CAR, 1.0), (-9.0, BACK, -1.0)])
def test_a_stop_by_numbers(speed: float, car: VehicleState, sign: float, control: ControlSettings) -> None:
    step = control.stop_jerk_mps3 * TICK_S
    stop = safe_stop(-1.0, 0.2, True, at(speed, car, ax_mps2=sign * -1.25), control, TICK_S)
    integral = 0.2 + control.integral_gain_per_s * (-1.0 - step + 1.25) * TICK_S
    assert stop == pytest.approx(((-0.3 + 1.0 + step - integral) / 8.7, -1.0 - step, integral))
    blind = safe_stop(-1.0, 0.2, True, at(speed, car, ax_mps2=math.nan), control, TICK_S)
    assert blind.integral_mps2 == 0.2
    wild = safe_stop(-2.5, 0.0, True, at(speed, car, ax_mps2=sign * 1e9), control, TICK_S)
    assert wild.integral_mps2 == pytest.approx(-control.integral_gain_per_s * control.decel_max_mps2 * TICK_S)
    most = safe_stop(
        -2.5, -3.0, True, at(speed, car, ax_mps2=sign * -2.5), control._replace(integral_max_mps2=3.0), TICK_S
    )
    assert most.brake == pytest.approx((control.stop_decel_max_mps2 - 0.3) / 8.7)
    held = safe_stop(-2.0, 0.5, True, at(0.0, car), control, TICK_S)
    assert held == (control.hold_brake, -2.0, 0.0)
    pushing = safe_stop(-0.1, 0.8, True, at(speed, car, ax_mps2=sign * -0.1), control, TICK_S)
    assert pushing.brake == 0.0
    downhill = at(speed, car, ax_mps2=sign * -0.1)._replace(coast_accel_mps2=sign * 1.0)
    assert safe_stop(-0.1, 0.8, True, downhill, control, TICK_S).brake == pytest.approx(1.0 / 10.0), (
        "never asked to speed up"
    )


def test_a_stop_that_nobody_steers_asks_for_more_sooner(control: ControlSettings) -> None:
    rolling = at(9.0, CAR, ax_mps2=-2.0)
    for steered, jerk, most in (
        (True, control.stop_jerk_mps3, control.stop_decel_mps2),
        (False, control.blind_stop_jerk_mps3, control.blind_stop_decel_mps2),
    ):
        stop = safe_stop(-2.0, 0.0, steered, rolling, control, TICK_S)
        assert stop.stop_accel_mps2 == pytest.approx(-2.0 - jerk * TICK_S)
        assert safe_stop(-most, 0.0, steered, rolling, control, TICK_S).stop_accel_mps2 == -most


def test_a_stop_of_a_car_that_states_no_figures_brakes_by_the_nominal_ones(control: ControlSettings) -> None:
    mute = VehicleState(*(0.0,) * len(VehicleState._fields))._replace(vx_mps=9.0, ax_mps2=-2.5)
    stop = safe_stop(-2.5, 0.0, True, mute, control, TICK_S)
    assert stop.brake == pytest.approx(2.5 / control.nominal_brake_accel_mps2)


def asked(kind: RemoteKind, **fields: float) -> RemoteCommand:
    return NO_COMMAND._replace(kind=float(kind), sequence=1.0, age_ticks=0.0, **fields)


def request(
    control: ControlSettings, command: RemoteCommand, vehicle: VehicleState, integral: float = 0.25
) -> tuple[float, ...]:
    return remote_request(command, 0.2, integral, vehicle, control, TICK_S)


def test_actuation_is_taken_as_it_is_within_its_range(control: ControlSettings) -> None:
    full = asked(RemoteKind.ACTUATION, road_wheel_rad=9.0, throttle=7.0, brake=0.0)
    assert request(control, full, at(9.0)) == (2.0, 1.0, 0.0, 1.0, 0.0)
    back = asked(RemoteKind.ACTUATION, road_wheel_rad=-9.0, throttle=-7.0, brake=7.0, direction=-1.0)
    assert request(control, back, at(9.0)) == (-2.0, 0.0, 1.0, -1.0, 0.0)
    edge = asked(RemoteKind.ACTUATION, throttle=0.5, brake=control.brake_override)
    assert request(control, edge, at(9.0))[1:3] == (0.0, control.brake_override)
    below = edge._replace(brake=control.brake_override - 1e-9)
    assert request(control, below, at(9.0))[1] == 0.5


@pytest.mark.parametrize("kind", RemoteKind)
def test_directions(kind: RemoteKind) -> None:
    by_sign = kind in (RemoteKind.SPEED, RemoteKind.TWIST)
    assert commanded_direction(asked(kind, speed_mps=-0.5)) == (-1.0 if by_sign else 1.0)
    assert commanded_direction(asked(kind, speed_mps=0.0)) == 1.0
    assert commanded_direction(asked(kind, speed_mps=0.5)) == 1.0
    assert commanded_direction(asked(kind, speed_mps=0.5, direction=-1.0)) == -1.0
    assert commanded_direction(asked(kind, speed_mps=-0.5, direction=0.0)) == 0.0
    assert commanded_direction(asked(kind, direction=0.5)) == 1.0


@pytest.mark.parametrize(
    ("speed", "taken_as"), [(0.04, None), (0.05, 0.5), (0.06, 0.5), (0.5, 0.5), (0.7, 0.7), (200.0, 100.0)]
)
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_slow_twist_steers_as_at_half_a_metre_a_second(
    speed: float, taken_as: float | None, sign: float, control: ControlSettings
) -> None:
    angle = twist_road_wheel(sign * speed, 0.1, 0.2, control)
    turned = None if taken_as is None else sign * math.atan(control.wheelbase_m * 0.1 / taken_as)
    assert angle == (0.2 if turned is None else pytest.approx(turned))


def test_a_speed_command_by_numbers(control: ControlSettings) -> None:
    faster = request(control, asked(RemoteKind.SPEED, speed_mps=10.5), at(10.0))
    assert faster[1] == pytest.approx((0.5 + 0.25 + 0.3) / 3.3)
    assert faster[4] == pytest.approx(0.25 + control.integral_gain_per_s * 0.5 * TICK_S)
    far = request(control, asked(RemoteKind.SPEED, speed_mps=50.0), at(10.0))
    assert (far[1], far[4]) == (pytest.approx((2.0 + 0.25 + 0.3) / 3.3), 0.25)
    gentle = request(control, asked(RemoteKind.SPEED, speed_mps=50.0, accel_mps2=0.5), at(10.0))
    assert gentle[1] == pytest.approx((0.5 + 0.25 + 0.3) / 3.3)
    for given in (-1.0, 99.0):
        plain = request(control, asked(RemoteKind.SPEED, speed_mps=50.0, accel_mps2=given), at(10.0))
        assert plain[1] == far[1]
    slower = request(control, asked(RemoteKind.SPEED, speed_mps=8.0), at(10.0))
    assert slower[2] == pytest.approx((-0.3 + 2.0 - 0.25) / 8.7)


def test_full_pedals_wind_nothing_up(control: ControlSettings) -> None:
    full = request(control, asked(RemoteKind.ACCELERATION, accel_mps2=3.5), at(10.0, ax_mps2=1.0))
    assert (full[1], full[4]) == (1.0, 0.25)
    brake = request(control, asked(RemoteKind.ACCELERATION, accel_mps2=-12.0), at(10.0, ax_mps2=-1.0))
    assert (brake[2], brake[4]) == (1.0, 0.25)
    free = request(control, asked(RemoteKind.ACCELERATION, accel_mps2=1.5), at(10.0, ax_mps2=1.0))
    assert free[4] == pytest.approx(0.25 + control.integral_gain_per_s * 0.5 * TICK_S)
    blind = request(control, asked(RemoteKind.ACCELERATION, accel_mps2=1.5), at(10.0, ax_mps2=math.nan))
    assert blind[4] == 0.25
    reverse = request(
        control, asked(RemoteKind.ACCELERATION, accel_mps2=1.5, direction=-1.0), at(-5.0, BACK, ax_mps2=-1.0)
    )
    assert reverse[4] == pytest.approx(0.25 + control.integral_gain_per_s * 0.5 * TICK_S)


def test_standing_and_rolling_the_wrong_way(control: ControlSettings) -> None:
    hold = (0.2, 0.0, control.hold_brake, 1.0, 0.0)
    stand = asked(RemoteKind.TWIST, speed_mps=0.0)
    assert request(control, stand, at(0.09)) == hold
    assert request(control, stand, at(-0.09)) == hold
    closing = request(control, stand, at(0.2), integral=0.0)
    assert closing[2] == pytest.approx((-0.3 + 0.5) / 8.7)
    assert request(control, asked(RemoteKind.ACCELERATION, accel_mps2=0.0), at(0.0))[2] == control.hold_brake
    assert request(control, asked(RemoteKind.ACCELERATION, accel_mps2=0.1), at(0.0))[2] == 0.0
    wrong = request(control, asked(RemoteKind.SPEED, speed_mps=5.0), at(-0.6, BACK))
    assert (wrong[1], wrong[2], wrong[4]) == (0.0, pytest.approx((2.5 - 0.3) / 8.7), 0.0)
    assert request(control, asked(RemoteKind.SPEED, speed_mps=5.0), at(-0.4, BACK))[2] == 0.0


def test_in_neutral_it_brakes_in_whichever_way_the_car_rolls_and_never_drives(control: ControlSettings) -> None:
    slower = asked(RemoteKind.SPEED, speed_mps=2.0, direction=0.0)
    forward = request(control, slower, at(4.0), integral=0.0)
    assert (forward[1], forward[2], forward[3]) == (0.0, pytest.approx((-0.3 + 2.0) / 8.7), 0.0)
    assert request(control, slower, at(-4.0, BACK), integral=0.0)[1:] == pytest.approx(forward[1:])
    faster = asked(RemoteKind.SPEED, speed_mps=4.5, direction=0.0)
    assert request(control, faster, at(4.0)) == (0.0, 0.0, 0.0, 0.0, 0.0)
    halt = asked(RemoteKind.SPEED, speed_mps=0.0, direction=0.0)
    assert request(control, halt, at(0.8), integral=0.0)[2] == pytest.approx((-0.3 + 0.8) / 8.7)


@pytest.mark.parametrize("accel", [2.0, 0.01, 0.0, -0.1, -0.29])
def test_in_neutral_the_engine_is_never_revved(accel: float, control: ControlSettings) -> None:
    """Less braking than coasting gives would be throttle in gear."""
    gentle = asked(RemoteKind.ACCELERATION, accel_mps2=accel, direction=0.0)
    for vehicle in (at(4.0, ax_mps2=-0.3), at(-4.0, BACK, ax_mps2=0.3)):
        assert request(control, gentle, vehicle, integral=0.0) == (0.0, 0.0, 0.0, 0.0, 0.0)
    assert request(control, gentle._replace(direction=1.0), at(4.0), integral=0.0)[1] > 0.0


def test_a_speed_command_at_its_thresholds(control: ControlSettings) -> None:
    """Standing, the wrong way and the least commanded speed: at the figure itself the car drives on."""
    stand = asked(RemoteKind.SPEED, speed_mps=0.0)
    closing = request(control, stand, at(control.standstill_speed_mps), integral=0.0)
    assert closing[2] == pytest.approx((-0.3 + 0.5) / 8.7)
    assert request(control, asked(RemoteKind.SPEED, speed_mps=0.05), at(0.0), integral=0.0)[2] == 0.0
    back = request(control, asked(RemoteKind.SPEED, speed_mps=5.0), at(-0.5, BACK), integral=0.0)
    assert (back[1] > 0.0, back[2]) == (True, 0.0)


def test_a_vehicle_whose_speed_is_no_number_is_driven_as_if_it_stood(control: ControlSettings) -> None:
    creep = asked(RemoteKind.SPEED, speed_mps=0.5)
    assert request(control, creep, at(math.nan)) == request(control, creep, at(0.0))
    assert request(control, creep, at(1e300)) == request(control, creep, at(100.0))
    assert request(control, creep, at(-1e300)) == request(control, creep, at(-100.0))


def test_the_wheel_takes_over_at_the_threshold_itself(control: ControlSettings) -> None:
    start = WheelWatch(0.0, 0.0)
    past = watch_wheel(start, control.steering_override_rad, 0.0, 0.0, 0.0, True, True, control)
    assert past.past_ticks == 1.0
    assert (
        watch_wheel(start, control.steering_override_rad - 1e-9, 0.0, 0.0, 0.0, True, True, control).past_ticks == 0.0
    )
    assert watch_wheel(past, control.steering_release_rad, 0.0, 0.0, 0.0, True, True, control).past_ticks == 2.0
    assert watch_wheel(past, control.steering_release_rad - 1e-9, 0.0, 0.0, 0.0, True, True, control).past_ticks == 0.0
    for rate in (control.steering_override_radps, -control.steering_override_radps):
        assert watch_wheel(start, 0.0, rate, 0.0, 0.0, True, True, control).past_ticks == 1.0
        assert watch_wheel(start, 0.0, rate * 0.999, 0.0, 0.0, True, True, control).past_ticks == 0.0
    ticks = control.steering_override_ticks
    assert not steering_taken(WheelWatch(0.0, ticks), control)
    assert steering_taken(WheelWatch(0.0, ticks + 1.0), control)


def test_the_accelerator_overrides_at_its_thresholds(control: ControlSettings) -> None:
    press, release = control.throttle_override, control.throttle_release
    assert [throttle_overrides(0.0, throttle, control) for throttle in (press - 1e-9, press)] == [0.0, 1.0]
    assert [throttle_overrides(1.0, throttle, control) for throttle in (release - 1e-9, release)] == [0.0, 1.0]
    free = control._replace(throttle_release=0.0)
    assert [throttle_overrides(1.0, throttle, free) for throttle in (0.0, 1e-9)] == [0.0, 1.0]


def test_a_crossing_far_away_is_never(control: ControlSettings) -> None:
    vehicle = at(1.0)
    assert time_to_crossing(0.001, 0.0, vehicle, control) == pytest.approx(math.sqrt(1.5 * 2.6 / 0.001), rel=1e-4)
    assert time_to_crossing(0.0003, 0.0, vehicle, control) == 100.0
    near = time_to_crossing(0.6, 0.0, at(20.0), control)
    assert near == pytest.approx(math.sqrt(1.5 * 2.6 / math.tan(0.6)) / 20.0)
