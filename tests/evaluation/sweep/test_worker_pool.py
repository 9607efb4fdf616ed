import os
import signal
import threading
from pathlib import Path

import msgspec
import pytest

from simconsole.evaluation.sweep import worker_pool as pool_module
from simconsole.evaluation.sweep.driving import drive_task
from simconsole.evaluation.sweep.task import Task, TaskResult
from simconsole.evaluation.sweep.worker_pool import PoolWorker, WorkerPool
from tests.evaluation.sweep.plans import grip
from tests.patience import wait_until


def test_a_worker_drives_one_task_after_the_other_as_this_process_does(tmp_path: Path) -> None:
    first, *_, last = grip(tmp_path).tasks
    worker = PoolWorker()
    try:
        assert [worker.drive(first), worker.drive(last)] == [drive_task(first), drive_task(last)]
    finally:
        worker.close()


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
        (worker,) = pool._all - {pool._of_thread.worker}
        os.kill(worker._process.pid, signal.SIGKILL)
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
    monkeypatch.setattr(pool_module, "PoolWorker", Dying)
    result = WorkerPool().drive(grip(tmp_path).tasks[0])
    assert (result.outcome, Dying.started) == ("crashed", 2)


def test_a_closed_pool_starts_no_others(tmp_path: Path) -> None:
    pool = WorkerPool()
    pool.close()
    with pytest.raises(InterruptedError):
        pool.drive(grip(tmp_path).tasks[0])
