import itertools
import math
from typing import Any

import pytest

from simconsole.control.gate import gate, limits_of
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.values.signals import (
    Arbitration,
    Event,
    GateLimit,
    Mode,
    RemoteCommand,
    RemoteKind,
    Request,
    VehicleCommand,
    VehicleState,
)

TICK_S = 0.004
NASTY = [math.nan, math.inf, -math.inf, 1e308, -1e308, -0.0, 5e-324, 1e9]


def zeros(record: Any) -> Any:
    return record(*(0.0,) * len(record._fields))


def passed(
    control: ControlSettings,
    mode: Mode = Mode.MANUAL,
    before: VehicleCommand | None = None,
    vehicle: VehicleState | None = None,
    remote: RemoteCommand | None = None,
    events: int = 0,
    **fields: float,
) -> VehicleCommand:
    return gate(
        zeros(Request)._replace(**fields),
        remote or zeros(RemoteCommand),
        zeros(Arbitration)._replace(mode=float(mode)),
        before or zeros(VehicleCommand),
        vehicle or zeros(VehicleState),
        control,
        TICK_S,
        float(events),
    )


def active(command: VehicleCommand) -> GateLimit:
    return GateLimit(int(command.gate_active))


def test_what_is_inside_every_limit_passes_unchanged(control: ControlSettings) -> None:
    before = zeros(VehicleCommand)._replace(road_wheel_rad=0.1, throttle=0.3, clutch=0.5, gear=2.0)
    command = passed(control, before=before, road_wheel_rad=0.101, throttle=0.31, clutch=0.51, gear=2.0)
    assert (command.road_wheel_rad, command.throttle, command.clutch, command.gear) == (0.101, 0.31, 0.51, 2.0)
    assert active(command) == 0


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize("field", Request._fields)
@pytest.mark.parametrize("bad", NASTY)
def test_no_request_gets_a_bad_value_through(mode: Mode, field: str, bad: float, control: ControlSettings) -> None:
    before = zeros(VehicleCommand)._replace(road_wheel_rad=0.1, throttle=0.2, gear=1.0)
    command = passed(control, mode, before, **{field: bad})  # type: ignore[arg-type]  # a field by its name
    assert_inside(command, control)
    if not math.isfinite(bad) and field != "automatic":  # a switch: whatever is not above 0 is off
        assert GateLimit.NON_FINITE in active(command)


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize("bad", NASTY)
def test_nor_does_a_broken_vehicle_or_memory(mode: Mode, bad: float, control: ControlSettings) -> None:
    every_vehicle = VehicleState(*(bad,) * len(VehicleState._fields))
    every_command = VehicleCommand(*(bad,) * len(VehicleCommand._fields))
    for kind in RemoteKind:
        every_remote = RemoteCommand(*(bad,) * len(RemoteCommand._fields))._replace(kind=float(kind))
        command = passed(control, mode, every_command, every_vehicle, every_remote, road_wheel_rad=0.1)
        assert_inside(command, control)


def assert_inside(command: VehicleCommand, control: ControlSettings) -> None:
    assert all(math.isfinite(value) for value in command)
    assert abs(command.road_wheel_rad) <= control.max_road_wheel_rad
    for pedal in (command.throttle, command.brake, command.clutch, command.handbrake):
        assert 0.0 <= pedal <= 1.0
    assert command.gear in range(-1, int(control.gear_max) + 1)
    assert command.turn_indicators in (-1.0, 0.0, 1.0)
    assert command.hazard_lights in (0.0, 1.0)
    assert abs(command.target_speed_mps) <= control.target_speed_max_mps
    assert abs(command.target_x_m) <= control.target_position_max_m
    assert abs(command.target_y_m) <= control.target_position_max_m


def test_a_request_that_is_no_number_is_replaced_by_the_safe_one(control: ControlSettings) -> None:
    before = zeros(VehicleCommand)._replace(road_wheel_rad=0.2, brake=0.3, throttle=0.0, gear=3.0, clutch=0.0)
    nan = math.nan
    command = passed(control, before=before, road_wheel_rad=nan, brake=nan, throttle=nan, gear=nan, clutch=nan)
    assert command[:6] == (0.2, 0.0, 0.3, 0.0, 0.0, 3.0)
    assert active(command) == GateLimit.NON_FINITE


@pytest.mark.parametrize("mode", Mode)
def test_the_rate_of_each_mode_holds_both_ways(mode: Mode, control: ControlSettings) -> None:
    limits = limits_of(float(mode), control)
    for sign in (1.0, -1.0):
        command = passed(control, mode, road_wheel_rad=sign)
        assert command.road_wheel_rad == pytest.approx(sign * limits.road_wheel_radps * TICK_S)
        assert GateLimit.RATE in active(command)
        assert GateLimit.RANGE in active(command)
    step = min(1.0, limits.brake_slew_per_s * TICK_S)
    assert passed(control, mode, brake=1.0).brake == pytest.approx(step)
    pressed = zeros(VehicleCommand)._replace(brake=1.0)
    assert passed(control, mode, pressed, brake=0.0).brake == pytest.approx(1.0 - step)


