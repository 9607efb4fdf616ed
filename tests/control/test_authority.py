"""Authority, the remote side's part, transmission and blend, function by function."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.control.authority import (
    RemoteSide,
    Shares,
    Transmission,
    blend,
    remote_side,
    shares_of,
    steered_stop,
    transmission_of,
)
from simconsole.control.lights import Lights
from simconsole.control.modes.decision import Decision
from simconsole.control.requests.angles import lateral_apart
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import Person
from simconsole.control.requests.remote import RemoteRequest
from simconsole.control.requests.tick_context import TickContext
from simconsole.values.signals import Arbitration, Link, Mode, Reason, Request, VehicleCommand

TICK_S = 0.004
BEFORE = Arbitration(*(0.0,) * len(Arbitration._fields))._replace(
    remote_lateral=0.5,
    remote_longitudinal=0.25,
    remote_guidance=0.125,
    remote_road_wheel_rad=0.2,
    remote_throttle=0.4,
    remote_brake=0.6,
)
IN_FORCE = VehicleCommand(*(0.0,) * len(VehicleCommand._fields))._replace(road_wheel_rad=0.1, throttle=0.3, brake=0.2)
PERSON = Person(1.0, 1.0, 0.05, 0.1, 0.0, 0.1)
FRESH = Link(*(0.0,) * len(Link._fields))._replace(fresh=1.0)
STALE = FRESH._replace(fresh=0.0)
OFFERED = RemoteRequest(0.12, 0.7, 0.35, -1.0, 0.55)
FADING = Shares(0.5, 0.25, 0.0)
MakeRig = Callable[..., Any]


@pytest.fixture
def now(make_rig: MakeRig) -> TickContext:
    rig = make_rig()
    return rig.moment()._replace(before=BEFORE, command_before=IN_FORCE)  # type: ignore[no-any-return]


def decided(mode: Mode, entered: bool = False) -> Decision:
    return Decision(float(mode), 0.0, float(entered), 0.0, 0.0, float(entered))


@pytest.mark.parametrize(
    ("mode", "override", "target"),
    [
        (Mode.MANUAL, 0.0, (0.0, 0.0, 0.0)),
        (Mode.SHARED, 0.0, (0.8, 0.3, 0.8)),
        (Mode.AUTONOMOUS, 0.0, (1.0, 1.0, 0.0)),
        (Mode.AUTONOMOUS, 1.0, (1.0, 0.0, 0.0)),
        (Mode.TAKEOVER_REQUESTED, 1.0, (1.0, 0.0, 0.0)),
    ],
)
def test_authority_moves_by_a_step_and_arrives(
    mode: Mode, override: float, target: tuple[float, ...], control: ControlSettings
) -> None:
    control = control._replace(shared_longitudinal=0.3)
    before = BEFORE
    shares = shares_of(float(mode), override, 0.8, before, control)
    for share, was, wanted in zip(shares, (0.5, 0.25, 0.125), target, strict=True):
        step = max(-control.fade_per_tick, min(control.fade_per_tick, wanted - was))
        assert share == pytest.approx(was + step, abs=1e-15)
    for _ in range(200):
        shares = shares_of(float(mode), override, 0.8, before, control)
        before = before._replace(
            remote_lateral=shares.lateral, remote_longitudinal=shares.longitudinal, remote_guidance=shares.guidance
        )
    assert shares == pytest.approx(target, abs=1e-12)


def test_haptic_sharing_has_guidance_and_no_weight(control: ControlSettings) -> None:
    control = control._replace(shared_haptic=1.0, fade_per_tick=1.0)
    assert shares_of(float(Mode.SHARED), 0.0, 0.8, BEFORE, control) == (0.0, 0.0, 0.8)


@pytest.mark.parametrize("mode", [Mode.PARKED, Mode.MINIMAL_RISK, Mode.STOPPED, Mode.EMERGENCY_STOP])
def test_the_consoles_own_stops_have_all_authority_at_once(mode: Mode, control: ControlSettings) -> None:
    assert shares_of(float(mode), 1.0, 0.8, BEFORE, control) == (1.0, 1.0, 0.0)


def side(
    now: TickContext,
    mode: Mode,
    entered: bool = False,
    shares: Shares = FADING,
    link: Link = FRESH,
    steered: bool = False,
) -> RemoteSide:
    return remote_side(now, decided(mode, entered), shares, OFFERED, link, PERSON, steered)


def test_what_fades_out_is_what_it_contributed_to_the_command_in_force(now: TickContext) -> None:
    """0.1 in force is half of 0.15 and half of the person's 0.05; throttle a quarter of 0.9, kept at the 0.4 asked."""
    entered = side(now, Mode.MANUAL, entered=True)
    assert entered == pytest.approx((0.15, 0.4, 0.6, 0.0, 0.0, 0.0, 0.1))
    between = now._replace(command_before=IN_FORCE._replace(throttle=0.15, brake=0.1))
    assert side(between, Mode.MANUAL, entered=True)[:3] == pytest.approx((0.15, 0.3, 0.4))
    later = now._replace(memory=now.memory._replace(hold_road_wheel_rad=0.07))
    assert side(later, Mode.MANUAL) == (0.2, 0.4, 0.6, 0.0, 0.0, 0.0, 0.07)


