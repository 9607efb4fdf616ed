"""One drive of a sweep: what a worker is given, what it does, what it gives back. Equal tasks give equal results."""

import tempfile
from pathlib import Path
from typing import Final, Literal

import msgspec
import numpy as np

from simconsole.evaluation.checks import manoeuvre_check
from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.evaluation.checks.scenario_check import Bound, drive_scenario
from simconsole.evaluation.checks.whole_drive import judge_metrics, judge_modes, modes_of, numbers_of
from simconsole.evaluation.metrics.table import Drive, drive_of, recorded_drive
from simconsole.evaluation.sweep.kept import write_drive
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.sweep import Value
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.provenance import Given
from simconsole.session import lifecycle
from simconsole.session.scripted.opening import as_driven
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError, SimConsoleError, one_line

Outcome = Literal["driven", "passed", "failed", "refused", "crashed", "timed out"]
"""driven: a session to its end; passed, failed: a scenario's bounds or limits; refused: it cannot be driven, `detail`
says why; crashed, timed out: twice, so that the drive is lost."""

GOOD: Final = ("driven", "passed")
IN_MEMORY: Final = 1 << 23
"""Values of a drive, 64 MiB of them, up to which it is read at once."""


class Task(msgspec.Struct, frozen=True, kw_only=True):
    """One drive of a sweep, with every profile in full.

    Attributes:
        index: its place in the plan, from 0.
        source: the name of its session or scenario.
        values: what was changed, by dotted key.
        resolved: its session with these values.
        scenario: in the place of a session, a scenario, of which `resolved` is the session.
        timeout_s: after which it is given up.
    """

    index: int
    source: str
    values: dict[str, Value]
    resolved: ResolvedSession
    scenario: ScenarioProfile | None
    timeout_s: float


class TaskResult(msgspec.Struct, frozen=True, kw_only=True):
    """What came of a task.

    Attributes:
        index: that of the task.
        outcome: how it ended.
        detail: why, where it did not end well.
        ticks: that were driven.
        digest: chained hash of its state vectors.
        metrics: numbers by dotted name, the unit in each.
    """

    index: int
    outcome: Outcome
    detail: str = ""
    ticks: int = 0
    digest: str = ""
    metrics: dict[str, float] = msgspec.field(default_factory=dict)


def drive_task(task: Task) -> TaskResult:
    """Drive a task in this process, whose main thread this is; its bundle is not kept."""
    with tempfile.TemporaryDirectory(prefix="simconsole-") as folder:
        return _driven(task, Path(folder) / "bundle", kept=False)


def drive_into(task: Task, folder: Path) -> TaskResult:
    """Drive a task in this process into the new bundle `folder`; a manoeuvre, which is many drives, has none."""
    return _driven(task, folder, kept=True)


def _driven(task: Task, folder: Path, kept: bool) -> TaskResult:
    try:
        if task.scenario is None:
            return _session(task, folder)
        return _scenario(task, task.scenario, folder if kept else None)
    except (SimConsoleError, OSError) as error:
        return TaskResult(index=task.index, outcome="refused", detail=one_line(error))


def _session(task: Task, folder: Path) -> TaskResult:
    result = lifecycle.drive(task.resolved, folder, given=Given(trial=trial_of(task)).checked())
    if result.interrupted:
        raise KeyboardInterrupt
    if result.failure is not None:
        raise result.failure
    if result.recording_failure is not None:
        return TaskResult(index=task.index, outcome="refused", detail=result.recording_failure)
    found = dict(numbers_of(_read(folder), task.resolved))
    return TaskResult(index=task.index, outcome="driven", ticks=result.ticks, digest=result.digest, metrics=found)


def trial_of(task: Task) -> str:
    """Return what a bundle says of which drive it is."""
    return f"{task.source} {task.index}"


def _read(folder: Path) -> Drive:
    """Return the drive in a bundle: in memory if it is short, for its metrics read it a dozen times."""
    drive = recorded_drive(open_bundle(folder).log)
    if drive.ticks * len(drive.names) > IN_MEMORY:
        return drive
    names = sorted(drive.names)
    return drive_of(np.concatenate(list(drive.read(names))), names, drive.tick_hz, drive.first_tick)


def _scenario(task: Task, scenario: ScenarioProfile, folder: Path | None) -> TaskResult:
    """Drive a scenario and judge it; its drive is kept in `folder`, where there is one."""
    if scenario.manoeuvre is not None:
        return _manoeuvre(task, scenario)
    consoles: list[Console] = []

    def recorder_of(console: Console) -> MemoryRecorder:
        consoles.append(console)
        return MemoryRecorder(round(scenario.duration_s * console.tick_hz), console.width)

    problems: list[str] = []
    recorder = drive_scenario(scenario, recorder_of, task.resolved, problems.append)
    console = consoles[0]
    if folder is not None:
        driven = as_driven(scenario, task.resolved)
        write_drive(folder, driven, console, recorder.vectors, trial_of(task))
    bounds = [Bound(check, console.columns, console.tick_hz, task.source) for check in scenario.checks]
    for bound in bounds:
        for tick, vector in enumerate(recorder.vectors, start=1):
            bound.see(tick, vector)
    problems += [problem for bound in bounds if (problem := bound.problem(recorder.ticks)) is not None]
    drive = drive_of(recorder.vectors, console.columns, console.tick_hz)
    found = dict(numbers_of(drive, task.resolved))
    problems += judge_modes(scenario.modes, modes_of(drive)) + judge_metrics(scenario.metrics, found)
    return _judged(task, recorder.ticks, recorder.digest.hex(), found, problems)


def _manoeuvre(task: Task, scenario: ScenarioProfile) -> TaskResult:
    assert scenario.manoeuvre is not None
    driven = manoeuvre_check.drive(scenario, scenario.manoeuvre, task.resolved)
    values = driven.result.values
    if driven.result.problem is not None:
        problems = [driven.result.problem]
    else:
        judged = (manoeuvre_check.judge_limit(limit, values, task.source) for limit in scenario.limits)
        problems = [problem for problem in judged if problem is not None]
    return _judged(task, driven.ticks, driven.digest, dict(values), problems)


def _judged(task: Task, ticks: int, digest: str, found: dict[str, float], problems: list[str]) -> TaskResult:
    return TaskResult(
        index=task.index,
        outcome="failed" if problems else "passed",
        detail="; ".join(problems),
        ticks=ticks,
        digest=digest,
        metrics=found,
    )


def to_bytes(task: Task) -> bytes:
    """Return a task as one line of JSON."""
    return msgspec.json.encode(task)


def from_bytes(line: bytes) -> Task:
    """Return the task of such a line.

    Raises:
        ProfileError: it is none.
    """
    try:
        return msgspec.json.decode(line, type=Task)
    except msgspec.MsgspecError as error:
        raise ProfileError(f"task: {one_line(error)}") from error
