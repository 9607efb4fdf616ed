"""The gate at its edges: which limit is named when several act, memory that is no number, exact thresholds."""

import math
from typing import Any

import pytest

from simconsole.control.gate import Limits, gate, limits_of
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.values.signals import (
    Arbitration,
    GateLimit,
    Mode,
    RemoteCommand,
    RemoteKind,
    Request,
    VehicleCommand,
    VehicleState,
)

TICK_S = 0.004


def zeros(record: Any) -> Any:
    return record(*(0.0,) * len(record._fields))


BEFORE: VehicleCommand = zeros(VehicleCommand)
STANDING: VehicleState = zeros(VehicleState)
FAST = STANDING._replace(vx_mps=20.0)
REMOTE: RemoteCommand = zeros(RemoteCommand)


def passed(
    control: ControlSettings,
    mode: Mode = Mode.MANUAL,
    before: VehicleCommand = BEFORE,
    vehicle: VehicleState = STANDING,
    remote: RemoteCommand = REMOTE,
    **fields: float,
) -> VehicleCommand:
    arbitration = zeros(Arbitration)._replace(mode=float(mode))
    return gate(zeros(Request)._replace(**fields), remote, arbitration, before, vehicle, control, TICK_S, 0.0)


def active(command: VehicleCommand) -> GateLimit:
    return GateLimit(int(command.gate_active))


def test_the_limits_of_every_mode(control: ControlSettings) -> None:
    s = control
    slew = s.manual_pedal_slew_per_s
    manual = Limits(0.6, s.manual_road_wheel_radps, 0.0, 0.0, slew, slew, 5.0)
    automatic = Limits(0.6, 1.0, 5.0, 7.0, 4.0, 6.0, 5.0)
    stop = Limits(0.6, 0.5, 5.0, 7.0, slew, 6.0, 2.5)
    emergency = Limits(0.6, 0.5, 0.0, 7.0, slew, 1000.0, 5.0)
    expected = {
        Mode.MANUAL: manual,
        Mode.SHARED: manual,
        Mode.AUTONOMOUS: automatic,
        Mode.TAKEOVER_REQUESTED: automatic,
        Mode.EMERGENCY_STOP: emergency,
    }
    for mode in Mode:
        assert limits_of(float(mode), control) == expected.get(mode, stop)


def test_a_command_before_that_is_no_number_counts_as_the_middle_in_neutral(control: ControlSettings) -> None:
    nothing = VehicleCommand(*(math.nan,) * len(VehicleCommand._fields))
    command = passed(control, before=nothing, road_wheel_rad=0.001, gear=99.0)
    assert (command.road_wheel_rad, command.gear, command.gate_active_ticks) == (0.001, 0.0, 1.0)
    assert (command.target_speed_mps, command.target_x_m, command.target_yaw_rad) == (0.0, 0.0, 0.0)
    odd = BEFORE._replace(target_x_m=math.nan, target_y_m=math.nan, target_yaw_rad=math.nan, target_speed_mps=math.nan)
    lost = passed(control, Mode.AUTONOMOUS, odd, remote=REMOTE._replace(kind=5.0, x_m=math.inf, speed_mps=0.0))
    assert lost[7:11] == (0.0, 0.0, 0.0, 0.0)
    assert active(lost) == GateLimit.NON_FINITE


@pytest.mark.parametrize("mode", Mode)
def test_no_mode_holds_back_a_foot_that_brakes_harder(mode: Mode, control: ControlSettings) -> None:
    step = max(control.manual_pedal_slew_per_s, limits_of(float(mode), control).brake_slew_per_s) * TICK_S

    def braked(foot: float, asked: float, before: float) -> float:
        arbitration = zeros(Arbitration)._replace(mode=float(mode), person_brake=foot)
        request, command = zeros(Request)._replace(brake=asked), BEFORE._replace(brake=before)
        return gate(request, REMOTE, arbitration, command, zeros(VehicleState), control, TICK_S, 0.0).brake

    own = min(1.0, limits_of(float(mode), control).brake_slew_per_s * TICK_S)
    assert braked(foot=1.0, asked=1.0, before=0.0) == pytest.approx(min(1.0, step))
    assert braked(foot=0.4, asked=1.0, before=0.0) == pytest.approx(own), "the controller, or the stop, asks for more"
    assert braked(foot=0.0, asked=0.0, before=1.0) == pytest.approx(1.0 - own), "nobody's foot: released as ever"


