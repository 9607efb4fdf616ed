"""Turn indicators and hazard lights: whose they are, in every mode."""

from collections.abc import Callable
from typing import Any

import pytest

from simconsole.control.lights import Lights, lights_of, switched
from simconsole.values.signals import ArbiterMemory, Button, Event, Link, Mode
from tests.control.conftest import NO_LINK, PERSON, SILENT

MEMORY = ArbiterMemory(*(0.0,) * len(ArbiterMemory._fields))
FRESH = NO_LINK._replace(fresh=1.0)
OFF = Lights(0.0, 0.0)
DRIVEN = (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED)
STOPS = (Mode.MINIMAL_RISK, Mode.STOPPED, Mode.EMERGENCY_STOP)
MakeRig = Callable[..., Any]


def pressed(button: Button | int, stalk: float = 0.0, hazard: float = 0.0) -> Lights:
    driver = PERSON._replace(edges=float(button))
    return switched(driver, MEMORY._replace(stalk=stalk, hazard_switch=hazard))


@pytest.mark.parametrize(
    ("button", "before", "after"),
    [
        (Button.INDICATOR_LEFT, 0.0, 1.0),
        (Button.INDICATOR_LEFT, -1.0, 1.0),
        (Button.INDICATOR_LEFT, 1.0, 0.0),
        (Button.INDICATOR_RIGHT, 0.0, -1.0),
        (Button.INDICATOR_RIGHT, 1.0, -1.0),
        (Button.INDICATOR_RIGHT, -1.0, 0.0),
        (Button.INDICATOR_LEFT | Button.INDICATOR_RIGHT, 0.0, 1.0),
        (Button.MARK, -1.0, -1.0),
        (0, 1.0, 1.0),
    ],
)
def test_the_stalk(button: Button | int, before: float, after: float) -> None:
    assert pressed(button, before, 1.0) == Lights(after, 1.0)


def test_the_hazard_switch() -> None:
    assert pressed(Button.HAZARD) == Lights(0.0, 1.0)
    assert pressed(Button.HAZARD, 1.0, 1.0) == Lights(1.0, 0.0)
    assert pressed(Button.INDICATOR_LEFT, 0.0, 1.0) == Lights(1.0, 1.0)


@pytest.mark.parametrize("mode", Mode)
def test_the_controllers_count_while_it_drives(mode: Mode) -> None:
    person, remote = Lights(-1.0, 0.0), SILENT._replace(turn_indicators=1.0, hazard_lights=1.0)
    shown = lights_of(float(mode), person, remote, FRESH)
    assert shown == Lights(1.0 if mode in DRIVEN else -1.0, 1.0 if mode in (*DRIVEN, *STOPS) else 0.0)


@pytest.mark.parametrize("mode", DRIVEN)
def test_the_person_s_count_where_it_sets_none_or_is_silent(mode: Mode) -> None:
    person = Lights(-1.0, 1.0)
    assert lights_of(float(mode), person, SILENT, FRESH) == person
    right = SILENT._replace(turn_indicators=-1.0)
    assert lights_of(float(mode), OFF, right, FRESH) == Lights(-1.0, 0.0)
    asked = SILENT._replace(turn_indicators=1.0, hazard_lights=1.0)
    assert lights_of(float(mode), OFF, asked, Link(*(0.0,) * len(Link._fields))) == OFF


@pytest.mark.parametrize("mode", Mode)
def test_a_stop_that_the_console_makes_shows_the_hazard_lights(mode: Mode, make_rig: MakeRig) -> None:
    rig = make_rig().drive(mode)
    assert rig.command.hazard_lights == (1.0 if mode in STOPS else 0.0)
    assert rig.command.turn_indicators == 0.0


def test_what_the_person_has_set_outlasts_autonomy(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig.tick(edge=Button.INDICATOR_RIGHT)
    assert rig.command.turn_indicators == -1.0
    rig.send(turn_indicators=1.0)
    rig.run(0.2)
    assert rig.command.turn_indicators == -1.0, "a controller that does not drive has no say"
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert (rig.mode, rig.command.turn_indicators) == (Mode.AUTONOMOUS, 1.0)
    rig.tick(edge=Button.HAZARD)
    assert (rig.mode, rig.command.turn_indicators, rig.command.hazard_lights) == (Mode.AUTONOMOUS, 1.0, 1.0)
    rig.tick(Event.REQUEST_MANUAL)
    assert (rig.command.turn_indicators, rig.command.hazard_lights) == (-1.0, 1.0)


def test_the_lights_of_a_safe_stop_end_with_it(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.STOPPED)
    assert rig.command.hazard_lights == 1.0
    rig.tick(Event.REQUEST_MANUAL)
    assert (rig.mode, rig.command.hazard_lights) == (Mode.MANUAL, 0.0)


def test_the_ecu_s_lights_count_while_it_commands(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig.sending = False
    rig.send_ecu(turn_indicators=-1.0)
    rig.run(1.5)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert (rig.mode, rig.command.turn_indicators) == (Mode.AUTONOMOUS, -1.0)