def test_a_contribution_stays_between_what_was_asked_and_what_is_in_force(now: TickContext) -> None:
    """Whichever of both is larger, and whoever had no share contributed just what is in force."""
    before = BEFORE._replace(remote_road_wheel_rad=-0.3, remote_lateral=0.01, remote_longitudinal=0.0)
    entered = side(now._replace(before=before), Mode.MANUAL, entered=True)
    assert entered[:3] == (0.1, 0.3, 0.2)
    reverse = before._replace(remote_road_wheel_rad=0.3, remote_lateral=1.0)
    assert side(now._replace(before=reverse), Mode.MANUAL, entered=True).road_wheel_rad == pytest.approx(0.1)
    beyond = reverse._replace(remote_lateral=0.01)
    assert side(now._replace(before=beyond), Mode.MANUAL, entered=True).road_wheel_rad == 0.3
    held = now._replace(before=BEFORE._replace(remote_lateral=0.5, remote_road_wheel_rad=-0.1))
    low = held._replace(command_before=IN_FORCE._replace(road_wheel_rad=0.0))
    assert side(low, Mode.MANUAL, entered=True).road_wheel_rad == pytest.approx(-0.05)


@pytest.mark.parametrize("shares", [Shares(0.5, 0.0, 0.0), Shares(0.0, 0.5, 0.0), Shares(0.5, 0.5, 0.0)])
def test_it_fades_as_long_as_either_share_lasts(shares: Shares, now: TickContext) -> None:
    assert side(now, Mode.MANUAL, shares=shares).road_wheel_rad == 0.2


def test_with_no_share_left_it_is_shown_for_information(now: TickContext) -> None:
    nothing = Shares(0.0, 0.0, 0.0)
    hold = now.memory.hold_road_wheel_rad
    assert side(now, Mode.MANUAL, shares=nothing) == (0.12, 0.7, 0.35, -1.0, 0.0, 0.0, hold)
    assert side(now, Mode.MANUAL, shares=nothing, link=STALE) == (0.1, 0.0, 0.0, 0.0, 0.0, 0.0, hold)


@pytest.mark.parametrize("mode", [Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED])
def test_the_controller_drives_and_integrates_only_with_the_pedals_its_own(mode: Mode, now: TickContext) -> None:
    now = now._replace(memory=now.memory._replace(hold_road_wheel_rad=0.07))
    assert side(now, mode, shares=Shares(1.0, 1.0, 0.0)) == (0.12, 0.7, 0.35, -1.0, 0.55, 0.0, 0.07)
    assert side(now, mode, shares=Shares(1.0, 0.99, 0.0)).speed_integral_mps2 == 0.0
    assert side(now, mode, entered=True, shares=Shares(1.0, 1.0, 0.0)).hold_road_wheel_rad == 0.1
    assert side(now, mode, link=STALE) == (0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.07)


