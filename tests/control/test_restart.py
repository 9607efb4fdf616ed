"""Back to the start: who may ask, and what must be so first."""

import pytest

from simconsole.control.person import person_of
from simconsole.control.restart import GRANTED, NOT_ASKED, restart_refusal
from simconsole.control.settings import ControlSettings
from simconsole.signals import Button, DriverInput, Event, Mode, Reason
from tests.control.conftest import NOBODY, PERSON

RESTART = int(Event.RESTART)


def asked(control: ControlSettings, driver: DriverInput, events: int, mode: Mode = Mode.AUTONOMOUS) -> float:
    return restart_refusal(float(mode), driver, person_of(driver, 0.0, control), events, control)


@pytest.mark.parametrize("mode", [mode for mode in Mode if mode is not Mode.EMERGENCY_STOP])
def test_granted_to_a_centred_wheel_and_released_pedals(control: ControlSettings, mode: Mode) -> None:
    assert asked(control, PERSON, RESTART, mode) == GRANTED
    assert asked(control, PERSON._replace(edges=float(Button.RESTART)), 0, mode) == GRANTED
    assert asked(control, PERSON, int(Event.RESET), mode) == NOT_ASKED


def test_a_cockpit_that_is_not_there_holds_up_nothing(control: ControlSettings) -> None:
    assert asked(control, NOBODY._replace(hand_wheel_rad=3.0), RESTART) == GRANTED


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"hand_wheel_rad": 0.0873}, Reason.REFUSED_WHEEL_NOT_CENTRED),
        ({"hand_wheel_rad": -0.0873}, Reason.REFUSED_WHEEL_NOT_CENTRED),
        ({"throttle": 0.05}, Reason.REFUSED_PEDAL_PRESSED),
        ({"brake": 0.05}, Reason.REFUSED_PEDAL_PRESSED),
        ({"clutch": 0.05}, Reason.REFUSED_PEDAL_PRESSED),
        ({"clutch": float("nan")}, Reason.REFUSED_PEDAL_PRESSED),
        ({"pressed": float(Button.EMERGENCY_STOP)}, Reason.REFUSED_EMERGENCY),
    ],
)
def test_refused_in_words(control: ControlSettings, fields: dict[str, float], reason: Reason) -> None:
    assert asked(control, PERSON._replace(**fields), RESTART) == reason


def test_the_limits_themselves_are_allowed(control: ControlSettings) -> None:
    calm = PERSON._replace(hand_wheel_rad=control.restart_wheel_rad, throttle=0.049, brake=0.049, clutch=0.049)
    assert asked(control, calm, RESTART) == GRANTED


def test_an_emergency_stop_is_reset_first(control: ControlSettings) -> None:
    assert asked(control, PERSON, RESTART, Mode.EMERGENCY_STOP) == Reason.REFUSED_EMERGENCY
    assert asked(control, PERSON, RESTART | int(Event.EMERGENCY_STOP)) == Reason.REFUSED_EMERGENCY
