"""Drive one scenario headless and judge it: bounds on columns, its golden, the limits of its manoeuvre.

Worker of `simconsole check`.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from simconsole import golden
from simconsole.assembly import assemble
from simconsole.compiling import compiled
from simconsole.devices.script import ScriptSource
from simconsole.devices.settings import settings
from simconsole.drive import Cast, run
from simconsole.errors import ProfileError
from simconsole.faulting import with_faults
from simconsole.handling.attempt import Result
from simconsole.isolation import isolated
from simconsole.kernels import Row
from simconsole.manoeuvring import drive, judge_limit
from simconsole.memory import MemoryRecorder
from simconsole.pacing import UnpacedPacer
from simconsole.ports import DeviceSource, NobodySeated
from simconsole.profiles.manoeuvre import Limit, Manoeuvre
from simconsole.profiles.scenario import Check, ScenarioProfile
from simconsole.scripted import ScriptedCommands
from simconsole.session_files import load_scenario, resolve


class Verdict(NamedTuple):
    """What became of one scenario."""

    scenario: str
    passed: bool
    ticks: int
    digest: str
    problems: list[str]
    title: str = ""
    result: Result | None = None  # of a manoeuvre
    limits: tuple[Limit, ...] = ()


def check_scenario(name_or_path: str, update_golden: bool = False) -> Verdict:
    """Drive a scenario and compare; with `update_golden`, what was driven becomes the golden (bounds still count).

    A manoeuvre is judged by its characteristic values: it has no golden.

    Raises:
        ProfileError: scenario or golden cannot be read, or a bound names a column or value that there is not.
    """
    scenario, path = load_scenario(name_or_path)
    if scenario.manoeuvre is not None:
        return _check_manoeuvre(scenario, scenario.manoeuvre, path)
    recorder, columns = drive_scenario(scenario)
    tick_hz = scenario.session.mode.tick_hz
    judged = [judge(check, recorder.rows, columns, tick_hz, str(path)) for check in scenario.checks]
    problems = [problem for problem in judged if problem is not None]
    driven = golden.sample(recorder.rows, tick_hz, scenario.golden_hz, columns, recorder.digest.hex())
    golden_path = path.parent / "golden" / f"{path.stem}.csv"
    if update_golden:
        golden_path.parent.mkdir(exist_ok=True)
        golden_path.write_text(golden.write(driven), "utf-8")
    else:
        problems += _against_golden(golden_path, driven)
    return Verdict(path.stem, not problems, recorder.ticks, recorder.digest.hex(), problems, scenario.title)


def _check_manoeuvre(scenario: ScenarioProfile, manoeuvre: Manoeuvre, path: Path) -> Verdict:
    driven = drive(scenario, manoeuvre)
    problems = [driven.result.problem] if driven.result.problem is not None else []
    if not problems:
        judged = [judge_limit(limit, driven.result.values, str(path)) for limit in scenario.limits]
        problems = [problem for problem in judged if problem is not None]
    return Verdict(
        path.stem,
        not problems,
        driven.ticks,
        driven.digest,
        problems,
        scenario.title,
        driven.result,
        scenario.limits,
    )


def drive_scenario(scenario: ScenarioProfile) -> tuple[MemoryRecorder, tuple[str, ...]]:
    """Drive a scenario without files and return its rows and their columns."""
    resolved = resolve(scenario.session)
    console, state = assemble(resolved, compiled)
    tick_hz = console.tick_hz
    ticks = round(scenario.duration_s * tick_hz)
    devices: DeviceSource = NobodySeated()
    if scenario.script is not None:
        devices = ScriptSource(scenario.script, settings(resolved.cockpit, tick_hz), tick_hz=tick_hz)
    recorder = MemoryRecorder(ticks, console.width)
    commands = ScriptedCommands(scenario.remote, scenario.events, tick_hz)
    ecu = ScriptedCommands(scenario.ecu, scenario.ecu_events, tick_hz)
    cast = Cast(devices, commands, recorder, (), UnpacedPacer(), ecu=ecu)
    cast = isolated(with_faults(cast, resolved, tick_hz), UnpacedPacer)
    run(console, state, cast._replace(recorder=recorder), ticks)  # here a recorder that fails is a failure
    return recorder, console.columns


def judge(check: Check, rows: Row, columns: tuple[str, ...], tick_hz: int, origin: str) -> str | None:
    """Return what is wrong with one bound, None if it holds; `origin` (the scenario's file) opens an error.

    Raises:
        ProfileError: the bound names a column that no row has.
    """
    if check.column not in columns:
        raise ProfileError(f"{origin}: checks: column: value {check.column}: a column of a row, as in its golden")
    first, last = _ticks(check, len(rows), tick_hz)
    values = rows[first:last, columns.index(check.column)]
    low = -np.inf if check.min is None else check.min
    high = np.inf if check.max is None else check.max
    good = (values >= low) & (values <= high)  # so that NaN is never good
    if not len(values):
        return f"{check.column}: no tick from {first + 1} to {last}, the drive has {len(rows)}"
    if good.all():
        return None
    at = int(np.flatnonzero(~good)[0])
    return f"tick {first + at + 1}: {check.column}: {float(values[at])!r} not in {low} to {high}"


def _ticks(check: Check, ticks: int, tick_hz: int) -> tuple[int, int]:
    """Return the rows a bound looks at, the last one not included."""
    if check.at_s is not None:
        last = max(1, round(check.at_s * tick_hz))
        return last - 1, last
    return round(check.from_s * tick_hz), ticks if check.until_s is None else round(check.until_s * tick_hz)


def _against_golden(path: Path, driven: golden.Golden) -> list[str]:
    if not path.is_file():
        return [f"{path}: no golden; accept one with --update-golden"]
    accepted = golden.read(path.read_text("utf-8"), str(path))
    if accepted.hash == driven.hash and accepted.columns == driven.columns:
        return []
    difference = golden.first_difference(accepted, driven)
    if difference is None:
        return [f"{path}: hash {driven.hash}, accepted {accepted.hash}; no sampled value differs"]
    return [
        f"{path}: tick {difference.tick}: {difference.column}: "
        f"driven {difference.driven!r}, accepted {difference.accepted!r}"
    ]
