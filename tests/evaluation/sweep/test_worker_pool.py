import os
import signal
import threading
from contextlib import closing
from pathlib import Path

import msgspec
import pytest

from simconsole.evaluation.sweep import pool_worker, worker_pool
from simconsole.evaluation.sweep.driving import drive_task
from simconsole.evaluation.sweep.pool_worker import StartedWorker
from simconsole.evaluation.sweep.task import Task, TaskResult
from simconsole.evaluation.sweep.worker_pool import WorkerPool
from tests.evaluation.sweep.plans import grip
from tests.patience import wait_until


def test_a_worker_and_its_copies_drive_one_task_after_the_other_as_this_process_does(tmp_path: Path) -> None:
    first, *_, last = grip(tmp_path).tasks
    wanted = [drive_task(first), drive_task(last)]
    with closing(StartedWorker()) as worker:
        assert [worker.drive(first), worker.drive(last)] == wanted
        copies = [worker.copy(), worker.copy()]
        for copy in copies:
            assert copy is not None
            with closing(copy):
                assert [copy.drive(first), copy.drive(last)] == wanted
            assert copy.drive(first) is None
        assert worker.drive(last) == wanted[1]


def test_a_worker_that_has_ended_has_no_copies() -> None:
    worker = StartedWorker()
    worker.close()
    with pytest.raises(ChildProcessError):
        worker.copy()


def test_a_worker_with_threads_is_not_copied_and_others_are_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a library that starts threads when it is loaded, as numpy's does."""
    monkeypatch.setattr(pool_worker, "_ONE_THREAD", {"OPENBLAS_NUM_THREADS": "2"})
    tasks = grip(tmp_path).tasks
    with closing(WorkerPool()) as pool:
        found = [pool.drive(tasks[0]), pool.drive(tasks[1])]
        assert len(pool._all) == 1
        other = threading.Thread(target=lambda: found.append(pool.drive(tasks[2])))
        other.start()
        other.join()
        assert {type(worker) for worker in pool._all} == {StartedWorker}
        assert len(pool._all) == 2
    assert found == [drive_task(task) for task in tasks[:3]]


def test_a_worker_that_is_killed_in_a_drive_loses_it_and_the_next_worker_drives_it(tmp_path: Path) -> None:
    (task, *_) = grip(tmp_path, duration_s=100.0).tasks
    pool = WorkerPool()
    found: list[TaskResult] = []
    short = msgspec.structs.replace(task, resolved=grip(tmp_path / "short").tasks[0].resolved)
    driving = threading.Thread(target=lambda: found.append(pool.drive(task)))
    try:
        pool.drive(short)  # of another thread, which stays
        driving.start()
        wait_until(lambda: len(pool._all) == 2, "a second worker")
        (worker,) = pool._all - {pool._first}
        os.kill(worker.pid, signal.SIGKILL)
        driving.join()
        assert found[0].outcome == "driven"
        assert worker not in pool._all
    finally:
        pool.close()


def test_a_drive_that_takes_too_long_is_given_up_twice(tmp_path: Path) -> None:
    (task, *_) = grip(tmp_path, duration_s=80_000.0, timeout_s=0.5).tasks
    pool = WorkerPool()
    try:
        result = pool.drive(task)
    finally:
        pool.close()
    assert (result.outcome, result.detail) == ("timed out", "twice, after 0.5 s")


class Dying:
    """A worker that always dies."""

    gave_up = False
    started = 0

    def __init__(self) -> None:
        Dying.started += 1

    def drive(self, task: Task) -> TaskResult | None:
        return None

    def close(self) -> None:
        pass


def test_a_drive_that_takes_every_worker_down_is_tried_twice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker_pool, "StartedWorker", Dying)
    result = WorkerPool().drive(grip(tmp_path).tasks[0])
    assert (result.outcome, Dying.started) == ("crashed", 2)


def test_a_closed_pool_starts_no_others(tmp_path: Path) -> None:
    pool = WorkerPool()
    pool.close()
    with pytest.raises(InterruptedError):
        pool.drive(grip(tmp_path).tasks[0])
