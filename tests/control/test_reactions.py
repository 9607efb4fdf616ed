"""How fast, on the simulated clock: from the first tick that carries a fact to the changed output."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.values.signals import Event, Mode, Reason, RemoteKind, Validity

RATES = [50, 250, 1000]
AUTONOMOUS = [Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED]
BY_PERSON = [*AUTONOMOUS, Mode.MINIMAL_RISK]


def ticks_until(rig: Any, mode: Mode, limit: int = 2000) -> int:
    for count in range(1, limit):
        rig.tick()
        if rig.mode is mode:
            return count
    raise AssertionError(f"still {rig.mode.name}")


@pytest.mark.parametrize("tick_hz", RATES)
@pytest.mark.parametrize("mode", [mode for mode in Mode if mode is not Mode.EMERGENCY_STOP])
def test_emergency_stop_leaves_the_gate_in_the_same_tick(
    mode: Mode, tick_hz: int, make_rig: Callable[..., Any]
) -> None:
    rig = make_rig(tick_hz).drive(mode)
    road_wheel = rig.command.road_wheel_rad
    rig.tick(Event.EMERGENCY_STOP)
    assert rig.mode is Mode.EMERGENCY_STOP
    assert rig.command.throttle == 0.0
    assert rig.command.road_wheel_rad == road_wheel
    assert rig.command.brake == 1.0


@pytest.mark.parametrize("tick_hz", RATES)
@pytest.mark.parametrize("mode", BY_PERSON)
def test_the_brake_takes_over_within_two_ticks(mode: Mode, tick_hz: int, make_rig: Callable[..., Any]) -> None:
    rig = make_rig(tick_hz).drive(mode)
    rig.driver = rig.driver._replace(brake=0.05)
    assert ticks_until(rig, Mode.MANUAL) <= 2
    assert rig.reason is Reason.BRAKE_OVERRIDE
    rig.tick()
    assert rig.command.brake >= 0.05 - 1e-9
    assert rig.command.throttle == 0.0


@pytest.mark.parametrize("tick_hz", RATES)
@pytest.mark.parametrize("mode", Mode)
def test_the_brake_acts_from_the_next_tick_on_in_every_mode(
    mode: Mode, tick_hz: int, make_rig: Callable[..., Any]
) -> None:
    """Also where the mode stays: an emergency stop, a stop that stands, and shared control brake no less for it."""
    rig = make_rig(tick_hz).drive(mode)
    rig.run(0.2)
    live = dict.fromkeys(("wheel_validity", "throttle_validity", "brake_validity"), float(Validity.LIVE))
    rig.driver = rig.driver._replace(brake=0.9, **live)
    braking = rig.command.brake
    rig.tick()
    rig.tick()
    assert rig.command.brake > braking or braking >= 0.9
    assert rig.command.throttle == 0.0


@pytest.mark.parametrize("tick_hz", RATES)
@pytest.mark.parametrize("mode", AUTONOMOUS)
def test_the_accelerator_overrides_pedals_only_within_two_ticks(
    mode: Mode, tick_hz: int, make_rig: Callable[..., Any]
) -> None:
    rig = make_rig(tick_hz).drive(mode)
    rig.run(0.7)
    rig.driver = rig.driver._replace(throttle=0.5)
    rig.tick()
    assert rig.mode is mode
    assert rig.arbitration.remote_longitudinal < 1.0
    assert rig.arbitration.remote_lateral == 1.0
    rig.run(0.7)
    assert (rig.arbitration.remote_longitudinal, rig.command.throttle) == (0.0, 0.5)
    rig.driver = rig.driver._replace(throttle=0.0)
    rig.run(0.7)
    assert rig.arbitration.remote_longitudinal == 1.0
    assert rig.mode is mode


@pytest.mark.parametrize("tick_hz", RATES)
@pytest.mark.parametrize("mode", BY_PERSON)
def test_the_wheel_takes_over_after_50_ms_and_a_tick(mode: Mode, tick_hz: int, make_rig: Callable[..., Any]) -> None:
    rig = make_rig(tick_hz).drive(mode)
    rig.tick()
    rig.driver = rig.driver._replace(hand_wheel_rad=math.radians(-8.5))
    assert ticks_until(rig, Mode.MANUAL) <= math.ceil(0.05 * tick_hz) + 1
    assert rig.reason is Reason.STEERING_OVERRIDE


@pytest.mark.parametrize("tick_hz", RATES)
def test_a_lost_device_counts_in_the_tick_that_names_it_stale(tick_hz: int, make_rig: Callable[..., Any]) -> None:
    # calibrate names it stale after 100 ms (tests/devices); here nothing may be added.
    after = {
        Mode.MANUAL: Mode.MINIMAL_RISK,
        Mode.SHARED: Mode.MINIMAL_RISK,
        Mode.AUTONOMOUS: Mode.TAKEOVER_REQUESTED,
    }
    for field in ("wheel_validity", "throttle_validity", "brake_validity"):
        for mode in after:
            rig = make_rig(tick_hz).drive(mode)
            rig.driver = rig.driver._replace(**{field: float(Validity.STALE)})
            rig.tick()
            assert (rig.mode, rig.reason) == (after[mode], Reason.DEVICE_LOST)


@pytest.mark.parametrize("tick_hz", RATES)
@pytest.mark.parametrize("mode", [Mode.MANUAL, Mode.SHARED, *AUTONOMOUS])
def test_a_loop_that_stood_still_is_a_safe_stop_in_the_same_tick(
    mode: Mode, tick_hz: int, make_rig: Callable[..., Any]
) -> None:
    rig = make_rig(tick_hz).drive(mode)
    rig.tick(Event.LOOP_STALL)
    assert (rig.mode, rig.reason) == (Mode.MINIMAL_RISK, Reason.LOOP_STALL)


@pytest.mark.parametrize("tick_hz", RATES)
@pytest.mark.parametrize("mode", [*AUTONOMOUS, Mode.SHARED])
def test_a_silent_controller_is_left_within_210_ms(mode: Mode, tick_hz: int, make_rig: Callable[..., Any]) -> None:
    rig = make_rig(tick_hz).drive(mode)
    rig.send(RemoteKind.SPEED, speed_mps=10.0)
    while rig.remote.age_ticks != 0.0:
        rig.tick()
    rig.sending = False
    after = Mode.MANUAL if mode is Mode.SHARED else Mode.MINIMAL_RISK
    assert 0.19 < ticks_until(rig, after) * rig.tick_s <= 0.21
    assert rig.reason is Reason.COMMAND_STALE
    if mode is not Mode.SHARED:
        brake = rig.command.brake
        rig.run(0.5)
        assert rig.command.brake > brake


@pytest.mark.parametrize("tick_hz", RATES)
def test_a_command_150_ms_late_but_steady_is_good(tick_hz: int, make_rig: Callable[..., Any]) -> None:
    rig = make_rig(tick_hz).drive(Mode.AUTONOMOUS)
    rig.period_ticks = round(0.15 * tick_hz)
    rig.run(5.0)
    assert rig.mode is Mode.AUTONOMOUS


@pytest.mark.parametrize("tick_hz", RATES)
def test_five_refused_commands_in_a_row_end_autonomy(tick_hz: int, make_rig: Callable[..., Any]) -> None:
    rig = make_rig(tick_hz).drive(Mode.AUTONOMOUS)
    rig.sending = False
    for count in range(5):
        assert rig.mode is Mode.AUTONOMOUS, count
        rig.refuse()
        rig.tick()
    assert (rig.mode, rig.reason) == (Mode.MINIMAL_RISK, Reason.COMMAND_INVALID)


def test_refused_commands_between_good_ones_do_not(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    for _ in range(100):
        rig.refuse(4)
        rig.run(0.02)
    assert rig.mode is Mode.AUTONOMOUS


@pytest.mark.parametrize("tick_hz", RATES)
def test_a_command_that_is_no_number_ends_autonomy_at_once(tick_hz: int, make_rig: Callable[..., Any]) -> None:
    rig = make_rig(tick_hz).drive(Mode.AUTONOMOUS)
    rig.remote = rig.remote._replace(road_wheel_rad=math.nan)
    rig.tick()
    assert (rig.mode, rig.reason) == (Mode.MINIMAL_RISK, Reason.COMMAND_INVALID)
    assert all(math.isfinite(value) for value in (*rig.memory, *rig.arbitration, *rig.command))


@pytest.mark.parametrize("tick_hz", RATES)
def test_a_takeover_request_escalates_and_ends_in_a_stop(tick_hz: int, make_rig: Callable[..., Any]) -> None:
    rig = make_rig(tick_hz).drive(Mode.TAKEOVER_REQUESTED)
    assert rig.arbitration.takeover_stage == 1.0
    ticks = 0
    while rig.arbitration.takeover_stage == 1.0:
        rig.tick()
        ticks += 1
    assert (ticks, rig.arbitration.takeover_stage) == (4 * tick_hz, 2.0)
    assert rig.mode is Mode.TAKEOVER_REQUESTED
    assert ticks + ticks_until(rig, Mode.MINIMAL_RISK, 7 * tick_hz) == 10 * tick_hz
    assert (rig.reason, rig.arbitration.takeover_stage) == (Reason.NO_REACTION, 0.0)
    rig.until(Mode.STOPPED, 20 * tick_hz)
    assert rig.reason is Reason.STANDSTILL


def test_no_answer_in_lockstep_ends_autonomy_at_once(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    rig.tick(Event.NO_ANSWER)
    assert (rig.mode, rig.reason) == (Mode.MINIMAL_RISK, Reason.COMMAND_STALE)
