"""What latches, what is refused, and what the reasons say."""

from collections.abc import Callable
from typing import Any

import pytest

from simconsole.values.signals import MOTOR_UNKNOWN, Button, Event, Mode, Reason, Validity

MakeRig = Callable[..., Any]


def test_stopped_is_left_by_acts_only(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.STOPPED)
    rig.driver = rig.driver._replace(throttle=0.5)
    rig.tick(edge=Button.MANUAL)
    assert (rig.mode, rig.refusal) == (Mode.STOPPED, Reason.REFUSED_THROTTLE_PRESSED)
    rig.driver = rig.driver._replace(throttle=0.0)
    rig.tick(edge=Button.MANUAL)
    assert (rig.mode, rig.reason) == (Mode.MANUAL, Reason.PERSON_ASKED)
    rig.run(0.7)
    assert rig.command.brake == 0.0


def test_emergency_is_cleared_by_reset_at_standstill_and_released_only(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.EMERGENCY_STOP)
    rig.tick(Event.RESET)
    assert (rig.mode, rig.refusal) == (Mode.EMERGENCY_STOP, Reason.REFUSED_MOVING)
    rig.run(3.0)
    assert rig.vehicle.vx_mps == 0.0
    rig.tick(Event.RESET | Event.EMERGENCY_STOP)
    assert (rig.mode, rig.refusal) == (Mode.EMERGENCY_STOP, Reason.REFUSED_EMERGENCY)
    rig.driver = rig.driver._replace(pressed=float(Button.EMERGENCY_STOP))
    rig.tick(Event.RESET)
    assert rig.mode is Mode.EMERGENCY_STOP
    rig.driver = rig.driver._replace(pressed=0.0, throttle=0.5)
    for event in (Event.REQUEST_MANUAL, Event.REQUEST_AUTONOMOUS, Event.REQUEST_SHARED):
        rig.tick(event)
        assert (rig.mode, rig.refusal) == (Mode.EMERGENCY_STOP, Reason.REFUSED_EMERGENCY)
    rig.tick(Event.RESET)
    assert (rig.mode, rig.reason) == (Mode.PARKED, Reason.RESET)
    rig.run(0.5)
    assert rig.mode is Mode.PARKED
    rig.driver = rig.driver._replace(throttle=0.0)
    rig.tick()
    assert rig.mode is Mode.MANUAL


def test_a_refusal_is_shown_for_a_while_and_changes_nothing(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    reason = rig.reason
    rig.vehicle = rig.vehicle._replace(vx_mps=30.0)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert (rig.mode, rig.reason, rig.refusal) == (Mode.MANUAL, reason, Reason.REFUSED_TOO_FAST)
    shown = 0
    while rig.refusal is not None:
        rig.tick()
        shown += 1
    assert shown == 3 * rig.tick_hz


@pytest.mark.fault("R12")
def test_asks_that_the_mode_does_not_grant_are_refused_by_name(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MINIMAL_RISK, speed_mps=24.0)
    rig.send()
    rig.run(1.2)
    rig.vehicle = rig.vehicle._replace(ay_mps2=0.0)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert (rig.mode, rig.refusal) == (Mode.MINIMAL_RISK, Reason.REFUSED_MODE)
    rig = make_rig().drive(Mode.STOPPED)
    rig.run(1.2)
    rig.tick(Event.REQUEST_SHARED)
    assert (rig.mode, rig.refusal) == (Mode.STOPPED, Reason.REFUSED_MODE)
    rig.sending = False
    rig.run(0.3)
    rig.tick(Event.REQUEST_SHARED)
    assert rig.refusal is Reason.REFUSED_NO_COMMAND


@pytest.mark.fault("R12")
def test_what_is_in_force_is_not_refused(make_rig: MakeRig) -> None:
    for mode, event in (
        (Mode.AUTONOMOUS, Event.REQUEST_AUTONOMOUS),
        (Mode.MANUAL, Event.REQUEST_MANUAL),
        (Mode.SHARED, Event.REQUEST_SHARED),
        (Mode.MANUAL, Event.RESET),
        (Mode.MANUAL, Event.REQUEST_TAKEOVER),
    ):
        rig = make_rig().drive(mode)
        rig.tick(event)
        assert (rig.mode, rig.refusal) == (mode, None)


def test_manual_is_refused_where_the_cockpit_is_not_there(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.LOST))
    rig.tick(Event.REQUEST_MANUAL)
    assert rig.mode is Mode.TAKEOVER_REQUESTED
    rig.tick(Event.REQUEST_MANUAL)
    assert (rig.mode, rig.refusal) == (Mode.TAKEOVER_REQUESTED, Reason.REFUSED_NOT_ARMED)


def test_wheel_whose_motor_is_unknown_is_not_turned_by_a_controller(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig.wheel_motor = MOTOR_UNKNOWN
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert (rig.mode, rig.refusal) == (Mode.MANUAL, Reason.REFUSED_WHEEL_UNKNOWN)
    rig.wheel_motor = 1.0
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert rig.mode is Mode.AUTONOMOUS
