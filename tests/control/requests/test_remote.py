import math
from typing import Any

import pytest

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.remote import (
    command_finite,
    commanded_direction,
    implausible,
    known_kind,
    remote_request,
    twist_road_wheel,
)
from simconsole.values.signals import RemoteCommand, RemoteKind, VehicleState

EMPTY = RemoteCommand(*(0.0,) * len(RemoteCommand._fields))
VEHICLE = VehicleState(*(0.0,) * len(VehicleState._fields))._replace(
    coast_accel_mps2=-0.3, full_throttle_accel_mps2=3.0, full_brake_accel_mps2=-9.0
)
HELD_RAD = 0.123


def request(
    control: ControlSettings, kind: RemoteKind, vx_mps: float = 10.0, integral: float = 0.0, **fields: float
) -> Any:
    command = EMPTY._replace(**{"kind": float(kind), "sequence": 1.0, "direction": 1.0, **fields})
    vehicle = VEHICLE._replace(vx_mps=vx_mps, ax_mps2=fields.get("accel_mps2", 0.0))
    return remote_request(command, HELD_RAD, integral, vehicle, control, 0.004)


def test_acceleration_becomes_pedals_and_steering_passes(control: ControlSettings) -> None:
    asked = request(control, RemoteKind.ACCELERATION, accel_mps2=1.35, road_wheel_rad=0.2)
    assert asked[:4] == pytest.approx((0.2, 0.5, 0.0, 1.0))
    asked = request(control, RemoteKind.ACCELERATION, accel_mps2=-4.65)
    assert math.isclose(asked.brake, 0.5)
    assert asked.throttle == 0.0


def test_acceleration_at_standstill_holds_or_drives_off(control: ControlSettings) -> None:
    for accel in (0.0, -1.0):
        asked = request(control, RemoteKind.ACCELERATION, vx_mps=0.05, accel_mps2=accel)
        assert (asked.throttle, asked.brake, asked.speed_integral_mps2) == (0.0, control.hold_brake, 0.0)
    asked = request(control, RemoteKind.ACCELERATION, vx_mps=0.0, accel_mps2=1.0)
    assert asked.throttle > 0.0
    assert asked.brake == 0.0


def test_speed_is_approached_within_comfort(control: ControlSettings) -> None:
    slow = request(control, RemoteKind.SPEED, vx_mps=5.0, speed_mps=15.0)
    assert math.isclose(slow.throttle, 2.3 / 3.3)
    assert slow.speed_integral_mps2 == 0.0
    limited = request(control, RemoteKind.SPEED, vx_mps=5.0, speed_mps=15.0, accel_mps2=0.7)
    assert math.isclose(limited.throttle, 1.0 / 3.3)
    fast = request(control, RemoteKind.SPEED, vx_mps=15.0, speed_mps=5.0)
    assert math.isclose(fast.brake, 3.7 / 8.7)
    near = request(control, RemoteKind.SPEED, vx_mps=10.0, speed_mps=10.5, integral=0.1)
    assert math.isclose(near.throttle, 0.9 / 3.3)
    assert near.speed_integral_mps2 > 0.1


def test_speed_zero_stops_and_holds(control: ControlSettings) -> None:
    creeping = request(control, RemoteKind.SPEED, vx_mps=0.15, speed_mps=0.0)
    assert creeping.brake > 0.0
    held = request(control, RemoteKind.SPEED, vx_mps=0.05, speed_mps=0.0)
    assert held.brake == control.hold_brake


def test_twist_becomes_the_angle_of_its_curvature(control: ControlSettings) -> None:
    asked = request(control, RemoteKind.TWIST, speed_mps=10.0, yaw_rate_radps=0.5)
    assert math.isclose(asked.road_wheel_rad, math.atan(control.wheelbase_m * 0.5 / 10.0))
    back = request(control, RemoteKind.TWIST, vx_mps=0.0, speed_mps=-2.0, yaw_rate_radps=0.3)
    assert math.isclose(back.road_wheel_rad, math.atan(control.wheelbase_m * 0.3 / -2.0))
    assert back.direction == -1.0