@pytest.mark.parametrize("name", ["clutch", "handbrake"])
def test_what_only_hands_and_feet_move_has_their_rate_in_every_mode(name: str, control: ControlSettings) -> None:
    step = control.manual_pedal_slew_per_s * TICK_S
    for mode in Mode:
        command = passed(control, mode, **{name: 1.0})  # type: ignore[arg-type]  # a field by its name
        assert getattr(command, name) == step
        assert GateLimit.RATE in active(command)
        pressed = BEFORE._replace(**{name: 1.0})
        assert getattr(passed(control, mode, pressed), name) == 1.0 - step
        assert getattr(passed(control, mode, pressed, **{name: math.nan}), name) == 1.0 - step  # type: ignore[arg-type]  # a field by its name


def test_throttle_rises_slowly_and_falls_as_fast_as_a_foot(control: ControlSettings) -> None:
    half = BEFORE._replace(throttle=0.5)
    for mode, up in ((Mode.MANUAL, 25.0), (Mode.AUTONOMOUS, 4.0)):
        risen = passed(control, mode, half, throttle=1.0)
        assert (risen.throttle, active(risen)) == (0.5 + up * TICK_S, GateLimit.RATE)
        fallen = passed(control, mode, half, throttle=0.0)
        assert (fallen.throttle, active(fallen)) == (0.5 - 25.0 * TICK_S, GateLimit.RATE)


def test_the_brake_cuts_the_throttle_from_its_threshold_on_asked_or_in_force(control: ControlSettings) -> None:
    half = BEFORE._replace(throttle=0.5)
    edge = control._replace(brake_override=0.5, manual_pedal_slew_per_s=62.5)
    assert passed(edge, Mode.AUTONOMOUS, half, throttle=0.5, brake=0.5).throttle == 0.0
    assert passed(edge, Mode.AUTONOMOUS, half, throttle=0.5, brake=0.4999).throttle == 0.5
    in_force = half._replace(brake=0.75)
    assert passed(edge, Mode.MANUAL, in_force, throttle=0.5).throttle == 0.0
    assert passed(edge, Mode.MANUAL, half._replace(brake=0.7499), throttle=0.5).throttle == 0.5


def test_a_cut_throttle_is_named_and_nothing_else(control: ControlSettings) -> None:
    braked = BEFORE._replace(throttle=0.5, brake=0.5)
    assert active(passed(control, before=braked, throttle=0.5, brake=0.5)) == GateLimit.BRAKE_OVER_THROTTLE
    assert active(passed(control, before=braked._replace(throttle=0.0), brake=0.5)) == 0
    # The release of 0.1 a tick would leave 0.4: cut as well, though no throttle is asked for any more.
    assert active(passed(control, before=braked, brake=0.5)) == GateLimit.BRAKE_OVER_THROTTLE
    nonsense = passed(control, before=braked._replace(throttle=0.0), brake=0.5, throttle=math.nan)
    assert active(nonsense) == GateLimit.NON_FINITE
    both = passed(control, before=braked, brake=0.5, throttle=math.nan)
    assert active(both) == GateLimit.NON_FINITE | GateLimit.BRAKE_OVER_THROTTLE
    risen = passed(control, before=braked._replace(throttle=0.0), brake=0.5, throttle=1.0)
    assert active(risen) == GateLimit.BRAKE_OVER_THROTTLE


def test_every_limit_that_acts_on_the_wheel_is_named(control: ControlSettings) -> None:
    beyond = BEFORE._replace(road_wheel_rad=5.0)
    assert active(passed(control, before=beyond, road_wheel_rad=math.nan)) == (
        GateLimit.NON_FINITE | GateLimit.RANGE | GateLimit.RATE
    )
    far = passed(control, Mode.AUTONOMOUS, vehicle=FAST, road_wheel_rad=9.0)
    assert active(far) == GateLimit.RANGE | GateLimit.LATERAL_ACCELERATION | GateLimit.LATERAL_JERK
    slow = STANDING._replace(vx_mps=0.5)
    assert active(passed(control, Mode.AUTONOMOUS, vehicle=slow, road_wheel_rad=0.5)) == GateLimit.RATE
    held = BEFORE._replace(road_wheel_rad=0.5)
    assert active(passed(control, Mode.AUTONOMOUS, held, FAST, road_wheel_rad=0.5)) == (
        GateLimit.LATERAL_ACCELERATION | GateLimit.LATERAL_JERK
    )


