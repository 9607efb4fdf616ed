import os
from contextlib import closing
from pathlib import Path

from simconsole.evaluation.sweep.driving import drive_task
from simconsole.evaluation.sweep.local_engine import drive_here
from simconsole.evaluation.sweep.task import TaskResult
from tests.evaluation.sweep.clusters import kill, pool_workers_of
from tests.evaluation.sweep.plans import grip
from tests.patience import wait_until


def by_index(results: list[TaskResult]) -> list[TaskResult]:
    return sorted(results, key=lambda result: result.index)


def test_workers_of_this_machine_give_what_one_process_gives_though_two_are_killed(tmp_path: Path) -> None:
    tasks = grip(tmp_path, 8, duration_s=20.0).tasks
    with closing(drive_here(tasks, 2)) as driven:
        results = [next(driven)]
        wait_until(lambda: len(pool_workers_of(os.getpid())) == 3, "the first and two copies")
        first, one, _ = pool_workers_of(os.getpid())
        kill(first)
        kill(one)
        results += driven
    assert by_index(results) == [drive_task(task) for task in tasks]
    wait_until(lambda: not pool_workers_of(os.getpid()), "the workers' end")


def test_a_sweep_that_is_given_up_leaves_no_process(tmp_path: Path) -> None:
    driven = drive_here(grip(tmp_path, 8).tasks, 2)
    next(driven)
    driven.close()
    wait_until(lambda: not pool_workers_of(os.getpid()), "the workers' end")