def test_a_twist_needs_neither_steering_nor_pedals_where_the_vehicle_turns_in_place(control: ControlSettings) -> None:
    robot = control._replace(turns_in_place=1.0)
    for speed, rate in ((0.0, 1.0), (0.2, 0.0), (-0.2, -1.0)):
        asked = request(robot, RemoteKind.TWIST, speed_mps=speed, yaw_rate_radps=rate)
        assert asked[:3] == (0.0, 0.0, 0.0)
    assert request(robot, RemoteKind.SPEED, vx_mps=0.0, speed_mps=1.0).throttle > 0.0


@pytest.mark.parametrize("speed", [0.0, -0.0, 0.049, -0.049, 5e-324])
def test_a_standing_twist_holds_the_wheels(speed: float, control: ControlSettings) -> None:
    assert twist_road_wheel(speed, 1e308, HELD_RAD, control) == HELD_RAD


@pytest.mark.parametrize("speed", [0.05, -0.05, 0.4, -0.4, 1e308, -1e308])
def test_a_slow_or_absurd_twist_gives_a_finite_angle(speed: float, control: ControlSettings) -> None:
    angle = twist_road_wheel(speed, 1e308, HELD_RAD, control)
    assert abs(angle) < 1.5707963267948966
    assert (angle > 0.0) == (speed > 0.0)


def test_actuation_passes_with_brake_over_throttle(control: ControlSettings) -> None:
    asked = request(control, RemoteKind.ACTUATION, throttle=0.4, brake=0.02, road_wheel_rad=-0.1)
    assert (asked.throttle, asked.brake, asked.road_wheel_rad) == (0.4, 0.02, -0.1)
    asked = request(control, RemoteKind.ACTUATION, throttle=0.4, brake=0.3)
    assert (asked.throttle, asked.brake) == (0.0, 0.3)
    asked = request(control, RemoteKind.ACTUATION, throttle=7.0, brake=-7.0, road_wheel_rad=99.0)
    assert (asked.throttle, asked.brake, asked.road_wheel_rad) == (1.0, 0.0, 2.0)


def test_a_pose_asks_for_no_pedals(control: ControlSettings) -> None:
    asked = request(control, RemoteKind.POSE, x_m=5.0, speed_mps=2.0)
    assert asked == (0.0, 0.0, 0.0, 1.0, 0.0)


@pytest.mark.parametrize(
    ("kind", "speed", "gear", "expected"),
    [
        (RemoteKind.ACCELERATION, -3.0, 1.0, 1.0),
        (RemoteKind.ACCELERATION, 0.0, -1.0, -1.0),
        (RemoteKind.SPEED, -3.0, 1.0, -1.0),
        (RemoteKind.SPEED, 3.0, 1.0, 1.0),
        (RemoteKind.TWIST, -3.0, 1.0, -1.0),
        (RemoteKind.TWIST, -3.0, 0.0, 0.0),
        (RemoteKind.ACTUATION, 0.0, -1.0, -1.0),
    ],
)
def test_direction(kind: RemoteKind, speed: float, gear: float, expected: float) -> None:
    assert commanded_direction(EMPTY._replace(kind=float(kind), speed_mps=speed, direction=gear)) == expected


def test_rolling_the_wrong_way_is_braked_first(control: ControlSettings) -> None:
    asked = request(control, RemoteKind.SPEED, vx_mps=3.0, speed_mps=-2.0)
    assert (asked.throttle, asked.direction) == (0.0, -1.0)
    assert math.isclose(asked.brake, (2.5 - 0.3) / 8.7)


def test_neutral_never_accelerates_and_still_brakes(control: ControlSettings) -> None:
    for vx in (3.0, -3.0):
        asked = request(control, RemoteKind.ACCELERATION, vx_mps=vx, accel_mps2=2.0, direction=0.0)
        assert (asked.throttle, asked.brake, asked.direction) == (0.0, 0.0, 0.0)
    asked = request(control, RemoteKind.ACCELERATION, vx_mps=3.0, accel_mps2=-2.0, direction=0.0)
    assert asked.brake > 0.0


