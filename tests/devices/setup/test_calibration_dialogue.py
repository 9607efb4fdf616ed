"""Calibration: virtual devices turned round in every way come out as they are; by functions and through a terminal."""

import os
import pty
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import msgspec
import pytest

from simconsole.devices.setup.calibration_dialogue import calibrate_devices
from simconsole.devices.setup.device_commands import Pace
from simconsole.profiles.device import Buttons, CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.values.errors import DeviceError
from tests.paths import ROOT
from tests.patience import PATIENCE_S


def at_once(tick_hz: int) -> Pace:
    return lambda tick: None


def answers(cockpit: CockpitProfile | None = None, **special: str) -> Callable[[str], str]:
    """Enter to everything but the steps whose text holds a word; buttons that the cockpit lacks are skipped."""
    names = [] if cockpit is None else Buttons.__struct_fields__
    missing = [name for name in names if getattr(cockpit.buttons, name) is None]  # type: ignore[union-attr]
    special = {**special, **{f"for {name.replace('_', ' ').upper()}": "s" for name in missing}}

    def ask(text: str) -> str:
        return next((answer for word, answer in special.items() if word in text), "")

    return ask


def quiet(line: str) -> None:
    return


def turned_round(cockpit: CockpitProfile) -> CockpitProfile:
    """The same devices with pedals and wheel the other way round, off centre, pedals on other axes."""
    replace = msgspec.structs.replace
    pedals = cockpit.pedals
    assert pedals.clutch is not None
    return replace(
        cockpit,
        wheel=replace(cockpit.wheel, grows_to="left", centre_raw=0.06, lock_to_lock_deg=720.0),
        pedals=replace(
            pedals,
            throttle=replace(pedals.throttle, axis=3, rest_raw=-0.9, full_raw=0.7),
            brake=replace(pedals.brake, axis=2, rest_raw=0.4, full_raw=-0.6),
            clutch=replace(pedals.clutch, axis=1, rest_raw=0.0, full_raw=1.0),
        ),
    )


@pytest.mark.parametrize("name", ["t500rs_th8rs", "t300rs_th8a", "g29"])
def test_shipped_cockpit_is_learnt_as_it_is(name: str, sdl: None, tmp_path: Path) -> None:
    true = load("devices", name, CockpitProfile)
    path = tmp_path / "mine.yaml"
    said: list[str] = []
    special = {"HANDBRAKE": "s", "GEAR 7": "s"} if name == "g29" else {"HANDBRAKE": "s"}
    calibrate_devices(true, path, say=said.append, ask=answers(true, **special), virtual=true, pace=at_once)
    learnt = load("devices", str(path), CockpitProfile)
    assert [(role.role, role.vendor_id, role.product_id) for role in learnt.roles] == [
        (role.role, role.vendor_id, role.product_id) for role in true.roles
    ]
    assert (learnt.wheel.axis, learnt.wheel.grows_to) == (true.wheel.axis, true.wheel.grows_to)
    assert learnt.wheel.lock_to_lock_deg == pytest.approx(true.wheel.lock_to_lock_deg, rel=1e-3)
    for pedal in ("throttle", "brake", "clutch"):
        assert getattr(learnt.pedals, pedal).axis == getattr(true.pedals, pedal).axis
        assert getattr(learnt.pedals, pedal).full_raw == pytest.approx(-0.98, abs=1e-3)
    assert learnt.pedals.handbrake is None
    assert (learnt.shifter.gears, learnt.shifter.reverse) == (true.shifter.gears, true.shifter.reverse)
    assert learnt.buttons == true.buttons
    assert learnt.force_feedback == true.force_feedback
    assert learnt.provenance["pedals"].status == "captured"
    assert learnt.provenance["force_feedback.level_pushes"].status == "unverified"
    assert not [line for line in said if "again" in line]


def test_devices_that_are_turned_round_are_learnt(sdl: None, tmp_path: Path, t500: CockpitProfile) -> None:
    true, path = turned_round(t500), tmp_path / "mine.yaml"
    ask = answers(true, HANDBRAKE="s", degrees="720")
    calibrate_devices(t500, path, say=quiet, ask=ask, virtual=true, pace=at_once)
    learnt = load("devices", str(path), CockpitProfile)
    assert learnt.wheel.grows_to == "left"
    assert learnt.wheel.centre_raw == pytest.approx(0.06, abs=1e-3)
    assert learnt.pedals.throttle.rest_raw == pytest.approx(-0.9, abs=1e-3)
    assert learnt.pedals.throttle.full_raw == pytest.approx(0.684, abs=1e-3)
    assert (learnt.pedals.throttle.axis, learnt.pedals.brake.axis) == (3, 2)