def test_a_wheel_beyond_the_lock_comes_back_to_it_at_once(control: ControlSettings) -> None:
    for sign in (1.0, -1.0):
        beyond = BEFORE._replace(road_wheel_rad=sign * 5.0)
        assert passed(control, before=beyond, road_wheel_rad=sign * 0.5).road_wheel_rad == sign * 0.6


def test_pedals_out_of_range_are_named(control: ControlSettings) -> None:
    pressed = BEFORE._replace(throttle=1.0, clutch=1.0, handbrake=1.0)
    for name in ("throttle", "clutch", "handbrake"):
        command = passed(control, before=pressed, **{"throttle": 1.0, "clutch": 1.0, "handbrake": 1.0, name: 1.01})  # type: ignore[arg-type]  # a field by its name
        assert (getattr(command, name), active(command)) == (1.0, GateLimit.RANGE)
    assert active(passed(control, brake=-0.01)) == GateLimit.RANGE
    assert passed(control, before=BEFORE._replace(brake=7.0), brake=1.0).brake == 1.0
    assert passed(control, before=BEFORE._replace(brake=-7.0), brake=0.0).brake == 0.0
    assert passed(control, before=BEFORE._replace(brake=math.nan), brake=0.3).brake == 0.3


def test_direction_may_change_up_to_two_metres_a_second(control: ControlSettings) -> None:
    driving = BEFORE._replace(gear=1.0)
    most = control.reverse_speed_max_mps
    assert passed(control, before=driving, vehicle=STANDING._replace(vx_mps=most), gear=-1.0).gear == -1.0
    assert passed(control, before=driving, vehicle=STANDING._replace(vx_mps=most + 0.01), gear=-1.0).gear == 1.0
    walking = control._replace(reverse_speed_max_mps=0.5)
    assert passed(walking, before=driving, vehicle=STANDING._replace(vx_mps=math.nan), gear=-1.0).gear == -1.0
    for wild in (-7.0, 30.0):
        kept = passed(control, before=BEFORE._replace(gear=wild), gear=2.5).gear
        assert kept == max(-1.0, min(control.gear_max, wild))
        assert passed(control, before=BEFORE._replace(gear=wild), gear=math.nan).gear == kept
    assert passed(control, before=BEFORE._replace(gear=30.0), gear=2.5, automatic=1.0).gear == 1.0
    assert passed(control, gear=2.0, automatic=1e-9).automatic == 1.0
    assert passed(control, gear=2.0, automatic=-1.0).automatic == 0.0
    assert active(passed(control, gear=-1.0)) == active(passed(control, gear=control.gear_max)) == 0
    assert passed(control, vehicle=STANDING._replace(vx_mps=-5.0), gear=0.0).gear == 0.0


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_targets_have_the_range_of_the_profile(sign: float, control: ControlSettings) -> None:
    most, far = control.target_speed_max_mps, control.target_position_max_m
    at_most = BEFORE._replace(target_speed_mps=sign * most)
    pose = REMOTE._replace(kind=float(RemoteKind.POSE), speed_mps=sign * most, x_m=sign * far, y_m=sign * far)
    edge = passed(control, Mode.AUTONOMOUS, at_most, remote=pose._replace(yaw_rad=sign * 1000.0))
    assert edge[7:11] == (sign * most, sign * far, sign * far, sign * 1000.0)
    assert active(edge) == 0
    faster = passed(control, Mode.AUTONOMOUS, at_most, remote=pose._replace(speed_mps=sign * (most + 1.0)))
    assert (faster.target_speed_mps, active(faster)) == (sign * most, GateLimit.RANGE)
    for field in ("x_m", "y_m", "yaw_rad"):
        beyond = pose._replace(**{field: sign * (far + 1.0)})
        assert GateLimit.RANGE in active(passed(control, Mode.AUTONOMOUS, at_most, remote=beyond))
    wild = BEFORE._replace(
        target_speed_mps=sign * 99.0, target_x_m=sign * 1e9, target_y_m=sign * 1e9, target_yaw_rad=sign * 1e9
    )
    kept = passed(control, Mode.AUTONOMOUS, wild, remote=pose._replace(x_m=math.nan))
    assert kept[7:11] == (sign * most, sign * far, sign * far, sign * 1000.0)
    assert active(kept) == GateLimit.NON_FINITE
    both = passed(control, Mode.AUTONOMOUS, remote=pose._replace(x_m=sign * (far + 1.0), speed_mps=math.nan))
    assert active(both) == GateLimit.RANGE | GateLimit.NON_FINITE
    both = passed(control, Mode.AUTONOMOUS, at_most, remote=pose._replace(x_m=math.nan, speed_mps=sign * 99.0))
    assert active(both) == GateLimit.RANGE | GateLimit.NON_FINITE
    for kind in (RemoteKind.POSE, RemoteKind.SPEED):
        nonsense = passed(control, Mode.AUTONOMOUS, remote=pose._replace(kind=float(kind), speed_mps=math.nan))
        assert (nonsense.target_speed_mps, active(nonsense)) == (0.0, GateLimit.NON_FINITE)
    speed = REMOTE._replace(kind=float(RemoteKind.SPEED), speed_mps=sign * 99.0)
    assert passed(control, Mode.AUTONOMOUS, at_most, remote=speed).target_speed_mps == sign * most


