"""Drives one task of a sweep in this process: equal tasks give equal results."""

import tempfile
from pathlib import Path

from simconsole.evaluation.checks import manoeuvre_check
from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.evaluation.checks.scenario_check import Bound, drive_scenario
from simconsole.evaluation.checks.whole_drive import judge_metrics, judge_modes, modes_of, numbers_of
from simconsole.evaluation.metrics.table import drive_of, read_at_once
from simconsole.evaluation.sweep.kept import write_drive
from simconsole.evaluation.sweep.task import Task, TaskResult
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.provenance import Given
from simconsole.session import lifecycle
from simconsole.session.scripted.opening import as_driven
from simconsole.tick.advance import Console
from simconsole.values.errors import SimConsoleError, one_line


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
    found = dict(numbers_of(read_at_once(open_bundle(folder).log, result.ticks), task.resolved))
    return TaskResult(index=task.index, outcome="driven", ticks=result.ticks, digest=result.digest, metrics=found)


def trial_of(task: Task) -> str:
    """Return what a bundle says of which drive it is."""
    return f"{task.source} {task.index}"


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
