"""Calibration step by step, with readings by hand: the order of the questions, and what ends or repeats a step."""

from collections.abc import Sequence
from typing import Any

import msgspec
import pytest

from simconsole.devices.calibration.input_detection import BUTTONS, SteadyReading, SteadyReadings
from simconsole.devices.calibration.wizard import QUIT, SKIP, TRIES, Entry, Wizard
from simconsole.profiles.device import CockpitProfile, DeviceKey
from simconsole.profiles.files.loader import load

PAD = DeviceKey(0x045E, 0x028E)
LEVER = DeviceKey(1, 2)
REST = ((0.0, 1.0, 1.0), 0)
HELD = {  # by step: axes and buttons of the pad
    "left": ((-0.9, 1.0, 1.0), 0),
    "right": ((0.9, 1.0, 1.0), 0),
    "throttle": ((0.0, -1.0, 1.0), 0),
    "brake": ((0.0, 1.0, -1.0), 0),
    "shift_up": (REST[0], 1 << 5),
    "shift_down": (REST[0], 1 << 4),
    "mark": (REST[0], 1 << BUTTONS + 2),  # up on the hat
}


class Person:
    """Does what is asked on a pad with paddles, skips what it lacks, and keeps the steps."""

    def __init__(
        self,
        base: CockpitProfile,
        known: Sequence[CockpitProfile] = (),
        learnt: dict[str, Any] | None = None,
        **typed: str,
    ) -> None:
        self.saved: dict[str, Any] = {}
        self.gives_up_after = ("", 0)
        self.steps: list[str] = []
        self.said: list[str] = []
        self.typed = {"degrees": "", "lever": SKIP, **typed}
        self.held = dict(HELD)
        self.elsewhere: dict[str, int] = {}
        self.after_a_refusal: dict[str, int] = {}
        entries = {PAD: Entry("Pad", 3, 11, 1), LEVER: Entry("Lever", 0, 4, 0)}
        self.wizard = Wizard(
            base, entries, ask=self.ask, say=self.say, look=self.look, known=known, learnt=learnt, save=self.save
        )

    def save(self, learnt: dict[str, Any]) -> None:
        self.saved = msgspec.json.decode(msgspec.json.encode(learnt))

    def ask(self, step: str, text: str) -> str:
        self.steps.append(step)
        if (step, self.steps.count(step)) == self.gives_up_after:
            return QUIT
        needed = {"rest", "neutral", "centre", *self.held, *self.elsewhere}
        return self.typed.get(step, "" if step in needed else SKIP.upper() + " ")

    def say(self, line: str) -> None:
        self.said.append(line)
        for step, button in self.after_a_refusal.items():
            self.held.pop(step)
            self.elsewhere[step] = button

    def look(self) -> SteadyReadings:
        axes, buttons = self.held.get(self.steps[-1], REST)
        lever = self.elsewhere.get(self.steps[-1], 0)
        return {PAD: SteadyReading(axes, (0.0,) * 3, buttons), LEVER: SteadyReading((), (), lever)}


@pytest.fixture
def person(t500: CockpitProfile) -> Person:
    return Person(t500)


def test_a_pad_is_learnt_in_one_round(person: Person) -> None:
    learnt = person.wizard.run("by hand")
    assert person.said == []
    assert person.steps[:7] == ["rest", "left", "right", "centre", "degrees", "throttle", "brake"]
    assert (learnt.wheel.axis, learnt.wheel.grows_to) == (0, "right")
    assert (learnt.pedals.throttle.axis, learnt.pedals.brake.axis) == (1, 2)
    assert (learnt.pedals.clutch, learnt.pedals.handbrake) == (None, None)
    assert learnt.shifter.pattern == "sequential"
    assert learnt.buttons.shift_up is not None
    assert learnt.buttons.shift_up.button == 5
    assert learnt.buttons.mark is not None
    assert (learnt.buttons.mark.button, learnt.buttons.mark.hat) == (None, "up")
    assert learnt.buttons.reset is None


def test_force_and_boot_modes_are_those_of_a_known_wheel_only(person: Person, t500: CockpitProfile) -> None:
    learnt = person.wizard.run("by hand")
    assert t500.force_feedback is not None
    assert (learnt.force_feedback, learnt.boot_modes) == (None, [])
    assert not [key for key in learnt.provenance if key.startswith(("force", "boot"))]