def test_nobody_notices_the_manual_limits(control: ControlSettings) -> None:
    limits = limits_of(float(Mode.MANUAL), control)
    assert limits.road_wheel_radps * 15.0 >= math.radians(1500.0) - 1e-9  # the fastest hands: about 1100 deg/s
    assert limits.lateral_accel_mps2 == 0.0  # counter-steering needs more angle than the curve
    assert 1.0 / limits.brake_slew_per_s <= 0.05
    assert limits_of(float(Mode.SHARED), control) == limits


@pytest.mark.parametrize("mode", [Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.MINIMAL_RISK])
@pytest.mark.parametrize("speed", [-30.0, -5.0, 5.0, 12.0, 30.0, 1e308])
def test_lateral_acceleration_is_limited_by_angle(mode: Mode, speed: float, control: ControlSettings) -> None:
    vehicle = zeros(VehicleState)._replace(vx_mps=speed)
    command = zeros(VehicleCommand)
    free = control._replace(automatic_lateral_jerk_mps3=0.0)
    for _ in range(400):
        command = passed(free, mode, command, vehicle, road_wheel_rad=-0.6)
    real = max(-100.0, min(100.0, speed))
    lateral = real**2 * math.tan(command.road_wheel_rad) / control.wheelbase_m
    assert lateral == pytest.approx(-min(5.0, real**2 * math.tan(0.6) / control.wheelbase_m))
    limited = GateLimit.LATERAL_ACCELERATION in active(command)
    assert limited == (abs(lateral) > 4.99)


def test_a_range_that_has_become_narrower_is_approached_not_jumped_to(control: ControlSettings) -> None:
    vehicle = zeros(VehicleState)._replace(vx_mps=20.0)
    before = zeros(VehicleCommand)._replace(road_wheel_rad=0.5)
    free = control._replace(automatic_lateral_jerk_mps3=0.0)
    command = passed(free, Mode.AUTONOMOUS, before, vehicle, road_wheel_rad=0.5)
    assert command.road_wheel_rad == pytest.approx(0.5 - control.automatic_road_wheel_radps * TICK_S)
    smooth = passed(control, Mode.AUTONOMOUS, before, vehicle, road_wheel_rad=0.5)
    assert command.road_wheel_rad < smooth.road_wheel_rad < 0.5


@pytest.mark.parametrize("mode", sorted(set(Mode) - {Mode.MANUAL, Mode.SHARED}))
@pytest.mark.parametrize("speed", [-25.0, 14.0, 40.0])
def test_lateral_jerk_is_limited_wherever_no_hand_steers(mode: Mode, speed: float, control: ControlSettings) -> None:
    vehicle = zeros(VehicleState)._replace(vx_mps=speed)
    command = zeros(VehicleCommand)
    for _ in range(40):
        before = command
        command = passed(control, mode, before, vehicle, road_wheel_rad=0.6)
        turned = math.tan(command.road_wheel_rad) - math.tan(before.road_wheel_rad)
        jerk = speed**2 / control.wheelbase_m * turned / TICK_S
        if active(command) & GateLimit.LATERAL_JERK:
            assert jerk == pytest.approx(control.automatic_lateral_jerk_mps3, rel=0.01)
        assert jerk <= control.automatic_lateral_jerk_mps3 * 1.01
    assert GateLimit.LATERAL_JERK in active(passed(control, mode, None, vehicle, road_wheel_rad=0.6))


@pytest.mark.parametrize("mode", [Mode.MANUAL, Mode.SHARED])
def test_a_persons_wheel_passes_in_the_same_tick_at_any_speed(mode: Mode, control: ControlSettings) -> None:
    """1100 deg/s at the hand wheel, the fastest hands, at 50 m/s: 2500 times the comfort limit of an automat."""
    vehicle = zeros(VehicleState)._replace(vx_mps=50.0)
    step = math.radians(1100.0) / 15.0 * TICK_S
    command = passed(control, mode, None, vehicle, road_wheel_rad=step)
    assert (command.road_wheel_rad, active(command)) == (step, 0)