def test_in_shared_its_part_moves_no_faster_than_in_autonomy(now: TickContext) -> None:
    moving = now._replace(vehicle=now.vehicle._replace(vx_mps=20.0))
    s = now.settings
    shared = side(moving, Mode.SHARED, shares=Shares(0.5, 1.0, 0.5))
    jerk_step = s.automatic_lateral_jerk_mps3 * s.wheelbase_m / 400.0 * TICK_S
    assert shared.road_wheel_rad == pytest.approx(0.2 - jerk_step, abs=jerk_step * 0.05)
    assert shared.throttle == pytest.approx(0.4 + s.automatic_throttle_slew_per_s * TICK_S)
    assert shared.brake == pytest.approx(0.6 - s.automatic_brake_slew_per_s * TICK_S)
    assert (shared.direction, shared.speed_integral_mps2) == (-1.0, 0.55)
    standing = now._replace(vehicle=now.vehicle._replace(vx_mps=0.0))
    slow = side(standing, Mode.SHARED)
    assert slow.road_wheel_rad == pytest.approx(0.2 - s.automatic_road_wheel_radps * TICK_S)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_in_shared_its_angle_is_limited_as_in_autonomy(sign: float, now: TickContext) -> None:
    far = RemoteRequest(sign * 1.9, 0.0, 0.0, 1.0, 0.0)
    most = now.settings.automatic_road_wheel_rad
    at_lock = now._replace(before=BEFORE._replace(remote_road_wheel_rad=sign * most))
    held = remote_side(at_lock, decided(Mode.SHARED), FADING, far, FRESH, PERSON, False)
    assert held.road_wheel_rad == sign * most


def test_a_safe_stop_begins_with_what_is_and_goes_on_from_its_memory(now: TickContext) -> None:
    vehicle = now.vehicle._replace(vx_mps=10.0, ax_mps2=-1.0)
    memory = now.memory._replace(stop_accel_mps2=-2.0, speed_integral_mps2=0.3, hold_road_wheel_rad=0.07)
    now = now._replace(vehicle=vehicle, memory=memory)
    s, step = now.settings, now.settings.blind_stop_jerk_mps3 * TICK_S
    first = side(now, Mode.MINIMAL_RISK, entered=True)
    assert first.stop_accel_mps2 == pytest.approx(-1.0 - step)
    assert first.speed_integral_mps2 == pytest.approx(s.integral_gain_per_s * -step * TICK_S)
    decay = s.stop_road_wheel_decay_radps * TICK_S
    assert (first.road_wheel_rad, first.hold_road_wheel_rad) == (pytest.approx(0.1 - decay),) * 2
    assert first.brake == pytest.approx((-0.3 + 1.0 + step - first.speed_integral_mps2) / 8.7)
    later = side(now, Mode.MINIMAL_RISK)
    assert later.stop_accel_mps2 == pytest.approx(-2.0 - step)
    assert later.speed_integral_mps2 == pytest.approx(0.3 + s.integral_gain_per_s * (-1.0 - step) * TICK_S)
    assert (later.road_wheel_rad, later.hold_road_wheel_rad) == (pytest.approx(0.07 - decay),) * 2
    assert (later.throttle, later.direction) == (0.0, 0.0)


def test_a_steered_stop_follows_the_controller_and_brakes_by_the_book(now: TickContext) -> None:
    vehicle = now.vehicle._replace(vx_mps=10.0, ax_mps2=-1.0)
    now = now._replace(vehicle=vehicle, memory=now.memory._replace(stop_accel_mps2=-2.0))
    steered = side(now, Mode.MINIMAL_RISK, steered=True)
    assert steered.stop_accel_mps2 == pytest.approx(-2.0 - now.settings.stop_jerk_mps3 * TICK_S)
    assert (steered.road_wheel_rad, steered.hold_road_wheel_rad) == (OFFERED.road_wheel_rad,) * 2
    blind = side(now, Mode.MINIMAL_RISK)
    assert blind.stop_accel_mps2 == pytest.approx(-2.0 - now.settings.blind_stop_jerk_mps3 * TICK_S)
    assert blind.road_wheel_rad < 0.0 + 1e-12, "from what was held in memory"


def steers(
    now: TickContext,
    mode: Mode,
    before: Mode,
    reason: Reason,
    link: Link = FRESH,
    entered: bool = True,
    lost: bool = False,
) -> float:
    decision = decided(mode, entered)._replace(reason=float(reason))
    return steered_stop(now._replace(before=BEFORE._replace(mode=float(before))), decision, OFFERED, link, lost)