def test_the_integral_waits_while_a_pedal_is_full(control: ControlSettings) -> None:
    asked = request(control, RemoteKind.ACCELERATION, accel_mps2=15.0, integral=0.2)
    assert (asked.throttle, asked.speed_integral_mps2) == (1.0, 0.2)
    asked = request(control, RemoteKind.ACCELERATION, accel_mps2=-15.0, integral=0.2)
    assert (asked.brake, asked.speed_integral_mps2) == (1.0, 0.2)


@pytest.mark.parametrize("field", RemoteCommand._fields)
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_one_field_that_is_not_finite_spoils_the_command(field: str, bad: float) -> None:
    assert command_finite(EMPTY)
    assert not command_finite(EMPTY._replace(**{field: bad}))


def test_kinds() -> None:
    assert [known_kind(float(kind)) for kind in RemoteKind] == [False, True, True, True, True, True]
    assert not known_kind(2.5)
    assert not known_kind(6.0)


ANGLES = (RemoteKind.ACCELERATION, RemoteKind.SPEED, RemoteKind.ACTUATION)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("kind", ANGLES)
@pytest.mark.parametrize("vx_mps", [4.0, 13.0, 30.0, -13.0])
def test_an_angle_is_implausible_beyond_twice_the_gates_limit(
    vx_mps: float, kind: RemoteKind, sign: float, control: ControlSettings
) -> None:
    assert control.implausible_lateral_accel_mps2 == 2.0 * control.automatic_lateral_accel_mps2 == 10.0
    vehicle = VEHICLE._replace(vx_mps=vx_mps)
    bound = math.atan(10.0 * control.wheelbase_m / vx_mps**2)
    command = EMPTY._replace(kind=float(kind), road_wheel_rad=sign * (bound - 1e-9))
    assert not implausible(command, vehicle, control)
    assert implausible(command._replace(road_wheel_rad=sign * (bound + 1e-9)), vehicle, control)
    assert implausible(command._replace(road_wheel_rad=sign * 1e308), vehicle, control)


def test_full_lock_is_plausible_at_walking_pace_and_while_the_speed_is_unknown(control: ControlSettings) -> None:
    lock = EMPTY._replace(kind=float(RemoteKind.ACCELERATION), road_wheel_rad=1.2)
    for vx_mps in (0.0, 1.4, -1.4, 3.1, math.nan, math.inf):
        assert not implausible(lock, VEHICLE._replace(vx_mps=vx_mps), control)
    assert implausible(lock, VEHICLE._replace(vx_mps=3.3), control)


@pytest.mark.parametrize("vx_mps", [10.0, -10.0])
def test_a_twist_is_judged_by_its_yaw_rate_at_the_present_speed(vx_mps: float, control: ControlSettings) -> None:
    """However slow the speed that it asks for: a sender that brakes may turn meanwhile."""
    vehicle = VEHICLE._replace(vx_mps=vx_mps)
    twist = EMPTY._replace(kind=float(RemoteKind.TWIST), speed_mps=0.1)
    for sign in (-1.0, 1.0):
        assert not implausible(twist._replace(yaw_rate_radps=sign * 1.0), vehicle, control)
        assert implausible(twist._replace(yaw_rate_radps=sign * 1.001), vehicle, control)
    assert implausible(twist._replace(yaw_rate_radps=1e308), vehicle._replace(vx_mps=1e308), control)
    assert not implausible(twist._replace(yaw_rate_radps=11.0), vehicle._replace(vx_mps=math.nan), control)
    assert implausible(
        twist._replace(yaw_rate_radps=0.11), vehicle._replace(vx_mps=math.copysign(1e9, vx_mps)), control
    )
    assert not implausible(twist._replace(yaw_rate_radps=0.09), vehicle._replace(vx_mps=1e9), control)
