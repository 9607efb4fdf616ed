"""Accepting a virtual cockpit from end to end: its report, its profile, and what a failing step leaves."""

from collections.abc import Sequence
from pathlib import Path

import msgspec
import pytest

from simconsole.devices.setup.accept_dialogue import Terminal, _Report, accept_cockpit
from simconsole.devices.setup.cockpit_trials import Verdict
from simconsole.devices.setup.device_commands import unpaced
from simconsole.devices.setup.identify_dialogue import Weight
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load, names
from simconsole.session.emergency_check import stops
from simconsole.values.errors import DeviceError
from simconsole.values.signals import DeviceSample

pytestmark = pytest.mark.usefixtures("sdl")
STEPS = [
    *("find", "calibrate", "feel", "identify", "rest", "axis throttle", "axis brake", "axis clutch", "axis wheel"),
    *("gears", "buttons", "latency", "hot-plug", "emergency stop"),
]


def quiet(line: str) -> None:
    return


def nobody(question: str) -> str:
    raise AssertionError(question)


NOBODY = Terminal(nobody, lambda: False, None)


@pytest.mark.parametrize("name", ["t500rs_th8rs", "t300rs_th8a", "g29"])
def test_virtual_cockpit_is_accepted_from_end_to_end(name: str, tmp_path: Path) -> None:
    known = [load("devices", other, CockpitProfile) for other in names("devices")]
    folder = tmp_path / "acceptance"
    accept_cockpit(
        load("devices", name, CockpitProfile),
        folder,
        NOBODY,
        say=quiet,
        stops=stops,
        host={"simconsole": "0"},
        known=known,
        weight=Weight(0.8, 0.14),
        virtual=True,
        pace=unpaced,
    )
    report = msgspec.json.decode((folder / "report.json").read_bytes())
    assert [step["name"] for step in report["steps"]] == STEPS
    assert report["ok"], [step for step in report["steps"] if not step["ok"]]
    assert (report["virtual"], report["host"], report["profile"]) == (True, {"simconsole": "0"}, "cockpit.yaml")
    steps = {step["name"]: step["figures"] for step in report["steps"]}
    assert steps["identify"]["scale"].startswith("a weight of 0.8 kg")
    assert sum(steps["latency"]["at_most"].values()) >= steps["latency"]["readings"]
    assert steps["feel"]["forces"]["let go"]["ok"]
    learnt = load("devices", str(folder / "cockpit.yaml"), CockpitProfile)
    assert learnt.force_feedback is not None
    assert learnt.force_feedback.motor.identified == "weight"
    assert report["provenance"]["force_feedback.motor"]["status"] == "captured"
    assert str(tmp_path) not in (folder / "report.json").read_text(), (
        "it is sent in: it names no folder of this machine"
    )


def test_failing_step_is_in_the_report_and_the_others_go_on(t500: CockpitProfile, tmp_path: Path) -> None:
    def stays(cockpit: CockpitProfile, samples: Sequence[DeviceSample]) -> Verdict:
        return Verdict(False, "the console is in MANUAL", {})

    folder = tmp_path / "acceptance"
    report = accept_cockpit(
        t500, folder, NOBODY, say=quiet, stops=stays, host={}, known=[t500], virtual=True, pace=unpaced
    )
    assert not report["ok"]
    assert [step["name"] for step in report["steps"] if not step["ok"]] == ["emergency stop"]
    with pytest.raises(DeviceError, match="value exists: a folder without one"):
        accept_cockpit(t500, folder, NOBODY, say=quiet, stops=stays, host={}, virtual=True, pace=unpaced)


def test_cockpit_without_motor_and_lever_is_accepted(tmp_path: Path) -> None:
    pad = load("devices", "gamepad", CockpitProfile)
    report = accept_cockpit(
        pad, tmp_path, NOBODY, say=quiet, stops=stops, host={}, known=[pad], virtual=True, pace=unpaced
    )
    assert report["ok"], [step for step in report["steps"] if not step["ok"]]
    assert [step["name"] for step in report["steps"]] == [name for name in STEPS if name not in ("feel", "identify")]


class Person:
    """Somebody at a terminal, before a virtual cockpit: tries a step again, or gives up."""

    def __init__(self, answers: Sequence[str]) -> None:
        self.answers = list(answers)
        self.questions: list[str] = []

    def __call__(self, question: str) -> str:
        self.questions.append(question)
        return self.answers.pop(0)


@pytest.mark.parametrize(("answers", "tries", "ok"), [(["", ""], 3, True), (["s"], 1, False)])
def test_step_that_went_wrong_is_done_again(answers: list[str], tries: int, ok: bool) -> None:
    person = Person(answers)
    report = _Report(quiet, Terminal(person, lambda: False, lambda: ""), True, {})
    verdicts = [Verdict(False, "missing: horn", {}), Verdict(False, "missing: horn", {}), Verdict(True, "all", {})]
    assert report.step("buttons", lambda: verdicts.pop(0)) is ok
    assert [(step["name"], step["tries"], step["ok"]) for step in report.steps] == [("buttons", tries, ok)]
    assert all("buttons: Enter tries it once more" in question for question in person.questions)


def test_acceptance_that_was_given_up_goes_on_after_its_calibration(
    t500: CockpitProfile, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def key_pressed(*arguments: object, **named: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr("simconsole.devices.setup.accept_dialogue.check_force_feedback", key_pressed)
        with pytest.raises(KeyboardInterrupt):
            accept_cockpit(
                t500, tmp_path, NOBODY, say=quiet, stops=stops, host={}, known=[t500], virtual=True, pace=unpaced
            )
    assert {path.name for path in tmp_path.iterdir()} == {"calibrated.yaml", "report.json"}
    said: list[str] = []

    def stopped(cockpit: CockpitProfile, samples: Sequence[DeviceSample]) -> Verdict:
        return Verdict(True, "the console is in EMERGENCY_STOP", {})

    report = accept_cockpit(
        t500, tmp_path, NOBODY, say=said.append, stops=stopped, host={}, known=[t500], virtual=True, pace=unpaced
    )
    assert report["ok"]
    assert report["steps"][1]["how"] == "learnt before"
    assert not any("LEFT and hold" in line for line in said)
    assert {path.name for path in tmp_path.iterdir()} == {"cockpit.yaml", "report.json"}
