import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.control.modes.takeover import (
    WheelWatch,
    steering_taken,
    throttle_held,
    throttle_overrides,
    watch_wheel,
)
from simconsole.control.requests.control_settings import ControlSettings, settings
from simconsole.profiles.control import ControlProfile
from simconsole.values.signals import Event, Mode, Notice

RATES = [50, 100, 125, 200, 250, 500, 1000]
START = WheelWatch(0.0, 0.0)


def taken_after_s(angle_of_time: object, tick_hz: int, seconds: float, phase: float = 0.0) -> float | None:
    """Sample a motion of the wheel (rad over s) at a tick rate; return when it counts as a take-over."""
    s = settings(ControlProfile(), 15.0, 0.6, 2.6, tick_hz)
    watch, previous = START, 0.0
    for tick in range(round(seconds * tick_hz)):
        time_s = (tick + phase) / tick_hz
        angle = angle_of_time(time_s)  # type: ignore[operator]
        watch = watch_wheel(watch, angle, (angle - previous) * tick_hz, 0.0, 0.0, True, True, s)
        previous = angle
        if steering_taken(watch, s):
            return time_s
    return None


def held(angle_deg: float, from_s: float, for_s: float, ramp_s: float = 0.3) -> object:
    """Turn slowly to an angle, hold it, turn slowly back: the speed never counts."""

    def angle(time_s: float) -> float:
        up = min(1.0, max(0.0, (time_s - from_s + ramp_s) / ramp_s))
        down = min(1.0, max(0.0, (time_s - from_s - for_s) / ramp_s))
        return math.radians(angle_deg) * (up - down)

    return angle


def pulse(angle_deg: float, from_s: float, for_s: float) -> object:
    return lambda time_s: math.radians(angle_deg) if from_s <= time_s < from_s + for_s else 0.0


@pytest.mark.parametrize("tick_hz", RATES)
@pytest.mark.parametrize("phase", [0.0, 0.37, 0.9])
def test_a_held_turn_is_a_takeover_at_every_rate(tick_hz: int, phase: float) -> None:
    after = taken_after_s(held(9.0, 1.0, 1.0), tick_hz, 3.0, phase)
    assert after is not None
    crossing_s = 1.0 - 0.3 / 9.0  # where the ramp passes 8 deg
    assert crossing_s + 0.05 <= after + 1e-9
    assert after <= crossing_s + 0.05 + 2.0 / tick_hz


@pytest.mark.parametrize("tick_hz", RATES)
@pytest.mark.parametrize("phase", [0.0, 0.37, 0.9])
def test_short_knocks_and_small_turns_are_none_at_any_rate(tick_hz: int, phase: float) -> None:
    assert taken_after_s(held(7.9, 1.0, 5.0, ramp_s=1.0), tick_hz, 8.0, phase) is None
    assert taken_after_s(pulse(7.0, 1.0, 0.02), tick_hz, 2.0, phase) is None


@pytest.mark.parametrize("tick_hz", RATES)
def test_a_fast_hand_is_a_takeover_before_the_angle_is_reached(tick_hz: int) -> None:
    # 70 deg/s for 100 ms is 7 deg: below the angle, above the speed, for longer than 50 ms.
    after = taken_after_s(lambda t: math.radians(min(7.0, max(0.0, 70.0 * (t - 1.0)))), tick_hz, 2.0)
    assert after is not None
    assert after <= 1.0 + 0.05 + 2.0 / tick_hz
    assert taken_after_s(lambda t: math.radians(min(7.0, max(0.0, 50.0 * (t - 1.0)))), tick_hz, 2.0) is None


def test_a_shaking_hand_near_the_threshold_counts_on() -> None:
    assert taken_after_s(lambda t: math.radians(7.6 + 0.5 * math.sin(6.0 * t)), 250, 10.0) is not None


def test_the_reference_follows_while_nobody_can_take_over(control: ControlSettings) -> None:
    watch = watch_wheel(START, 1.0, 0.0, 0.0, 0.0, False, True, control)
    assert watch == WheelWatch(1.0, 0.0)
    assert watch_wheel(watch, 1.1, 0.0, 0.0, 0.0, True, True, control) == WheelWatch(1.0, 0.0)
    assert watch_wheel(watch, 1.2, 0.0, 0.0, 0.0, True, True, control).past_ticks == 1.0
    assert watch_wheel(WheelWatch(1.0, 5.0), 1.0, 0.0, 0.0, 0.0, True, True, control).past_ticks == 0.0


