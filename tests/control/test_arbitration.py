"""Hand-overs and shared control as a person and an operator live them."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.control.gate import limits_of
from simconsole.profiles.control import ControlProfile
from simconsole.values.signals import Event, GateLimit, Mode, Reason, RemoteKind, Validity

MakeRig = Callable[..., Any]


def steps(rig: Any, seconds: float) -> tuple[float, float, float]:
    """Run, and return the largest step of road wheel, brake and (upward) throttle."""
    wheel = brake = throttle = 0.0
    for _ in range(round(seconds * rig.tick_hz)):
        before = rig.command
        rig.tick()
        wheel = max(wheel, abs(rig.command.road_wheel_rad - before.road_wheel_rad))
        brake = max(brake, abs(rig.command.brake - before.brake))
        throttle = max(throttle, rig.command.throttle - before.throttle)
    return wheel, brake, throttle


def test_parked_holds_until_every_control_is_ready(make_rig: MakeRig) -> None:
    rig = make_rig()
    rig.driver = rig.driver._replace(throttle_validity=float(Validity.UNKNOWN))
    rig.run(1.0)
    assert rig.mode is Mode.PARKED
    assert (rig.command.brake, rig.command.handbrake, rig.command.gear, rig.command.throttle) == (0.4, 1.0, 0.0, 0.0)
    rig.driver = rig.driver._replace(throttle_validity=float(Validity.ARMED), throttle=0.3)
    rig.run(0.1)
    assert rig.mode is Mode.PARKED
    rig.tick(Event.REQUEST_MANUAL)
    assert (rig.mode, rig.refusal) == (Mode.PARKED, Reason.REFUSED_THROTTLE_PRESSED)
    rig.driver = rig.driver._replace(throttle=0.04)
    rig.tick()
    assert (rig.mode, rig.reason, rig.refusal) == (Mode.MANUAL, Reason.ARMED, None)


def test_manual_is_the_person_alone(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig.send(road_wheel_rad=-0.2, accel_mps2=2.0)
    rig.driver = rig.driver._replace(hand_wheel_rad=1.5, throttle=0.4, clutch=0.9, gear=2.0, handbrake=0.2)
    rig.run(0.5)
    command = rig.command
    assert command.road_wheel_rad == pytest.approx(0.1)
    assert (command.throttle, command.clutch, command.gear, command.handbrake, command.automatic) == (
        0.4,
        0.9,
        2.0,
        0.2,
        0.0,
    )
    assert (rig.arbitration.remote_lateral, rig.arbitration.remote_longitudinal) == (0.0, 0.0)
    # What the controller would ask for is shown all the same.
    assert rig.arbitration.remote_road_wheel_rad == -0.2
    assert rig.arbitration.remote_throttle > 0.0
    rig.driver = rig.driver._replace(brake=0.3)
    rig.tick()
    assert (rig.arbitration.person_throttle, rig.command.throttle) == (0.0, 0.0)


def test_autonomy_takes_over_without_a_jump(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig.driver = rig.driver._replace(throttle=0.2)
    rig.run(0.2)
    rig.send(road_wheel_rad=0.1, accel_mps2=-1.0)
    rig.run(0.2)
    rig.driver = rig.driver._replace(throttle=0.0)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert rig.mode is Mode.AUTONOMOUS
    shares = []
    for _ in range(160):
        shares.append(rig.arbitration.remote_lateral)
        before = rig.command.road_wheel_rad
        rig.tick()
        assert rig.command.road_wheel_rad - before <= 0.1 / 150 + 1e-12
    assert shares[0] == pytest.approx(1 / 150)
    assert shares[149:] == [1.0] * 11
    assert rig.command.road_wheel_rad == pytest.approx(0.1)
    assert (rig.command.automatic, rig.command.gear) == (1.0, 1.0)


def test_a_person_takes_back_without_a_jump(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    rig.send(road_wheel_rad=0.2, accel_mps2=1.0)
    rig.run(1.0)
    rig.driver = rig.driver._replace(hand_wheel_rad=math.radians(-10.0))
    in_force = rig.command.road_wheel_rad
    assert 0.05 < in_force < 0.19  # the gate held the controller back: the hand-over starts from there
    rig.until(Mode.MANUAL)
    wheel, brake, throttle = steps(rig, 0.7)
    assert wheel <= (in_force + math.radians(10.0) / 15.0) / 150 + 1e-12
    assert brake == 0.0
    assert throttle <= 0.0
    assert rig.command.road_wheel_rad == pytest.approx(math.radians(-10.0) / 15.0)
    assert rig.command.throttle == 0.0


def test_what_the_controller_sends_after_the_takeover_has_no_effect(make_rig: MakeRig) -> None:
    rigs = [make_rig().drive(Mode.AUTONOMOUS) for _ in range(2)]
    for rig in rigs:
        rig.send(road_wheel_rad=0.2, accel_mps2=0.5)
        rig.run(1.0)
        rig.tick(Event.REQUEST_MANUAL)
    rigs[0].send(road_wheel_rad=-0.6, accel_mps2=5.0)
    rigs[1].remote = rigs[1].remote._replace(road_wheel_rad=math.nan)
    for rig in rigs:
        rig.run(0.3)
    assert rigs[0].command[:7] == rigs[1].command[:7]


def test_the_persons_brake_counts_in_full_in_every_mode(make_rig: MakeRig) -> None:
    for mode in Mode:
        rig = make_rig().drive(mode)
        rig.driver = rig.driver._replace(brake=0.8, brake_validity=float(Validity.LIVE))
        rig.run(0.3)
        assert rig.command.brake >= 0.8, mode


def test_brake_release_at_the_takeover_is_gradual(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    rig.send(accel_mps2=-4.0)
    rig.run(0.8)
    braking = rig.command.brake
    assert braking > 0.3
    rig.tick(Event.REQUEST_MANUAL)
    assert braking - rig.command.brake <= braking / 150 + 1e-9
    rig.run(0.7)
    assert rig.command.brake == 0.0


def test_the_car_shifts_on_until_the_persons_clutch_takes_over(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    rig.driver = rig.driver._replace(gear=3.0, brake=0.1)
    rig.run(0.5)
    assert (rig.mode, rig.command.automatic, rig.command.gear) == (Mode.MANUAL, 1.0, 1.0)
    rig.driver = rig.driver._replace(clutch=1.0)
    rig.run(0.1)
    assert (rig.command.automatic, rig.command.gear, rig.command.clutch) == (0.0, 3.0, 1.0)
    rig.driver = rig.driver._replace(clutch=0.0)
    rig.run(0.1)
    assert (rig.command.automatic, rig.command.gear, rig.command.clutch) == (0.0, 3.0, 0.0)


@pytest.mark.parametrize(("lever", "direction"), [(3.0, 1.0), (0.0, 0.0), (-1.0, -1.0)])
def test_a_cockpit_without_clutch_drives_by_direction(lever: float, direction: float, make_rig: MakeRig) -> None:
    rig = make_rig(profile=ControlProfile(manual_automatic=True))
    rig.driver = rig.driver._replace(gear=lever, clutch=1.0)
    rig.run(0.1)
    assert (rig.mode, rig.command.automatic, rig.command.gear) == (Mode.MANUAL, 1.0, direction)
    assert rig.command.clutch == 0.0


def test_a_lost_wheel_in_autonomy_can_come_back_and_be_used(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.LOST))
    rig.run(2.0)
    assert rig.mode is Mode.TAKEOVER_REQUESTED
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.ARMED), hand_wheel_rad=1.0)
    rig.run(1.0)
    assert rig.mode is Mode.TAKEOVER_REQUESTED
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert rig.mode is Mode.AUTONOMOUS
    rig.driver = rig.driver._replace(hand_wheel_rad=1.2)
    rig.run(0.1)
    assert rig.mode is Mode.MANUAL


def test_a_drive_without_a_person_engages_from_parked_and_again_after_a_stop(make_rig: MakeRig) -> None:
    rig = make_rig(100, ControlProfile(person_required=False)).drive(Mode.PARKED)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert (rig.mode, rig.refusal) == (Mode.PARKED, Reason.REFUSED_NO_COMMAND)
    rig.send(RemoteKind.POSE, x_m=3.0, speed_mps=1.0)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert (rig.mode, rig.refusal) == (Mode.PARKED, Reason.REFUSED_NOT_STABLE)
    rig.run(0.2)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert rig.mode is Mode.AUTONOMOUS
    rig.run(1.0)
    assert (rig.command.target_speed_mps, rig.command.target_x_m, rig.command.brake) == (1.0, 3.0, 0.0)
    rig.vehicle = rig.vehicle._replace(vx_mps=1.5)
    rig.sending = False
    rig.run(0.3)
    assert rig.mode is Mode.MINIMAL_RISK
    rig.run(2.0)
    assert (rig.mode, rig.command.target_speed_mps) == (Mode.STOPPED, 0.0)
    rig.send(RemoteKind.POSE, x_m=5.0, speed_mps=1.0)
    rig.run(0.5)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert (rig.mode, rig.refusal) == (Mode.STOPPED, Reason.REFUSED_NOT_STABLE)
    rig.run(0.6)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert rig.mode is Mode.AUTONOMOUS


def test_shared_control_blends_with_fixed_authority(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.SHARED)
    rig.send(road_wheel_rad=0.05, accel_mps2=1.0)
    rig.driver = rig.driver._replace(hand_wheel_rad=1.5, throttle=0.3, gear=2.0)
    rig.run(1.0)
    assert rig.mode is Mode.SHARED
    assert rig.command.road_wheel_rad == pytest.approx(0.075)
    assert (rig.command.throttle, rig.command.gear, rig.command.automatic) == (0.3, 2.0, 0.0)


def test_shared_pedals_leave_the_gears_to_the_car(make_rig: MakeRig) -> None:
    rig = make_rig(profile=ControlProfile(shared_longitudinal=0.5)).drive(Mode.SHARED)
    rig.send(accel_mps2=1.35)
    rig.driver = rig.driver._replace(throttle=0.3, gear=2.0)
    rig.run(1.0)
    assert rig.command.throttle == pytest.approx(0.4)
    assert (rig.command.gear, rig.command.automatic) == (1.0, 1.0)


def test_throttle_that_autonomy_was_still_building_up_is_not_finished_after_the_takeover(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    rig.run(1.0)
    rig.send(RemoteKind.ACTUATION, throttle=1.0)
    rig.run(0.05)
    in_force = rig.command.throttle
    assert 0.1 < in_force < 0.4
    rig.tick(Event.REQUEST_MANUAL)
    assert rig.command.throttle < in_force
    assert steps(rig, 0.7)[2] <= 0.0
    assert rig.command.throttle == 0.0


def test_in_shared_control_the_controllers_part_is_limited_as_in_autonomy(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.SHARED, speed_mps=20.0)
    rig.run(1.0)
    rig.send(road_wheel_rad=0.05, accel_mps2=5.0)
    wheel, _, _ = steps(rig, 1.0)
    assert wheel <= rig.settings.automatic_road_wheel_radps * rig.tick_s
    assert rig.arbitration.remote_road_wheel_rad < math.atan(5.0 * 2.6 / 19.0**2)
    assert rig.arbitration.remote_throttle == 1.0


@pytest.mark.fault("R13")
@pytest.mark.parametrize("tick_hz", [50, 250, 1000])
def test_toggling_at_50_hz_never_jumps_and_never_locks_up(tick_hz: int, make_rig: MakeRig) -> None:
    """For 10 s; no step is larger than the limit of the mode in force."""
    rig = make_rig(tick_hz).drive(Mode.MANUAL)
    rig.send(road_wheel_rad=0.1, accel_mps2=1.0)
    rig.driver = rig.driver._replace(hand_wheel_rad=-1.0)
    rig.run(1.0)
    period = tick_hz // 50
    changes = 0
    for tick in range(10 * tick_hz):
        before, mode = rig.command, rig.mode
        toggle = Event.REQUEST_MANUAL if tick // period % 2 else Event.REQUEST_AUTONOMOUS
        rig.tick(toggle if tick % period == 0 else 0)
        changes += rig.mode is not mode
        limits, step = limits_of(float(rig.mode), rig.settings), rig.tick_s
        assert abs(rig.command.road_wheel_rad - before.road_wheel_rad) <= limits.road_wheel_radps * step + 1e-12
        assert rig.command.throttle - before.throttle <= limits.throttle_slew_per_s * step + 1e-12
        assert abs(rig.command.brake - before.brake) <= limits.brake_slew_per_s * step + 1e-12
        assert abs(rig.command.target_speed_mps - before.target_speed_mps) <= limits.target_accel_mps2 * step + 1e-12
        hand_step = rig.settings.manual_pedal_slew_per_s * step + 1e-12
        for name in ("throttle", "clutch", "handbrake"):
            assert abs(getattr(rig.command, name) - getattr(before, name)) <= hand_step
    assert changes == 500
    rig.tick(Event.REQUEST_MANUAL)
    rig.run(0.7)
    assert rig.command.road_wheel_rad == pytest.approx(-1.0 / 15.0)


def test_values_that_are_no_numbers_from_the_cockpit_are_a_lost_cockpit(make_rig: MakeRig) -> None:
    for field in ("hand_wheel_rad", "throttle", "brake"):
        rig = make_rig().drive(Mode.MANUAL)
        rig.driver = rig.driver._replace(**{field: math.nan})
        rig.tick()
        assert (rig.mode, rig.reason) == (Mode.MINIMAL_RISK, Reason.DEVICE_LOST)
        assert all(math.isfinite(value) for value in (*rig.memory, *rig.arbitration, *rig.command))
    rig = make_rig().drive(Mode.MANUAL)
    rig.driver = rig.driver._replace(clutch=math.nan, gear=math.nan, pressed=0.0, handbrake=math.inf)
    rig.tick()
    assert GateLimit.NON_FINITE in GateLimit(int(rig.command.gate_active))
    assert all(math.isfinite(value) for value in (*rig.memory, *rig.arbitration, *rig.command))


def test_with_the_wheel_lost_the_brake_still_brakes_and_the_controller_steers_on(make_rig: MakeRig) -> None:
    """The person cannot have the car back without a wheel; the request to take over stays until there is one."""
    rig = make_rig().drive(Mode.AUTONOMOUS)
    rig.send(road_wheel_rad=0.05, accel_mps2=1.0)
    rig.run(1.0)
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.LOST), brake=0.6)
    rig.tick()
    rig.tick()
    assert (rig.mode, rig.reason) == (Mode.TAKEOVER_REQUESTED, Reason.DEVICE_LOST)
    assert rig.command.throttle == 0.0
    rig.run(0.2)
    assert rig.command.brake == 0.6
    assert rig.command.road_wheel_rad == pytest.approx(0.05)
    rig.driver = rig.driver._replace(brake=0.0)
    rig.run(0.5)
    assert (rig.mode, rig.command.brake) == (Mode.TAKEOVER_REQUESTED, 0.0)
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.LIVE), brake=0.6)
    rig.tick()
    assert (rig.mode, rig.reason) == (Mode.MANUAL, Reason.BRAKE_OVERRIDE)