def test_paddles_on_another_device_make_it_the_shifter(person: Person) -> None:
    del person.held["shift_up"], person.held["shift_down"]
    person.elsewhere = {"shift_up": 1, "shift_down": 2}
    learnt = person.wizard.run("by hand")
    assert [(role.role, role.name) for role in learnt.roles] == [
        ("wheel", "Pad"), ("pedals", "Pad"), ("shifter", "Lever"),
    ]  # fmt: skip
    assert learnt.buttons.shift_down is not None
    assert (learnt.buttons.shift_down.on, learnt.buttons.shift_down.button) == ("shifter", 1)


def test_button_of_a_third_place_is_asked_for_again_and_then_ends(person: Person) -> None:
    person.elsewhere = {"mark": 1}
    del person.held["mark"]
    person.gives_up_after = ("mark", TRIES + 2)
    with pytest.raises(KeyboardInterrupt):
        person.wizard.run("by hand")
    refusal = "  again, please: mark: value on another device: a button of the wheel or the shifter"
    assert person.said.count(refusal) == TRIES + 1
    assert person.said[TRIES] == "  q gives up for now: what was learnt so far is kept"
    assert list(person.saved)[:4] == ["wheel", "throttle", "brake", "clutch"]
    assert "mark" not in person.saved


def test_what_was_learnt_is_not_asked_again(person: Person, t500: CockpitProfile) -> None:
    whole = person.wizard.run("by hand")
    half = {step: person.saved[step] for step in list(person.saved)[:7]}
    again = Person(t500, learnt=half)
    assert again.wizard.run("by hand") == whole
    assert not {"left", "right", "centre", "degrees", "throttle", "brake"} & set(again.steps)
    assert again.saved == person.saved


def test_a_wheel_that_another_profile_knows_keeps_its_motor(person: Person, t500: CockpitProfile) -> None:
    replace = msgspec.structs.replace
    own = [replace(role, vendor_id=PAD[0], product_id=PAD[1]) if role.role == "wheel" else role for role in t500.roles]
    known = replace(t500, roles=own, wheel=replace(t500.wheel, lock_to_lock_deg=900.0))
    learnt = Person(load("devices", "gamepad", CockpitProfile), known=[known]).wizard.run("by hand")
    assert learnt.force_feedback is None, "the gamepad's own profile knows it, and it has no motor"
    learnt = Person(load("devices", "keyboard", CockpitProfile), known=[t500, known]).wizard.run("by hand")
    assert learnt.force_feedback == t500.force_feedback
    assert learnt.wheel.lock_to_lock_deg == pytest.approx(1000.0)
    assert learnt.roles[0].button_labels == t500.roles[0].button_labels


def test_button_that_was_refused_for_one_meaning_is_free_for_another(person: Person) -> None:
    """Gears 1 and 2 on the lever, but gear 2 was first held on the pad: that button may be MARK later."""
    for step in ("shift_up", "shift_down"):
        del person.held[step]
    person.typed["lever"] = ""
    person.elsewhere = {"gear 1": 1, "gear 2": 0}
    person.held |= {"gear 2": (REST[0], 1 << 3), "mark": (REST[0], 1 << 3)}
    person.after_a_refusal = {"gear 2": 2}
    learnt = person.wizard.run("by hand")
    assert learnt.shifter.gears == [0, 1]
    assert learnt.buttons.mark is not None
    assert (learnt.buttons.mark.on, learnt.buttons.mark.button) == ("wheel", 3)


@pytest.mark.parametrize("typed", ["39", "2521", "wide", "nan"])
def test_degrees_that_no_wheel_turns_are_refused_and_asked_again(typed: str, t500: CockpitProfile) -> None:
    person = Person(t500, degrees=typed)
    person.gives_up_after = ("degrees", 3)
    with pytest.raises(KeyboardInterrupt):
        person.wizard.run("by hand")
    assert sum(f"degrees: value {typed}: 40 to 2520" in line for line in person.said) == 2


def test_throttle_cannot_be_skipped(t500: CockpitProfile) -> None:
    person = Person(t500, throttle=SKIP)
    assert person.wizard.run("by hand").pedals.throttle.axis == 1, "what was typed there means: go on"


def test_giving_up_ends_it_at_once(t500: CockpitProfile) -> None:
    person = Person(t500, brake=QUIT)
    with pytest.raises(KeyboardInterrupt):
        person.wizard.run("by hand")
    assert person.steps[-1] == "brake"