def test_gamepad_with_paddles_and_no_lever(sdl: None, tmp_path: Path) -> None:
    true, path = load("devices", "gamepad", CockpitProfile), tmp_path / "mine.yaml"
    ask = answers(true, HANDBRAKE="s", Sequential="s")
    calibrate_devices(true, path, say=quiet, ask=ask, virtual=true, pace=at_once)
    learnt = load("devices", str(path), CockpitProfile)
    assert learnt.shifter.pattern == "sequential"
    assert learnt.buttons == true.buttons
    assert learnt.force_feedback is None


def test_step_that_fails_is_asked_again_until_the_person_gives_up(
    sdl: None, tmp_path: Path, t500: CockpitProfile
) -> None:
    said: list[str] = []

    def ask(text: str) -> str:
        refused = len([line for line in said if "again, please: axes: value none moved" in line])
        # The person insists on a handbrake that is not there: Enter alone would skip it.
        return "q" if refused == 7 else "now" if "HANDBRAKE" in text else ""

    with pytest.raises(KeyboardInterrupt):
        calibrate_devices(t500, tmp_path / "x.yaml", say=said.append, ask=ask, virtual=t500, pace=at_once)
    assert not (tmp_path / "x.yaml").exists()


def test_the_next_call_goes_on_where_the_last_one_was_left(sdl: None, tmp_path: Path, t500: CockpitProfile) -> None:
    path, asked = tmp_path / "mine.yaml", []
    with pytest.raises(KeyboardInterrupt):
        calibrate_devices(
            t500, path, say=quiet, ask=answers(t500, HANDBRAKE="s", REVERSE="q"), virtual=t500, pace=at_once
        )
    answered = answers(t500, HANDBRAKE="s")

    def ask(text: str) -> str:
        asked.append(text)
        return answered(text)

    said: list[str] = []
    calibrate_devices(t500, path, say=said.append, ask=ask, virtual=t500, pace=at_once)
    assert any("goes on after gear 7" in line for line in said)
    assert not any(word in text for text in asked for word in ("to the LEFT", "THROTTLE", "GEAR 7"))
    assert any("REVERSE" in text for text in asked)
    assert load("devices", str(path), CockpitProfile).buttons == t500.buttons
    assert list(tmp_path.iterdir()) == [path]


def test_a_shipped_wheel_keeps_its_motor(sdl: None, tmp_path: Path, t500: CockpitProfile) -> None:
    g29 = load("devices", "g29", CockpitProfile)
    ask = answers(g29, **{"HANDBRAKE": "s", "GEAR 7": "s"})
    path = tmp_path / "mine.yaml"
    calibrate_devices(t500, path, say=quiet, ask=ask, virtual=g29, pace=at_once, known=[g29])
    learnt = load("devices", str(path), CockpitProfile)
    assert (learnt.force_feedback, learnt.wheel.lock_to_lock_deg) == (g29.force_feedback, 900.0)


def test_a_shipped_gamepad_keeps_what_no_step_can_learn(sdl: None, tmp_path: Path, t500: CockpitProfile) -> None:
    """Its curves and its steering assistance: a stick without them would throw the car about."""
    pad = load("devices", "gamepad", CockpitProfile)
    limits = msgspec.structs.replace(pad.limits, stale_s=0.3)
    shifter = msgspec.structs.replace(pad.shifter, top_gear=5)
    pad = msgspec.structs.replace(pad, limits=limits, shifter=shifter)
    path = tmp_path / "mine.yaml"
    ask = answers(pad, HANDBRAKE="s", lever="s", pattern="s")
    calibrate_devices(t500, path, say=quiet, ask=ask, virtual=pad, pace=at_once, known=[pad])
    learnt = load("devices", str(path), CockpitProfile)
    assert learnt.wheel.assistance == pad.wheel.assistance is not None
    assert (learnt.wheel.curve, learnt.wheel.dead_zone, learnt.wheel.rate_filter_s) == (1.8, 0.1, 0.05)
    throttle = learnt.pedals.throttle
    assert (throttle.axis, throttle.curve, throttle.dead_zone) == (5, 1.5, 0.04)
    assert (learnt.shifter, learnt.limits) == (shifter, limits)
    assert learnt.provenance["pedals.throttle.curve"] == pad.provenance["pedals.throttle.curve"]
    assert learnt.provenance["pedals"].status == "captured"