def test_a_wheel_that_comes_back_elsewhere_is_no_takeover(control: ControlSettings) -> None:
    watch = watch_wheel(START, 2.0, 9.9, 0.0, 0.0, True, False, control)
    assert watch == WheelWatch(0.0, -1.0)
    watch = watch_wheel(watch, 2.0, 0.0, 0.0, 0.0, True, True, control)
    assert watch == WheelWatch(2.0, 0.0)
    assert watch_wheel(watch, 2.0, 0.0, 0.0, 0.0, True, True, control).past_ticks == 0.0


def test_what_the_motor_explains_is_not_the_persons(control: ControlSettings) -> None:
    assert watch_wheel(START, 1.0, 0.0, 1.0, 0.0, True, True, control).past_ticks == 0.0
    assert watch_wheel(START, 1.2, 0.0, 1.0, 0.0, True, True, control).past_ticks == 1.0
    assert watch_wheel(START, 1.2, 0.0, 1.0, 0.0, False, True, control) == (pytest.approx(0.2), 0.0)


def test_a_wheel_that_reports_no_number_is_no_takeover(control: ControlSettings) -> None:
    assert watch_wheel(START, 0.0, math.nan, 0.0, 0.0, True, True, control).past_ticks == 0.0


def test_the_accelerator_overrides_with_hysteresis(control: ControlSettings) -> None:
    pressed = [throttle_overrides(0.0, throttle, control) for throttle in (0.0, 0.04, 0.05, 1.0)]
    assert pressed == [0.0, 0.0, 1.0, 1.0]
    assert [throttle_overrides(1.0, throttle, control) for throttle in (0.045, 0.03, 0.0)] == [1.0, 0.0, 0.0]
    always = control._replace(throttle_release=0.0)
    assert throttle_overrides(1.0, 0.0, always) == 0.0


@pytest.mark.parametrize("mode", Mode)
def test_an_override_is_only_held_over_a_controller_that_drives(mode: Mode) -> None:
    driven = mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED)
    assert throttle_held(7.0, 1.0, float(mode)) == (8.0 if driven else 0.0)
    assert throttle_held(7.0, 0.0, float(mode)) == 0.0


@pytest.mark.parametrize("tick_hz", [50, 250, 1000])
def test_an_accelerator_held_for_more_than_five_seconds_is_told_until_it_is_released(
    tick_hz: int, make_rig: Callable[..., Any]
) -> None:
    rig = make_rig(tick_hz).drive(Mode.AUTONOMOUS)
    rig.driver = rig.driver._replace(throttle=0.5)
    for _ in range(5 * tick_hz):
        rig.tick()
        assert (rig.mode, rig.arbitration.notice) == (Mode.AUTONOMOUS, Notice.NONE)
    rig.tick()
    assert (rig.mode, rig.arbitration.notice) == (Mode.AUTONOMOUS, Notice.THROTTLE_HELD)
    rig.tick(Event.REQUEST_TAKEOVER)
    assert (rig.mode, rig.arbitration.notice) == (Mode.TAKEOVER_REQUESTED, Notice.THROTTLE_HELD)
    rig.driver = rig.driver._replace(throttle=0.0)
    rig.tick()
    assert (rig.arbitration.notice, rig.memory.throttle_held_ticks) == (Notice.NONE, 0.0)


def test_what_a_restart_waits_for_is_told_before_a_held_accelerator(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS, 0.0)
    rig.memory = rig.memory._replace(throttle_held_ticks=1e6, throttle_override=1.0)
    rig.driver = rig.driver._replace(throttle=0.5)
    rig.tick(Event.RESTART)
    assert rig.arbitration.notice == Notice.RELEASE_PEDALS


def test_person_who_pulls_hard_enough_for_long_enough_takes_the_wheel(control: ControlSettings) -> None:
    watch = START
    for tick in range(int(control.steering_override_ticks) + 1):
        assert not steering_taken(watch, control), tick
        watch = watch_wheel(watch, 0.0, 0.0, 0.0, control.steering_override_nm + 0.1, True, True, control)
    assert steering_taken(watch, control)
    assert watch_wheel(watch, 0.0, 0.0, 0.0, control.steering_override_nm - 0.1, True, True, control).past_ticks == 0.0
