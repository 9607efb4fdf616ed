"""Back to the start: who may ask, what must be so first, and for how long that is waited for."""

from collections.abc import Callable
from typing import Any

import pytest

from simconsole.control.modes.restart import GRANTED, NOT_ASKED, restart_refusal
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import person_of
from simconsole.values.signals import Button, DriverInput, Event, Mode, Notice, Reason
from tests.control.conftest import NOBODY, PERSON

RESTART = int(Event.RESTART)
MakeRig = Callable[..., Any]


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


def standing(make_rig: MakeRig, motor: float = 0.0, **fields: float) -> Any:
    """A person in a car that stands."""
    rig = make_rig().drive(Mode.MANUAL, 0.0)
    rig.driver = rig.driver._replace(**fields)
    rig.wheel_motor = motor
    return rig


def shown(rig: Any) -> tuple[Notice, float, Reason | None]:
    return Notice(int(rig.arbitration.notice)), rig.arbitration.restarted, rig.refusal


@pytest.mark.parametrize(("motor", "notice"), [(1.0, Notice.CENTRING_WHEEL), (0.0, Notice.CENTRE_WHEEL)])
def test_the_wheel_comes_first_then_the_pedals_then_the_start(motor: float, notice: Notice, make_rig: MakeRig) -> None:
    rig = standing(make_rig, motor, hand_wheel_rad=-1.0, brake=0.5)
    rig.tick(Event.RESTART)
    assert (*shown(rig), rig.memory.restart_ticks) == (notice, 0.0, None, 1.0)
    rig.driver = rig.driver._replace(brake=0.0)
    rig.tick()
    assert shown(rig) == (notice, 0.0, None)
    rig.driver = rig.driver._replace(hand_wheel_rad=rig.settings.restart_wheel_rad, brake=0.5)
    rig.tick()
    assert (*shown(rig), rig.memory.restart_ticks) == (Notice.RELEASE_PEDALS, 0.0, None, 3.0)
    rig.driver = rig.driver._replace(brake=0.0)
    rig.tick()
    assert (*shown(rig), rig.memory.restart_ticks) == (Notice.NONE, 1.0, None, 0.0)
    rig.tick()
    assert shown(rig) == (Notice.NONE, 0.0, None)


@pytest.mark.parametrize(
    ("fields", "reason"),
    [({"hand_wheel_rad": 1.0}, Reason.REFUSED_WHEEL_NOT_CENTRED), ({"clutch": 0.5}, Reason.REFUSED_PEDAL_PRESSED)],
)
def test_it_is_waited_for_ten_seconds_and_then_refused_in_words(
    fields: dict[str, float], reason: Reason, make_rig: MakeRig
) -> None:
    rig = standing(make_rig, **fields)
    rig.tick(Event.RESTART)
    for _ in range(10 * rig.tick_hz - 1):
        rig.tick(Event.RESTART if rig.ticks % 7 == 0 else 0)
        assert (rig.refusal, rig.arbitration.restarted) == (None, 0.0)
        assert rig.arbitration.notice > 0.0
    rig.tick()
    assert (*shown(rig), rig.memory.restart_ticks) == (Notice.NONE, 0.0, reason, 0.0)
    rig.tick()
    assert shown(rig) == (Notice.NONE, 0.0, reason)


def test_a_car_that_moves_waits_for_nothing_but_released_pedals(make_rig: MakeRig) -> None:
    rig = standing(make_rig, 1.0, hand_wheel_rad=1.0)
    rig.vehicle = rig.vehicle._replace(vx_mps=5.0)
    rig.tick(Event.RESTART)
    assert (*shown(rig), rig.memory.restart_ticks) == (Notice.NONE, 0.0, Reason.REFUSED_WHEEL_NOT_CENTRED, 0.0)
    rig = standing(make_rig, brake=0.5)
    rig.vehicle = rig.vehicle._replace(vx_mps=5.0)
    rig.tick(Event.RESTART)
    assert shown(rig) == (Notice.NONE, 0.0, Reason.REFUSED_PEDAL_PRESSED)


def test_a_car_that_rolls_off_ends_the_centring_and_not_the_wait_for_the_pedals(make_rig: MakeRig) -> None:
    rig = standing(make_rig, 1.0, hand_wheel_rad=1.0)
    rig.tick(Event.RESTART)
    rig.vehicle = rig.vehicle._replace(vx_mps=5.0)
    rig.tick()
    assert shown(rig) == (Notice.NONE, 0.0, Reason.REFUSED_WHEEL_NOT_CENTRED)
    rig = standing(make_rig, brake=0.5)
    rig.tick(Event.RESTART)
    rig.vehicle = rig.vehicle._replace(vx_mps=5.0)
    rig.tick()
    assert shown(rig) == (Notice.RELEASE_PEDALS, 0.0, None)


def test_an_emergency_stop_ends_the_wait_at_once(make_rig: MakeRig) -> None:
    rig = standing(make_rig, 1.0, hand_wheel_rad=1.0)
    rig.tick(Event.RESTART)
    rig.tick(Event.EMERGENCY_STOP)
    assert rig.mode is Mode.EMERGENCY_STOP
    assert (*shown(rig), rig.memory.restart_ticks) == (Notice.NONE, 0.0, Reason.REFUSED_EMERGENCY, 0.0)