def test_ticks_in_which_the_gate_changed_something_are_counted(control: ControlSettings) -> None:
    command = passed(control, road_wheel_rad=9.0)
    assert command.gate_active_ticks == 1.0
    command = passed(control, before=command, road_wheel_rad=9.0, throttle=5.0)
    assert command.gate_active_ticks == 2.0
    command = passed(control, before=command, road_wheel_rad=command.road_wheel_rad, throttle=command.throttle)
    assert (command.gate_active, command.gate_active_ticks) == (0.0, 2.0)


def test_emergency_stop_keeps_an_angle_that_was_let_in_before(control: ControlSettings) -> None:
    vehicle = zeros(VehicleState)._replace(vx_mps=30.0)
    before = zeros(VehicleCommand)._replace(road_wheel_rad=0.5)
    assert passed(control, Mode.EMERGENCY_STOP, before, vehicle, road_wheel_rad=0.5).road_wheel_rad == 0.5


def test_brake_over_throttle_at_once(control: ControlSettings) -> None:
    before = zeros(VehicleCommand)._replace(throttle=0.8)
    command = passed(control, before=before, throttle=0.8, brake=0.05)
    assert command.throttle == 0.0
    assert active(command) & GateLimit.BRAKE_OVER_THROTTLE
    assert passed(control, before=before, throttle=0.8, brake=0.049).throttle == 0.8
    releasing = before._replace(brake=0.5)
    assert passed(control, before=releasing, throttle=0.8, brake=0.0).throttle == 0.0


@pytest.mark.parametrize("mode", [Mode.PARKED, Mode.MINIMAL_RISK, Mode.STOPPED, Mode.EMERGENCY_STOP])
def test_no_throttle_gets_through_while_nobody_drives(mode: Mode, control: ControlSettings) -> None:
    before = zeros(VehicleCommand)._replace(throttle=0.8)
    assert passed(control, mode, before, throttle=0.8).throttle == 0.0


@pytest.mark.parametrize(
    ("wanted", "before", "automatic", "speed", "expected"),
    [
        (3.0, 2.0, 0.0, 20.0, 3.0),
        (7.0, 2.0, 0.0, 20.0, 7.0),
        (8.0, 2.0, 0.0, 20.0, 2.0),
        (2.5, 2.0, 0.0, 20.0, 2.0),
        (-2.0, 1.0, 0.0, 0.0, 1.0),
        (-1.0, 1.0, 0.0, 2.1, 1.0),
        (-1.0, 0.0, 0.0, 2.1, 0.0),
        (-1.0, 1.0, 0.0, 1.9, -1.0),
        (1.0, -1.0, 0.0, -2.1, -1.0),
        (1.0, -1.0, 0.0, -1.9, 1.0),
        (-1.0, -1.0, 0.0, 2.1, -1.0),
        (0.0, 3.0, 0.0, 30.0, 0.0),
        (3.0, 1.0, 1.0, 0.0, 1.0),
        (-1.0, 3.0, 1.0, 10.0, 1.0),
        (1.0, 0.0, 1.0, 10.0, 1.0),
        (1e308, 2.0, 0.0, 0.0, 2.0),
    ],
)
def test_gears(
    wanted: float, before: float, automatic: float, speed: float, expected: float, control: ControlSettings
) -> None:
    vehicle = zeros(VehicleState)._replace(vx_mps=speed)
    command = passed(
        control, before=zeros(VehicleCommand)._replace(gear=before), vehicle=vehicle, gear=wanted, automatic=automatic
    )
    assert command.gear == expected
    assert (GateLimit.GEAR in active(command)) == (wanted != expected)


def pose(**fields: float) -> RemoteCommand:
    base = zeros(RemoteCommand)._replace(kind=float(RemoteKind.POSE), x_m=3.0, y_m=-4.0, yaw_rad=1.0, speed_mps=2.0)
    return base._replace(**fields)  # type: ignore[no-any-return]


def test_targets_pass_while_a_pose_is_driven(control: ControlSettings) -> None:
    before = zeros(VehicleCommand)._replace(target_speed_mps=1.999)
    command = passed(control, Mode.AUTONOMOUS, before, remote=pose())
    assert command[7:11] == (2.0, 3.0, -4.0, 1.0)
    assert active(command) == 0
    rising = passed(control, Mode.AUTONOMOUS, remote=pose(speed_mps=99.0))
    assert rising.target_speed_mps == pytest.approx(control.target_accel_mps2 * TICK_S)
    assert active(rising) == GateLimit.RANGE | GateLimit.RATE


@pytest.mark.parametrize(
    ("field", "bad"), list(itertools.product(("x_m", "y_m", "yaw_rad"), (math.nan, math.inf, 1e6)))
)
def test_a_bad_target_keeps_the_whole_one_before(field: str, bad: float, control: ControlSettings) -> None:
    before = zeros(VehicleCommand)._replace(target_x_m=7.0, target_y_m=8.0, target_yaw_rad=0.5)
    command = passed(control, Mode.AUTONOMOUS, before, remote=pose(**{field: bad}))
    assert command[8:11] == (7.0, 8.0, 0.5)
    assert active(command) & (GateLimit.NON_FINITE | GateLimit.RANGE)


