"""`simconsole sweep PLAN`: many drives of one plan into one table and one page."""

import shlex
from argparse import Namespace
from collections import Counter
from collections.abc import Generator, Sequence
from contextlib import closing
from pathlib import Path

from simconsole.cli.outcome import Outcome, table
from simconsole.cli.progress import Progress
from simconsole.evaluation.report.sweep_page import write_sweep_page
from simconsole.evaluation.sweep.dask_engine import drive_on_dask
from simconsole.evaluation.sweep.journal import Journal
from simconsole.evaluation.sweep.local_engine import drive_here
from simconsole.evaluation.sweep.plan import Plan, load_plan
from simconsole.evaluation.sweep.results import RESULTS, write_results
from simconsole.evaluation.sweep.task import GOOD, Task, TaskResult
from simconsole.values.errors import ProfileError

PAGE = "sweep.html"


def sweep(options: Namespace) -> Outcome:
    """Drive what of a plan is not driven yet; code 1 if a drive did not end well.

    Raises:
        ProfileError: the plan, or what it names, is missing or wrong; options that do not go together.
        RecordingError: the folder holds another plan's results, or cannot be written.
        SimConsoleError: no such scheduler.
    """
    if (options.engine == "dask") != (options.scheduler is not None):
        raise ProfileError("command line: --scheduler: with --engine dask, and only with it")
    plan = load_plan(Path(options.plan))
    if options.drive is not None:
        return _one(plan, options.drive, options.out)
    folder = Path(options.out or Path("out") / f"sweep-{Path(options.plan).stem}")
    with Journal(folder, plan) as journal:
        waiting = [task for task in plan.tasks if task.index not in journal.results]
        with Progress("sweep") as progress, closing(_driven(waiting, options, progress)) as driven:
            for result in driven:
                journal.add(result)
                progress.done(f"{len(plan.tasks)} drives", len(journal.results) / len(plan.tasks))
        results = journal.results
    write_results(folder / RESULTS, plan, results)
    write_sweep_page(folder / PAGE, plan, results, lambda index: _again(plan.tasks[index], options.plan, folder))
    outcomes = Counter(result.outcome for result in results.values())
    good = all(outcome in GOOD for outcome in outcomes)
    plain = {"folder": str(folder), "drives": len(results), "outcomes": dict(outcomes)}
    rows = [("folder", str(folder)), *((outcome, str(count)) for outcome, count in sorted(outcomes.items()))]
    return Outcome(0 if good else 1, plain, table(rows))


def _again(task: Task, plan: str, folder: Path) -> str:
    """Return the command that drives a task again into a bundle beside the results, and replays that where it can."""
    out = shlex.quote(str((folder / f"drive-{task.index}").absolute()))
    command = f"simconsole sweep {shlex.quote(str(Path(plan).absolute()))} --drive {task.index} --out {out}"
    of_many = task.scenario is not None and task.scenario.manoeuvre is not None
    return command if of_many else f"{command}; simconsole replay {out}"


def _driven(tasks: Sequence[Task], options: Namespace, progress: Progress) -> Generator[TaskResult, None, None]:
    if options.engine == "dask":
        return drive_on_dask(tasks, options.scheduler, progress.say)
    return drive_here(tasks, options.jobs)


def _one(plan: Plan, index: int, out: str | None) -> Outcome:
    """Drive one of the plan's drives in this process, and keep its bundle."""
    if not 0 <= index < len(plan.tasks):
        raise ProfileError(f"command line: --drive: value {index}: 0 to {len(plan.tasks) - 1}")
    from simconsole.evaluation.sweep.driving import (
        drive_into,
    )  # half of what a sweep would load, which drives elsewhere

    task, folder = plan.tasks[index], Path(out or Path("out") / f"sweep-drive-{index}")
    result = drive_into(task, folder)
    rows = [("drive", f"{index}: {task.source}"), ("ended", result.outcome), ("digest", result.digest)]
    rows += [(key, str(value)) for key, value in task.values.items()]
    rows += [("why", result.detail)] if result.detail else []
    rows += [("bundle", str(folder))] if folder.is_dir() else []
    plain = {"outcome": result.outcome, "digest": result.digest, "bundle": str(folder), "metrics": result.metrics}
    return Outcome(0 if result.outcome in GOOD else 1, plain, table(rows))