@pytest.mark.parametrize("mode", Mode)
def test_whose_target_it_is(mode: Mode, control: ControlSettings) -> None:
    before = BEFORE._replace(target_speed_mps=1.0, target_x_m=7.0, target_y_m=8.0, target_yaw_rad=0.5)
    vehicle = STANDING._replace(x_m=1.0, y_m=2.0, yaw_rad=0.25)
    remote = REMOTE._replace(kind=float(RemoteKind.POSE), speed_mps=1.0, x_m=3.0, y_m=4.0, yaw_rad=0.75)
    command = passed(control, mode, before, vehicle, remote)
    if mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.SHARED):
        assert command[7:11] == (1.0, 3.0, 4.0, 0.75)
    elif mode in (Mode.PARKED, Mode.MANUAL):
        assert command[8:11] == (1.0, 2.0, 0.25)
    else:
        assert command[8:11] == (7.0, 8.0, 0.5)
    falls = {Mode.AUTONOMOUS: 0.0, Mode.TAKEOVER_REQUESTED: 0.0, Mode.SHARED: 0.0, Mode.MANUAL: 5.0}
    fall = falls.get(mode, 5.0 if mode is Mode.EMERGENCY_STOP else 2.5)
    assert command.target_speed_mps == pytest.approx(1.0 - fall * TICK_S)
    broken = vehicle._replace(x_m=math.nan)
    if mode in (Mode.PARKED, Mode.MANUAL):
        lost = passed(control, mode, before, broken, remote)
        assert lost[8:11] == (7.0, 8.0, 0.5)
        assert active(lost) == GateLimit.NON_FINITE


@pytest.mark.parametrize("mode", Mode)
def test_a_lamp_is_on_or_off_and_one_that_is_no_number_stays(mode: Mode, control: ControlSettings) -> None:
    for side in (-1.0, 0.0, 1.0):
        shown = passed(control, mode, turn_indicators=side, hazard_lights=abs(side))
        assert (shown.turn_indicators, shown.hazard_lights, active(shown)) == (side, abs(side), GateLimit(0))
    half = passed(control, mode, turn_indicators=-0.25)
    assert (half.turn_indicators, half.hazard_lights, active(half)) == (-1.0, 0.0, GateLimit.RANGE)
    beyond = passed(control, mode, turn_indicators=2.0, hazard_lights=3.0)
    assert (beyond.turn_indicators, beyond.hazard_lights, active(beyond)) == (1.0, 1.0, GateLimit.RANGE)
    below = passed(control, mode, hazard_lights=-1.0)
    assert (below.hazard_lights, active(below)) == (0.0, GateLimit.RANGE)
    between = passed(control, mode, BEFORE._replace(turn_indicators=0.5), turn_indicators=math.nan)
    assert (between.turn_indicators, active(between)) == (1.0, GateLimit.NON_FINITE | GateLimit.RANGE)
    lit = BEFORE._replace(turn_indicators=-1.0, hazard_lights=1.0)
    kept = passed(control, mode, lit, turn_indicators=math.nan, hazard_lights=math.inf)
    assert (kept.turn_indicators, kept.hazard_lights, active(kept)) == (-1.0, 1.0, GateLimit.NON_FINITE)
    unknown = passed(control, mode, BEFORE._replace(hazard_lights=math.nan), hazard_lights=math.nan)
    assert (unknown.hazard_lights, active(unknown)) == (0.0, GateLimit.NON_FINITE)
