"""When the drive may go back to its start: every guard at its edge."""

import math

import pytest

from simconsole.control.modes.restart import GRANTED, NOT_ASKED, restart_refusal
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import Person
from simconsole.values.signals import Button, DriverInput, Event, Mode, Reason

DRIVER = DriverInput(*(0.0,) * len(DriverInput._fields))
THERE = Person(1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
ASKED = int(Event.RESTART)


def test_only_a_request_asks(control: ControlSettings) -> None:
    for mode in Mode:
        assert restart_refusal(float(mode), DRIVER, THERE, int(Event.RESET | Event.MARK), control) == NOT_ASKED
    held = DRIVER._replace(pressed=float(Button.RESTART), edges=float(Button.RESET))
    assert restart_refusal(float(Mode.MANUAL), held, THERE, 0, control) == NOT_ASKED
    edge = DRIVER._replace(edges=float(Button.RESTART | Button.MARK))
    assert restart_refusal(float(Mode.MANUAL), edge, THERE, 0, control) == GRANTED
    assert restart_refusal(float(Mode.MANUAL), DRIVER, THERE, ASKED, control) == GRANTED


def test_an_emergency_is_reset_first(control: ControlSettings) -> None:
    emergency = float(Reason.REFUSED_EMERGENCY)
    for mode in Mode:
        latched = emergency if mode is Mode.EMERGENCY_STOP else GRANTED
        assert restart_refusal(float(mode), DRIVER, THERE, ASKED, control) == latched
    both = ASKED | int(Event.EMERGENCY_STOP)
    assert restart_refusal(float(Mode.MANUAL), DRIVER, THERE, both, control) == emergency
    held = DRIVER._replace(pressed=float(Button.EMERGENCY_STOP))
    assert restart_refusal(float(Mode.MANUAL), held, THERE, ASKED, control) == emergency
    other = DRIVER._replace(pressed=float(Button.RESET))
    assert restart_refusal(float(Mode.MANUAL), other, THERE, ASKED, control) == GRANTED


@pytest.mark.parametrize("present", [True, False])
def test_a_person_who_is_there_has_let_go(present: bool, control: ControlSettings) -> None:
    def refusal(person: Person = THERE, **fields: float) -> float:
        person = person._replace(trusted=float(present))
        return restart_refusal(float(Mode.MANUAL), DRIVER._replace(**fields), person, ASKED, control)

    pedal = float(Reason.REFUSED_PEDAL_PRESSED) if present else GRANTED
    wheel = float(Reason.REFUSED_WHEEL_NOT_CENTRED) if present else GRANTED
    assert refusal(THERE._replace(throttle=control.throttle_override)) == pedal
    assert refusal(THERE._replace(throttle=control.throttle_override - 1e-9)) == GRANTED
    assert refusal(THERE._replace(brake=control.brake_override)) == pedal
    assert refusal(THERE._replace(brake=control.brake_override - 1e-9)) == GRANTED
    assert refusal(clutch=control.throttle_override) == pedal
    assert refusal(clutch=control.throttle_override - 1e-9) == GRANTED
    assert refusal(clutch=math.nan) == pedal
    for side in (1.0, -1.0):
        assert refusal(hand_wheel_rad=side * control.restart_wheel_rad) == GRANTED
        assert refusal(hand_wheel_rad=side * (control.restart_wheel_rad + 1e-9)) == wheel
    assert math.degrees(control.restart_wheel_rad) < 90.0
