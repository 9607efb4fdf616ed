"""Guards one by one: which trigger comes from what, and which refusal."""

import itertools
import math

import pytest

from simconsole.control.modes.engage import GRANTED
from simconsole.control.modes.mode_table import REACTIONS, Trigger
from simconsole.control.modes.triggers import (
    Asked,
    asked_of,
    asked_triggers,
    fault_triggers,
    link_lost,
    manual_refusal,
    person_triggers,
    refusal_of,
    reset_refusal,
)
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import Person
from simconsole.values.signals import Button, DriverInput, Event, Link, Mode, Reason

NOBODY = DriverInput(*(0.0,) * len(DriverInput._fields))
NOTHING = Asked(*(0.0,) * len(Asked._fields))
THERE = Person(1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
GOOD = Link(*(0.0,) * len(Link._fields))._replace(fresh=1.0)


def names(mask: int) -> set[str]:
    return {trigger.name for trigger in Trigger if mask >> trigger & 1}


@pytest.mark.parametrize(
    ("events", "edges", "pressed", "expected"),
    [
        (Event.EMERGENCY_STOP, 0, 0, {"emergency"}),
        (0, Button.EMERGENCY_STOP, 0, {"emergency"}),
        (0, 0, Button.EMERGENCY_STOP, {"emergency", "emergency_held"}),
        (Event.RESET, 0, 0, {"reset"}),
        (0, Button.RESET, 0, {"reset"}),
        (0, 0, Button.RESET, set()),
        (Event.REQUEST_MANUAL, 0, 0, {"manual"}),
        (0, Button.MANUAL, 0, {"manual", "by_person"}),
        (Event.REQUEST_AUTONOMOUS, 0, 0, {"autonomous"}),
        (0, Button.AUTONOMOUS, 0, {"autonomous", "by_person"}),
        (Event.REQUEST_TAKEOVER, 0, 0, {"takeover"}),
        (Event.REQUEST_SHARED, 0, 0, {"shared"}),
        (Event.MARK | Event.LOOP_STALL, Button.SHIFT_UP, Button.INDICATOR_LEFT, set()),
        (0, 0, 0, set()),
        (
            Event.REQUEST_SHARED | Event.RESET,
            Button.AUTONOMOUS | Button.MARK,
            Button.MANUAL,
            {"shared", "reset", "autonomous", "by_person"},
        ),
    ],
)
def test_what_is_asked(events: int, edges: int, pressed: int, expected: set[str]) -> None:
    asked = asked_of(NOBODY._replace(edges=float(edges), pressed=float(pressed)), int(events))
    acts = {name: value for name, value in asked._asdict().items() if not name.endswith("_reason")}
    assert set(acts.values()) <= {0.0, 1.0}
    assert {name for name, value in acts.items() if value} == expected


@pytest.mark.parametrize("mode", Mode)
def test_manual_is_refused_in_an_emergency_and_without_a_person(mode: Mode, control: ControlSettings) -> None:
    usual = Reason.REFUSED_EMERGENCY if mode is Mode.EMERGENCY_STOP else GRANTED
    assert manual_refusal(float(mode), THERE, control) == usual
    absent = Reason.REFUSED_EMERGENCY if mode is Mode.EMERGENCY_STOP else Reason.REFUSED_NOT_ARMED
    assert manual_refusal(float(mode), THERE._replace(trusted=0.0), control) == absent
    foot = THERE._replace(accelerator=control.throttle_override)
    pressed = Reason.REFUSED_THROTTLE_PRESSED if mode in (Mode.PARKED, Mode.STOPPED) else usual
    assert manual_refusal(float(mode), foot, control) == pressed
    assert manual_refusal(float(mode), THERE._replace(accelerator=control.throttle_override - 1e-9), control) == usual


def test_a_reset_needs_a_released_button_and_standstill() -> None:
    assert reset_refusal(NOTHING, True) == GRANTED
    assert reset_refusal(NOTHING, False) == Reason.REFUSED_MOVING
    for name, standing in itertools.product(("emergency", "emergency_held"), (True, False)):
        assert reset_refusal(NOTHING._replace(**{name: 1.0}), standing) == Reason.REFUSED_EMERGENCY


@pytest.mark.parametrize("mode", Mode)
def test_triggers_of_the_cockpit(mode: Mode, control: ControlSettings) -> None:
    def present(person: Person, steering: bool = False, settings: ControlSettings = control) -> set[str]:
        return names(person_triggers(float(mode), person, steering, math.inf, settings))

    assert present(THERE) == {"PERSON_READY"}
    assert present(THERE, steering=True) == {"PERSON_READY", "STEERING"}
    assert present(THERE._replace(brake=control.brake_override)) == {"PERSON_READY", "BRAKE"}
    assert present(THERE._replace(brake=control.brake_override - 1e-9)) == {"PERSON_READY"}
    assert present(THERE._replace(accelerator=control.throttle_override)) == set()
    assert present(THERE._replace(accelerator=control.throttle_override - 1e-9)) == {"PERSON_READY"}
    assert present(THERE._replace(accelerator=0.9, brake=0.9), steering=True) == {"STEERING", "BRAKE"}
    lost = THERE._replace(trusted=0.0, brake=1.0)
    assert present(lost, steering=True) == {"DEVICE_LOST"}
    alone = control._replace(person_required=0.0)
    assert present(lost, settings=alone) == ({"DEVICE_LOST"} if mode in (Mode.MANUAL, Mode.SHARED) else set())


def test_triggers_that_nobody_asked_for() -> None:
    def present(link: Link = GOOD, events: int = 0, no_reaction: bool = False, standing: bool = False) -> set[str]:
        return names(fault_triggers(link, int(events), no_reaction, standing))

    assert present() == set()
    assert present(events=Event.LOOP_STALL) == {"LOOP_STALL"}
    assert present(events=Event.COMMANDER_LOST) == {"COMMANDER_LOST"}
    assert present(events=Event.NO_ANSWER) == {"COMMAND_STALE"}
    assert present(GOOD._replace(fresh=0.0)) == {"COMMAND_STALE"}
    assert present(GOOD._replace(invalid=1.0)) == {"COMMAND_INVALID"}
    assert present(GOOD._replace(invalid=1.0, fresh=0.0)) == {"COMMAND_INVALID"}
    assert present(GOOD._replace(invalid=1.0), Event.COMMANDER_LOST) == {"COMMAND_INVALID", "COMMANDER_LOST"}
    assert present(no_reaction=True) == {"NO_REACTION"}
    assert present(standing=True) == {"STANDSTILL"}
    everything = present(
        GOOD._replace(fresh=0.0), Event.LOOP_STALL | Event.COMMANDER_LOST | Event.NO_ANSWER, True, True
    )
    assert everything == {"LOOP_STALL", "COMMANDER_LOST", "COMMAND_STALE", "NO_REACTION", "STANDSTILL"}
    assert present(events=Event.MARK | Event.EMERGENCY_STOP) == set()


REFUSED = float(Reason.REFUSED_TOO_FAST)
TRIGGERS = {
    "emergency": "EMERGENCY",
    "takeover": "TAKEOVER_ASKED",
    "manual": "MANUAL_ASKED",
    "reset": "RESET",
    "autonomous": "AUTONOMOUS_ASKED",
    "shared": "SHARED_ASKED",
}


@pytest.mark.parametrize("name", TRIGGERS)
def test_what_is_asked_and_not_refused_becomes_a_trigger(name: str) -> None:
    asked = NOTHING._replace(**{name: 1.0})
    assert names(asked_triggers(asked, GRANTED, GRANTED, GRANTED, GRANTED)) == {TRIGGERS[name]}
    guards = ["manual", "reset", "autonomous", "shared"]
    for guard in guards:
        refusals = [REFUSED if guard == other else GRANTED for other in guards]
        assert names(asked_triggers(asked, *refusals)) == (set() if guard == name else {TRIGGERS[name]})
    everything = NOTHING._replace(**dict.fromkeys(TRIGGERS, 1.0))
    assert names(asked_triggers(everything, GRANTED, GRANTED, GRANTED, GRANTED)) == set(TRIGGERS.values())
    assert asked_triggers(NOTHING, GRANTED, GRANTED, GRANTED, GRANTED) == 0


ASKS = {
    "manual": (Trigger.MANUAL_ASKED, Mode.MANUAL),
    "reset": (Trigger.RESET, Mode.PARKED),
    "autonomous": (Trigger.AUTONOMOUS_ASKED, Mode.AUTONOMOUS),
    "shared": (Trigger.SHARED_ASKED, Mode.SHARED),
}
LATCHED = (Mode.EMERGENCY_STOP, Mode.STOPPED)


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize("after", Mode)
def test_why_an_ask_was_refused(mode: Mode, after: Mode) -> None:
    """An emergency stop is named before anything else, then the ask's own refusal, then what came first."""
    refusals = {"manual": 21.0, "reset": 22.0, "autonomous": 23.0, "shared": 24.0}
    granted = (GRANTED,) * 4

    def why(name: str, *refusals: float) -> float:
        return refusal_of(float(mode), float(after), NOTHING._replace(**{name: 1.0}), *refusals)

    assert why("takeover", *refusals.values()) == GRANTED
    for name, (trigger, target) in ASKS.items():
        met = after is target or (name == "reset" and mode not in LATCHED and after not in LATCHED)
        emergency = after is Mode.EMERGENCY_STOP
        given = refusals[name] if name == "reset" or not emergency else Reason.REFUSED_EMERGENCY
        assert why(name, *refusals.values()) == (GRANTED if met else given)
        overruled = Reason.REFUSED_OVERRULED if trigger in REACTIONS[mode] else Reason.REFUSED_MODE
        assert why(name, *granted) == (GRANTED if met else Reason.REFUSED_EMERGENCY if emergency else overruled)


def test_of_several_asks_the_first_that_was_refused_is_told() -> None:
    both = NOTHING._replace(manual=1.0, autonomous=1.0, shared=1.0)
    refused = (21.0, GRANTED, 23.0, 24.0)
    assert refusal_of(float(Mode.STOPPED), float(Mode.STOPPED), both, *refused) == 21.0
    assert refusal_of(float(Mode.MANUAL), float(Mode.MANUAL), both, *refused) == 23.0
    assert refusal_of(float(Mode.MANUAL), float(Mode.AUTONOMOUS), both._replace(manual=0.0), *refused) == 24.0


def test_a_link_is_lost_when_the_commander_left_or_did_not_answer() -> None:
    assert link_lost(Event.COMMANDER_LOST)
    assert link_lost(Event.NO_ANSWER | Event.MARK)
    assert not link_lost(int(~(Event.COMMANDER_LOST | Event.NO_ANSWER)) & 0x1FFFF)


def test_a_mask_that_is_no_number_asks_for_nothing() -> None:
    for nonsense in (math.nan, math.inf, -1.0, 1e300):
        assert asked_of(NOBODY._replace(edges=nonsense, pressed=nonsense), 0) == asked_of(NOBODY, 0)


@pytest.mark.parametrize("operator", [0, Event.OPERATOR])
def test_an_act_is_told_as_the_person_s_where_their_button_made_it(operator: int) -> None:
    buttons = Button.EMERGENCY_STOP | Button.RESET | Button.TAKEOVER
    by_hand = asked_of(NOBODY._replace(edges=float(buttons)), int(operator))
    assert by_hand[-3:] == (Reason.EMERGENCY, Reason.RESET, Reason.PERSON_ASKED)
    others = asked_of(NOBODY, int(Event.EMERGENCY_STOP | Event.RESET | Event.REQUEST_TAKEOVER | operator))
    if operator:
        assert others[-3:] == (Reason.OPERATOR_EMERGENCY, Reason.OPERATOR_RESET, Reason.OPERATOR_ASKED)
    else:
        assert others[-3:] == (Reason.EMERGENCY, Reason.RESET, Reason.REMOTE_ASKED)


def test_hands_and_feet_wait_until_a_lost_cockpit_is_back_for_good(control: ControlSettings) -> None:
    person = THERE._replace(brake=1.0)
    for back_ticks, present in ((control.device_back_ticks - 1.0, {"PERSON_READY"}), (control.device_back_ticks, None)):
        found = names(person_triggers(float(Mode.MINIMAL_RISK), person, True, back_ticks, control))
        assert found == (present or {"PERSON_READY", "BRAKE", "STEERING"})