STOP = Mode.MINIMAL_RISK


@pytest.mark.parametrize("before", [Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED])
def test_a_controller_that_drove_steers_a_stop_that_is_not_its_fault(before: Mode, now: TickContext) -> None:
    for reason in Reason:
        expected = 1.0 if reason in (Reason.NO_REACTION, Reason.LOOP_STALL) else 0.0
        assert steers(now, STOP, before, reason) == expected
    for link in (STALE, FRESH._replace(invalid=1.0)):
        assert steers(now, STOP, before, Reason.LOOP_STALL, link) == 0.0
    assert steers(now, STOP, before, Reason.LOOP_STALL, lost=True) == 0.0
    for mode in Mode:
        if mode is not STOP:
            assert steers(now, mode, before, Reason.LOOP_STALL) == 0.0


@pytest.mark.parametrize("steered", [0.0, 1.0])
def test_who_steers_a_stop_is_decided_once(steered: float, now: TickContext) -> None:
    now = now._replace(memory=now.memory._replace(stop_steered=steered))
    assert steers(now, STOP, STOP, Reason.NO_REACTION, entered=False) == steered
    for link in (STALE, FRESH._replace(invalid=1.0)):
        assert steers(now, STOP, STOP, Reason.NO_REACTION, link, entered=False) == 0.0
    assert steers(now, STOP, STOP, Reason.NO_REACTION, entered=False, lost=True) == 0.0


@pytest.mark.parametrize("before", [Mode.MANUAL, Mode.SHARED])
def test_a_controller_that_did_not_drive_steers_it_if_it_is_steady_and_agrees(before: Mode, now: TickContext) -> None:
    """OFFERED asks for 0.12 rad, 0.1 rad is in force: 2 m/s2 apart at 16.06 m/s."""
    steady = FRESH._replace(fresh_ticks=now.settings.engage_stable_ticks)
    unsteady = FRESH._replace(fresh_ticks=now.settings.engage_stable_ticks - 1.0)
    apart = (math.tan(0.12) - math.tan(0.1)) / now.settings.wheelbase_m
    bound_mps = math.sqrt(now.settings.stop_steering_apart_mps2 / apart)
    near = now._replace(vehicle=now.vehicle._replace(vx_mps=bound_mps - 1e-6))
    far = now._replace(vehicle=now.vehicle._replace(vx_mps=bound_mps + 1e-6))
    for reason in (Reason.DEVICE_LOST, Reason.LOOP_STALL):
        assert steers(near, STOP, before, reason, steady) == 1.0
        assert steers(near, STOP, before, reason, unsteady) == 0.0
        assert steers(far, STOP, before, reason, steady) == 0.0
        assert steers(near, STOP, before, reason, steady._replace(fresh=0.0)) == 0.0
        assert steers(near, STOP, before, reason, steady._replace(invalid=1.0)) == 0.0


def test_agreeing_to_the_last_bit_is_agreeing(now: TickContext) -> None:
    vehicle = now.vehicle._replace(vx_mps=10.0)
    apart = lateral_apart(OFFERED.road_wheel_rad, IN_FORCE.road_wheel_rad, vehicle, now.settings)
    same = now._replace(vehicle=vehicle, settings=now.settings._replace(stop_steering_apart_mps2=apart))
    assert steers(same, STOP, Mode.MANUAL, Reason.DEVICE_LOST, FRESH._replace(fresh_ticks=1e3)) == 1.0


@pytest.mark.parametrize(("mode", "brake"), [(Mode.EMERGENCY_STOP, 1.0), (Mode.STOPPED, 0.4), (Mode.PARKED, 0.4)])
def test_stops_hold_the_wheels_and_brake(mode: Mode, brake: float, now: TickContext) -> None:
    now = now._replace(memory=now.memory._replace(hold_road_wheel_rad=0.07))
    assert side(now, mode) == (0.07, 0.0, brake, 0.0, 0.0, 0.0, 0.07)
    assert side(now, mode, entered=True) == (0.1, 0.0, brake, 0.0, 0.0, 0.0, 0.1)


