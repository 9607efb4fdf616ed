"""Every mode met with every trigger, raised by real inputs and not by its number."""

import itertools
import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.control.modes import REACTIONS, Trigger
from simconsole.signals import Button, Event, Mode, Reason, Validity

PAIRS = list(itertools.product(Mode, Trigger))


def brake(rig: Any) -> None:
    rig.driver = rig.driver._replace(brake=0.2)
    rig.tick()


def steer(rig: Any) -> None:
    rig.driver = rig.driver._replace(hand_wheel_rad=rig.driver.hand_wheel_rad + math.radians(9.0))
    rig.run(0.06)


def lose_wheel(rig: Any) -> None:
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.STALE))
    rig.tick()


def go_silent(rig: Any) -> None:
    rig.sending = False
    rig.run(0.21)


def refuse(rig: Any) -> None:
    rig.sending = False
    for _ in range(5):
        rig.refuse()
        rig.tick()


def wait(rig: Any) -> None:
    rig.run(10.1)


def stand(rig: Any) -> None:
    rig.vehicle = rig.vehicle._replace(vx_mps=0.0, full_throttle_accel_mps2=0.0, coast_accel_mps2=0.0)
    rig.run(0.4)


def reset(rig: Any) -> None:
    if rig.mode is Mode.EMERGENCY_STOP:
        stand(rig)
    rig.tick(Event.RESET)


def get_ready(rig: Any) -> None:
    rig.driver = rig.driver._replace(
        wheel_validity=float(Validity.LIVE),
        throttle_validity=float(Validity.LIVE),
        brake_validity=float(Validity.LIVE),
    )
    rig.tick()


CAUSES: dict[Trigger, Callable[[Any], None]] = {
    Trigger.EMERGENCY: lambda rig: rig.tick(Event.EMERGENCY_STOP),
    Trigger.BRAKE: brake,
    Trigger.STEERING: steer,
    Trigger.MANUAL_ASKED: lambda rig: rig.tick(Event.REQUEST_MANUAL),
    Trigger.LOOP_STALL: lambda rig: rig.tick(Event.LOOP_STALL),
    Trigger.DEVICE_LOST: lose_wheel,
    Trigger.COMMANDER_LOST: lambda rig: rig.tick(Event.COMMANDER_LOST),
    Trigger.COMMAND_STALE: go_silent,
    Trigger.COMMAND_INVALID: refuse,
    Trigger.TAKEOVER_ASKED: lambda rig: rig.tick(Event.REQUEST_TAKEOVER),
    Trigger.NO_REACTION: wait,
    Trigger.STANDSTILL: stand,
    Trigger.RESET: reset,
    Trigger.AUTONOMOUS_ASKED: lambda rig: rig.tick(Event.REQUEST_AUTONOMOUS),
    Trigger.SHARED_ASKED: lambda rig: rig.tick(Event.REQUEST_SHARED),
    Trigger.PERSON_READY: get_ready,
}
ALONE_IN_THE_SEAT = {Trigger.MANUAL_ASKED, Trigger.AUTONOMOUS_ASKED}


@pytest.mark.parametrize(("mode", "trigger"), PAIRS, ids=[f"{mode.name}-{trigger.name}" for mode, trigger in PAIRS])
def test_pair(mode: Mode, trigger: Trigger, make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(mode)
    if mode in (Mode.PARKED, Mode.STOPPED, Mode.TAKEOVER_REQUESTED):
        rig.send()
        rig.run(1.2)
    if mode is Mode.PARKED and trigger in ALONE_IN_THE_SEAT:
        # A person in the seat is never left parked for as long as it takes to ask.
        rig.driver = rig.driver._replace(wheel_validity=2.0, throttle_validity=2.0, brake_validity=2.0)
        rig.settings = rig.settings._replace(person_required=0.0)
    if mode is Mode.MINIMAL_RISK and trigger in (Trigger.NO_REACTION, Trigger.PERSON_READY):
        rig.vehicle = rig.vehicle._replace(vx_mps=100.0)
    before = rig.mode
    CAUSES[trigger](rig)
    assert rig.mode is REACTIONS[mode].get(trigger, before)


@pytest.mark.parametrize(
    ("button", "mode", "after", "reason"),
    [
        (Button.EMERGENCY_STOP, Mode.AUTONOMOUS, Mode.EMERGENCY_STOP, Reason.EMERGENCY),
        (Button.MANUAL, Mode.AUTONOMOUS, Mode.MANUAL, Reason.PERSON_ASKED),
        (Button.AUTONOMOUS, Mode.MANUAL, Mode.AUTONOMOUS, Reason.PERSON_ASKED),
        (Button.RESET, Mode.STOPPED, Mode.PARKED, Reason.RESET),
        (Button.MARK, Mode.MANUAL, Mode.MANUAL, Reason.ARMED),
    ],
)
def test_the_wheels_buttons_do_what_events_do(
    button: Button, mode: Mode, after: Mode, reason: Reason, make_rig: Callable[..., Any]
) -> None:
    rig = make_rig().drive(mode)
    rig.tick(edge=button)
    assert (rig.mode, rig.reason) == (after, reason)


def test_an_operator_is_named_as_such(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert rig.reason is Reason.OPERATOR_ASKED
    rig.tick(Event.REQUEST_TAKEOVER)
    assert rig.reason is Reason.REMOTE_ASKED
    rig.tick(Event.REQUEST_MANUAL)
    assert rig.reason is Reason.OPERATOR_ASKED


def test_a_held_emergency_button_is_enough(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    rig.driver = rig.driver._replace(pressed=float(Button.EMERGENCY_STOP))
    rig.tick()
    assert rig.mode is Mode.EMERGENCY_STOP