def test_a_bad_target_speed_slows_down(control: ControlSettings) -> None:
    before = zeros(VehicleCommand)._replace(target_speed_mps=2.0)
    command = passed(control, Mode.AUTONOMOUS, before, remote=pose(speed_mps=math.nan))
    assert command.target_speed_mps == pytest.approx(2.0 - control.target_accel_mps2 * TICK_S)
    assert GateLimit.NON_FINITE in active(command)
    speed = zeros(RemoteCommand)._replace(kind=float(RemoteKind.SPEED), speed_mps=math.inf)
    command = passed(control, Mode.AUTONOMOUS, before, remote=speed)
    assert command.target_speed_mps < 2.0
    assert GateLimit.NON_FINITE in active(command)


def test_in_a_stop_the_target_stays_and_its_speed_falls(control: ControlSettings) -> None:
    before = zeros(VehicleCommand)._replace(target_speed_mps=2.0, target_x_m=7.0)
    vehicle = zeros(VehicleState)._replace(x_m=1.0)
    command = passed(control, Mode.MINIMAL_RISK, before, vehicle, pose())
    assert command.target_x_m == 7.0
    assert command.target_speed_mps == pytest.approx(2.0 - control.stop_decel_mps2 * TICK_S)
    manual = passed(control, Mode.MANUAL, before, vehicle, pose())
    assert manual.target_x_m == 1.0
    assert manual.target_speed_mps < 2.0


def test_speed_commands_show_as_target_speed(control: ControlSettings) -> None:
    remote = zeros(RemoteCommand)._replace(kind=float(RemoteKind.SPEED), speed_mps=12.0)
    before = zeros(VehicleCommand)._replace(target_speed_mps=11.999)
    command = passed(control, Mode.AUTONOMOUS, before, zeros(VehicleState)._replace(x_m=5.0), remote)
    assert (command.target_speed_mps, command.target_x_m) == (12.0, 5.0)


@pytest.mark.parametrize(
    ("event", "field"),
    [
        (Event.TOGGLE_ANTI_LOCK, "anti_lock_off"),
        (Event.TOGGLE_TRACTION, "traction_off"),
        (Event.TOGGLE_STABILITY, "stability_off"),
    ],
)
def test_events_switch_a_driver_aid_off_and_on_again_and_a_reset_on(
    control: ControlSettings, event: Event, field: str
) -> None:
    off = passed(control, events=event | Event.MARK)
    assert getattr(off, field) == 1.0
    assert sum((off.anti_lock_off, off.traction_off, off.stability_off)) == 1.0
    assert getattr(passed(control, before=off), field) == 1.0, "it stays off"
    assert getattr(passed(control, before=off, events=event), field) == 0.0
    assert getattr(passed(control, before=off, events=Event.RESET), field) == 0.0


def twisted(yaw_rate_radps: float, kind: RemoteKind = RemoteKind.TWIST) -> RemoteCommand:
    command: RemoteCommand = zeros(RemoteCommand)
    return command._replace(kind=float(kind), yaw_rate_radps=yaw_rate_radps)


def test_the_yaw_rate_of_a_twist_passes_while_the_remote_side_drives(control: ControlSettings) -> None:
    assert passed(control, Mode.AUTONOMOUS, remote=twisted(1.5)).target_yaw_rate_radps == 1.5
    for mode in (Mode.PARKED, Mode.MANUAL, Mode.MINIMAL_RISK, Mode.STOPPED, Mode.EMERGENCY_STOP):
        assert passed(control, mode, remote=twisted(1.5)).target_yaw_rate_radps == 0.0
    assert passed(control, Mode.AUTONOMOUS, remote=twisted(1.5, RemoteKind.SPEED)).target_yaw_rate_radps == 0.0


def test_a_yaw_rate_that_is_not_finite_or_beyond_every_robot_does_not_pass(control: ControlSettings) -> None:
    bad = passed(control, Mode.AUTONOMOUS, remote=twisted(math.nan))
    assert bad.target_yaw_rate_radps == 0.0
    assert GateLimit.NON_FINITE in active(bad)
    wild = passed(control, Mode.AUTONOMOUS, remote=twisted(-1e9))
    assert wild.target_yaw_rate_radps == -20.0
    told = [active(passed(control, Mode.AUTONOMOUS, remote=twisted(rate))) for rate in (1.5, 0.0)]
    assert told[0] == told[1], "nothing is told of one that passes as it is"
    assert GateLimit.RANGE in active(wild)
