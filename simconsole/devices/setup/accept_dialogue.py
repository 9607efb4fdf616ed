"""`simconsole devices accept`: everything that a real cockpit must show, step by step, with a report to send in."""

import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final, NamedTuple

import msgspec

from simconsole.devices.calibration.cockpit_settings import GEARS
from simconsole.devices.calibration.wizard import QUIT, SKIP
from simconsole.devices.setup.calibration_dialogue import calibrate_devices
from simconsole.devices.setup.cockpit_trials import Trials, Verdict
from simconsole.devices.setup.device_commands import Pace, Say, answer, list_devices, realtime
from simconsole.devices.setup.force_feedback_check import check_force_feedback
from simconsole.devices.setup.identify_dialogue import Weight, identify_motor
from simconsole.profiles.device import Buttons, CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.values.errors import DeviceError
from simconsole.values.host.files import write_atomically
from simconsole.values.signals import DeviceSample

CALIBRATED: Final = "calibrated.yaml"
ACCEPTED: Final = "cockpit.yaml"
REPORT: Final = "report.json"
MOST_TRIES: Final = 5
"""Times that virtual hands are asked the same before they give up."""

Stops = Callable[[CockpitProfile, Sequence[DeviceSample]], Verdict]
"""Drives a console with what a cockpit sent and says whether it went into its emergency stop and let the wheel go."""


class Terminal(NamedTuple):
    """How a person answers."""

    ask: Callable[[str], str]
    pressed: Callable[[], bool]
    typed: Callable[[], str] | None  # None: steps of the calibration are answered by Enter


class _Report:
    """The steps so far."""

    def __init__(self, say: Say, terminal: Terminal, virtual: bool, host: dict[str, str]) -> None:
        self._say = say
        self._terminal = terminal
        self.steps: list[dict[str, Any]] = []
        self._head = {
            "schema": 1,
            "made_by": "simconsole devices accept",
            "date": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
            "virtual": virtual,
            "host": host,
        }

    def step(self, name: str, do: Callable[[], Verdict]) -> bool:
        """Do one step, again if the person wants to, and keep its verdict; a device that fails is one, too."""
        tries = 0
        while tries == 0 or self._again(name):
            tries += 1
            self._say(f"--- {name}")
            try:
                verdict = do()
            except DeviceError as error:
                verdict = Verdict(False, str(error), {})
            self._say(f"{name}: {verdict.how}: {'good' if verdict.ok else 'WRONG'}")
            if verdict.ok:
                break
        self.steps.append({"name": name, "tries": tries, **verdict._asdict()})
        return verdict.ok

    def _again(self, name: str) -> bool:
        """Ask whether a step that went wrong is done once more; nobody is asked who cannot answer."""
        if self._terminal.typed is None:
            return False
        question = f"{name}: Enter tries it once more, {SKIP} leaves it so, {QUIT} gives up for now: "
        typed = answer(self._terminal.ask, question).strip().lower()
        if typed == QUIT:
            raise KeyboardInterrupt
        return typed != SKIP

    def write(self, path: Path, profile: CockpitProfile | None) -> dict[str, Any]:
        """Write what there is.

        Raises:
            DeviceError: the file cannot be written.
        """
        profile_part = (
            {} if profile is None else {"profile": ACCEPTED, "provenance": msgspec.to_builtins(profile.provenance)}
        )
        ok = profile is not None and all(step["ok"] for step in self.steps)
        report = {**self._head, "ok": ok, "steps": self.steps, **profile_part}
        try:
            write_atomically(path, msgspec.json.format(msgspec.json.encode(report)), durable=False)
        except OSError as error:
            raise DeviceError(f"{path}: file: {error.strerror}: a file that can be written") from error
        return report


def accept_cockpit(
    base: CockpitProfile,
    folder: Path,
    terminal: Terminal,
    *,
    say: Say,
    stops: Stops,
    host: dict[str, str],
    known: Sequence[CockpitProfile] = (),
    weight: Weight | None = None,
    virtual: bool = False,
    pace: Callable[[int], Pace] = realtime,
) -> dict[str, Any]:
    """Guide a person through everything that a cockpit must show; write its profile and a report.

    Args:
        base: The profile to begin with.
        folder: Gets the profile and the report; where it is that of an acceptance that was given up, what was
            calibrated there is not asked again.
        terminal: How the person answers; not asked where `virtual`.
        say: Prints a line.
        stops: Judges the emergency stop.
        host: Program, machine and libraries, for the report.
        known: Profiles of wheels that are known.
        weight: Gives the scale of the motor's torque.
        virtual: On virtual devices and a simulated wheel, which do what each step asks for.
        pace: Makes a pace for a rate.

    Returns:
        The report.

    Raises:
        DeviceError: the folder holds a profile already, or a file cannot be written.
        KeyboardInterrupt: the person gave up; the report holds the steps until then.
    """
    if (folder / ACCEPTED).exists():
        raise DeviceError(f"{folder / ACCEPTED}: file: value exists: a folder without one")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DeviceError(f"{folder}: folder: {error.strerror}: one that can be made") from error
    if virtual:
        terminal = Terminal(_obliging(base), lambda: False, None)
    report = _Report(say, terminal, virtual, host)
    accepted: list[CockpitProfile] = []
    try:
        _steps(report, base, folder, terminal, accepted, say, stops, known, weight, virtual, pace)
    finally:
        results = report.write(folder / REPORT, accepted[-1] if accepted else None)
    say(f"{folder / REPORT}: written; " + (f"with {ACCEPTED} it can be sent in as it is" if accepted else "no profile"))
    return results


