from pathlib import Path

import pyarrow.parquet
from msgspec.structs import replace

from simconsole.evaluation.sweep.plan import Plan
from simconsole.evaluation.sweep.results import results_table, write_results
from simconsole.evaluation.sweep.task import TaskResult
from simconsole.profiles.sweep import Value
from tests.evaluation.sweep.plans import grip


def some(plan: Plan) -> dict[int, TaskResult]:
    driven = {
        task.index: TaskResult(index=task.index, outcome="driven", ticks=5, digest="ab", metrics={"a_m": task.index})
        for task in plan.tasks
    }
    return driven | {1: TaskResult(index=1, outcome="crashed", detail="twice")}


def test_a_row_for_each_drive_in_the_order_of_the_plan(tmp_path: Path) -> None:
    plan = grip(tmp_path)
    found = some(plan)
    shuffled = {index: found[index] for index in (3, 1, 0, 2)}
    rows = results_table(plan, shuffled).to_pylist()
    assert [row["index"] for row in rows] == [0, 1, 2, 3]
    assert [row["outcome"] for row in rows] == ["driven", "crashed", "driven", "driven"]
    assert [row["metrics.a_m"] for row in rows] == [0.0, None, 2.0, 3.0]
    assert rows[3]["environment.friction"] == 1.0


def test_equal_results_are_equal_files_whatever_came_first(tmp_path: Path) -> None:
    plan = grip(tmp_path)
    found = some(plan)
    write_results(tmp_path / "one.parquet", plan, found)
    write_results(tmp_path / "two.parquet", plan, dict(reversed(found.items())))
    assert (tmp_path / "one.parquet").read_bytes() == (tmp_path / "two.parquet").read_bytes()
    assert pyarrow.parquet.read_table(tmp_path / "one.parquet").num_rows == 4


def test_words_and_switches_keep_their_types(tmp_path: Path) -> None:
    plan = grip(tmp_path)
    words: tuple[Value, ...] = ("dry", True, 1.0, 2)
    tasks = (replace(task, values={plan.keys[0]: word}) for task, word in zip(plan.tasks, words, strict=True))
    mixed = plan._replace(tasks=tuple(tasks))
    assert results_table(mixed, some(plan)).column("environment.friction").to_pylist() == ["dry", "True", "1.0", "2"]
