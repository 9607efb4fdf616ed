"""The table of a sweep: one row for each drive, in the plan's order, whoever drove them and in which order."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simconsole.evaluation.sweep.plan import Plan
from simconsole.evaluation.sweep.task import TaskResult
from simconsole.profiles.sweep import Value
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import replaced

if TYPE_CHECKING:
    import pyarrow

RESULTS: Final = "results.parquet"


def results_table(plan: Plan, results: Mapping[int, TaskResult]) -> "pyarrow.Table":
    """Return the table: index, source, what was varied, how it ended, ticks, digest, then every metric.

    A metric that a drive does not have is null. Values of one key are numbers where all of them are, else text.
    """
    import pyarrow

    tasks = [task for task in plan.tasks if task.index in results]
    found = [results[task.index] for task in tasks]
    columns: dict[str, pyarrow.Array] = {
        "index": pyarrow.array([task.index for task in tasks], pyarrow.int64()),
        "source": pyarrow.array([task.source for task in tasks], pyarrow.string()),
    }
    for key in plan.keys:
        columns[key] = _column([task.values[key] for task in tasks])
    columns["outcome"] = pyarrow.array([result.outcome for result in found], pyarrow.string())
    columns["detail"] = pyarrow.array([result.detail for result in found], pyarrow.string())
    columns["ticks"] = pyarrow.array([result.ticks for result in found], pyarrow.int64())
    columns["digest"] = pyarrow.array([result.digest for result in found], pyarrow.string())
    for name in metric_names(found):
        columns[f"metrics.{name}"] = pyarrow.array([result.metrics.get(name) for result in found], pyarrow.float64())
    return pyarrow.table(columns)


def metric_names(results: Sequence[TaskResult]) -> list[str]:
    """Return the names of all metrics, sorted."""
    return sorted({name for result in results for name in result.metrics})


def write_results(path: Path, plan: Plan, results: Mapping[int, TaskResult]) -> None:
    """Write the table as Parquet: equal drives give equal bytes.

    Raises:
        RecordingError: the file cannot be written.
    """
    import pyarrow.parquet

    try:
        with replaced(path) as draft:
            pyarrow.parquet.write_table(results_table(plan, results), draft, compression="zstd")
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error}") from error


def _column(values: Sequence[Value]) -> "pyarrow.Array":
    import pyarrow

    if all(isinstance(value, bool) for value in values):
        return pyarrow.array(values, pyarrow.bool_())
    if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values):
        return pyarrow.array([float(value) for value in values], pyarrow.float64())
    return pyarrow.array([str(value) for value in values], pyarrow.string())