def _obliging(cockpit: CockpitProfile) -> Callable[[str], str]:
    """Return answers of somebody who does everything that is asked, with a cockpit that lacks some buttons."""
    buttons = [name for name in Buttons.__struct_fields__ if getattr(cockpit.buttons, name) is None]
    lacks = [f"for {name.replace('_', ' ').upper()}" for name in buttons]
    lacks += [f"the {name.upper()}" for name in ("clutch", "handbrake") if getattr(cockpit.pedals, name) is None]
    lacks += [f"GEAR {gear}" for gear in range(len(cockpit.shifter.gears) + 1, GEARS + 1)]
    lacks += ["H pattern"] if cockpit.shifter.pattern == "sequential" else []
    asked: dict[str, int] = {}

    def ask(question: str) -> str:
        asked[question] = asked.get(question, 0) + 1
        if asked[question] > MOST_TRIES:
            return QUIT
        if any(word in question for word in lacks):
            return SKIP
        return "y" if "[y/n]" in question else ""

    return ask


def _steps(
    report: _Report,
    base: CockpitProfile,
    folder: Path,
    terminal: Terminal,
    accepted: list[CockpitProfile],
    say: Say,
    stops: Stops,
    known: Sequence[CockpitProfile],
    weight: Weight | None,
    virtual: bool,
    pace: Callable[[int], Pace],
) -> None:
    report.step("find", lambda: _found(base, say, virtual))
    calibrated = folder / CALIBRATED

    def calibrate() -> Verdict:
        if calibrated.exists():
            say(f"{calibrated}: goes on with it; delete it to begin anew")
            return Verdict(True, "learnt before", {})
        plugged = base if virtual else None
        results = calibrate_devices(
            base, calibrated, say=say, ask=terminal.ask, virtual=plugged, pace=pace, known=known, typed=terminal.typed
        )
        return Verdict(True, "learnt step by step", {"title": results["title"], "roles": results["roles"]})

    if not report.step("calibrate", calibrate):
        return
    cockpit = load("devices", str(calibrated), CockpitProfile)
    path = folder / ACCEPTED
    if cockpit.force_feedback is not None:
        report.step("feel", lambda: _felt(cockpit, terminal, say, virtual, pace))
        report.step("identify", lambda: _identified(cockpit, path, terminal, say, weight, virtual, pace))
    if path.exists():
        calibrated.unlink()
        cockpit = load("devices", str(path), CockpitProfile)
    else:
        calibrated.rename(path)
    accepted.append(cockpit)
    _try_out(report, cockpit, say, stops, virtual, pace)


def _found(base: CockpitProfile, say: Say, virtual: bool) -> Verdict:
    results = list_devices(base, say=say, virtual=virtual)
    there = bool(results["devices"])
    missing = results["missing_roles"]
    how = "all there" if there and not missing else f"for {base.title} missing: {', '.join(missing)}"
    return Verdict(there, how if there else "no device", {"devices": results["devices"]})


def _felt(cockpit: CockpitProfile, terminal: Terminal, say: Say, virtual: bool, pace: Callable[[int], Pace]) -> Verdict:
    results = check_force_feedback(
        cockpit, say=say, ask=terminal.ask, pressed=terminal.pressed, virtual=virtual, pace=pace
    )
    return Verdict(results["ok"], "every force, and it lets go" if results["ok"] else "not as it should", results)


def _identified(
    cockpit: CockpitProfile,
    path: Path,
    terminal: Terminal,
    say: Say,
    weight: Weight | None,
    virtual: bool,
    pace: Callable[[int], Pace],
) -> Verdict:
    path.unlink(missing_ok=True)  # of a try that was not good
    results = identify_motor(
        cockpit,
        path,
        say=say,
        ask=terminal.ask,
        pressed=terminal.pressed,
        weight=weight,
        virtual=virtual,
        pace=pace,
    )
    refusal = results["refusal"]
    how = f"autonomy is refused: {refusal}" if refusal else "found"
    return Verdict(not refusal, how, {**results, "profile": path.name})  # a report that is sent in names no folder


def _try_out(
    report: _Report, cockpit: CockpitProfile, say: Say, stops: Stops, virtual: bool, pace: Callable[[int], Pace]
) -> None:
    with ExitStack() as stack:
        trials = Trials(cockpit, virtual, pace, say, stack)
        report.step("rest", trials.rest)
        for pedal in trials.pedals:
            report.step(f"axis {pedal}", lambda pedal=pedal: trials.pedal(pedal))  # type: ignore[misc]
        report.step("axis wheel", trials.wheel)
        report.step("gears", trials.gears)
        report.step("buttons", trials.buttons)
        report.step("latency", trials.latency)
        report.step("hot-plug", trials.hot_plug)
        if cockpit.buttons.emergency_stop is not None:
            report.step("emergency stop", lambda: stops(cockpit, trials.emergency()))