def test_giving_up_writes_nothing_and_an_old_profile_is_spared(sdl: None, tmp_path: Path, t500: CockpitProfile) -> None:
    path = tmp_path / "mine.yaml"
    with pytest.raises(KeyboardInterrupt):
        calibrate_devices(t500, path, say=quiet, ask=answers(BRAKE="q"), virtual=t500, pace=at_once)
    assert not path.exists()
    path.write_text("old")
    with pytest.raises(DeviceError, match="file: value exists"):
        calibrate_devices(t500, path, say=quiet, ask=answers(), virtual=t500, pace=at_once)
    assert path.read_text() == "old"


def test_nobody_there_to_answer_is_one_line(sdl: None, tmp_path: Path, t500: CockpitProfile) -> None:
    def nobody(text: str) -> str:
        raise EOFError

    with pytest.raises(DeviceError, match="an answer to every question"):
        calibrate_devices(t500, tmp_path / "x.yaml", say=quiet, ask=nobody, virtual=t500, pace=at_once)


def test_no_devices_is_said(sdl: None, tmp_path: Path, t500: CockpitProfile) -> None:
    with pytest.raises(DeviceError, match="none connected"):
        calibrate_devices(t500, tmp_path / "x.yaml", say=quiet, ask=answers(), pace=at_once)


def terminal(*words: str, folder: Path, answer: Callable[[str], str | None]) -> tuple[int, str]:
    """Run a command on a terminal of its own; `answer` sees what was printed since the last answer."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "simconsole", *words]
    process = subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs, cwd=folder, env=environment)
    os.close(theirs)
    seen, pending = "", ""
    while True:
        try:
            chunk = os.read(ours, 4096).decode()
        except OSError:  # the other end has closed it
            break
        if not chunk:
            break
        seen, pending = seen + chunk, pending + chunk
        typed = answer(pending)
        if typed is not None:
            pending = ""
            os.write(ours, typed.encode())
    os.close(ours)
    return process.wait(timeout=PATIENCE_S), seen


def test_whole_calibration_in_a_terminal(tmp_path: Path) -> None:
    """Each step is taken as it is held still; keys are for what there is not, and for what is asked in words."""

    def answer(text: str) -> str | None:
        last, asked = text.replace("\r", "").rsplit("\n", 2)[-2:] if "\n" in text else ("", text)
        if asked.endswith((". ", "] ")):
            return "\n"
        return "s" if not asked and "HANDBRAKE" in last else None

    words = ("devices", "calibrate", "--virtual", "--out", "mine.yaml")
    code, seen = terminal(*words, folder=tmp_path, answer=answer)
    assert code == 0, seen
    assert "mine.yaml: written" in seen
    assert seen.count("Hold the button") == len(Buttons.__struct_fields__)
    learnt = load("devices", str(tmp_path / "mine.yaml"), CockpitProfile)
    assert learnt.shifter.gears == [0, 1, 2, 3, 4, 5, 6]
    code, seen = terminal(
        "devices",
        "check",
        "--virtual",
        "--for",
        "1",
        "--cockpit",
        "mine.yaml",
        folder=tmp_path,
        answer=lambda text: None,
    )
    assert "throttle  [" in seen, "live bars"
    assert "\x1b[6A" in seen, "drawn over themselves"
    assert code == 0, seen


@pytest.mark.parametrize("name", ["t500rs_th8rs", "g29"])
def test_enter_alone_learns_a_virtual_cockpit_with_what_it_has(name: str, sdl: None, tmp_path: Path) -> None:
    shipped = load("devices", name, CockpitProfile)
    path = tmp_path / "cockpit.yaml"
    calibrate_devices(shipped, path, say=quiet, ask=lambda text: "", virtual=shipped, pace=at_once)
    learnt = load("devices", str(path), CockpitProfile)
    assert learnt.pedals.handbrake is None
    assert (learnt.shifter.gears, learnt.shifter.reverse) == (shipped.shifter.gears, shipped.shifter.reverse)
    for role in Buttons.__struct_fields__:
        assert (getattr(learnt.buttons, role) is None) == (getattr(shipped.buttons, role) is None)