def lever(
    now: TickContext, mode: Mode, gear: float = 2.0, clutch: float = 0.3, automatic: float = 0.0, **own: float
) -> Any:
    driver = now.driver._replace(gear=gear, clutch=clutch)
    command = IN_FORCE._replace(gear=own.pop("in_force", 1.0), automatic=automatic)
    vehicle = now.vehicle._replace(gear=own.pop("engaged", 3.0))
    changed = now._replace(
        driver=driver, command_before=command, vehicle=vehicle, settings=now.settings._replace(**own)
    )
    return transmission_of(changed, float(mode), -1.0)


def test_who_works_clutch_and_gears(now: TickContext) -> None:
    assert lever(now, Mode.PARKED) == (0.0, 0.0, 0.0)
    assert lever(now, Mode.STOPPED) == (0.0, 0.0, 1.0)
    for mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED):
        assert lever(now, mode) == (0.0, -1.0, 1.0)
    for mode in (Mode.MINIMAL_RISK, Mode.EMERGENCY_STOP):
        assert lever(now, mode, automatic=1.0, in_force=-1.0) == (0.0, -1.0, 1.0)
        assert lever(now, mode) == (0.0, 1.0, 1.0)
        assert lever(now, mode, engaged=1.0) == (0.0, 1.0, 1.0)
        assert lever(now, mode, engaged=0.0) == (0.0, 0.0, 1.0)
        assert lever(now, mode, engaged=-1.0) == (0.0, -1.0, 1.0)
    for mode in (Mode.MANUAL, Mode.SHARED):
        assert lever(now, mode) == (0.3, 2.0, 0.0)
        assert lever(now, mode, manual_automatic=1.0) == (0.0, 1.0, 1.0)
        assert lever(now, mode, gear=-1.0, manual_automatic=1.0) == (0.0, -1.0, 1.0)
        assert lever(now, mode, gear=0.0, manual_automatic=1.0) == (0.0, 0.0, 1.0)


def test_the_persons_clutch_takes_the_gears_back(now: TickContext) -> None:
    pressed = now.settings.clutch_pressed
    assert lever(now, Mode.MANUAL, automatic=1.0, clutch=pressed - 0.01, in_force=-1.0) == (0.0, -1.0, 1.0)
    assert lever(now, Mode.MANUAL, automatic=1.0, clutch=pressed) == (pressed, 2.0, 0.0)
    assert lever(now, Mode.MANUAL, automatic=0.0, clutch=0.1) == (0.1, 2.0, 0.0)


def test_in_shared_the_car_shifts_only_if_the_controller_has_pedals(now: TickContext) -> None:
    assert lever(now, Mode.SHARED, shared_longitudinal=0.01) == (0.0, -1.0, 1.0)
    assert lever(now, Mode.MANUAL, shared_longitudinal=0.01) == (0.3, 2.0, 0.0)
    assert lever(now, Mode.SHARED, shared_longitudinal=0.0) == (0.3, 2.0, 0.0)


def test_the_blend_weighs_both_and_the_persons_brake_counts_in_full(now: TickContext) -> None:
    asked = RemoteSide(0.2, 0.8, 0.1, 1.0, 0.0, 0.0, 0.0)
    person = Person(1.0, 1.0, -0.1, 0.4, 0.05, 0.4)
    shift = Transmission(0.2, 3.0, 1.0)
    driver = now.driver._replace(handbrake=0.6)

    def blended(mode: Mode, person: Person = person) -> Request:
        return blend(float(mode), Shares(0.25, 0.75, 0.0), asked, person, shift, Lights(-1.0, 1.0), driver)

    assert blended(Mode.AUTONOMOUS) == pytest.approx((-0.025, 0.7, 0.0875, 0.2, 0.0, 3.0, 1.0, -1.0, 1.0))
    assert blended(Mode.AUTONOMOUS, person._replace(brake=0.9)).brake == 0.9
    for mode in Mode:
        handbrake = {Mode.PARKED: 1.0, Mode.STOPPED: 1.0, Mode.MANUAL: 0.6, Mode.SHARED: 0.6}.get(mode, 0.0)
        assert blended(mode).handbrake == handbrake
