from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path

import msgspec
import pytest
from distributed import LocalCluster
from distributed.scheduler import KilledWorker

from simconsole.evaluation.sweep import dask_engine
from simconsole.evaluation.sweep.dask_engine import batch_size, check_version, drive_lines, drive_on_dask
from simconsole.evaluation.sweep.driving import drive_task
from simconsole.evaluation.sweep.task import TaskResult, from_bytes
from simconsole.values.errors import SimConsoleError
from tests.evaluation.sweep.clusters import cluster
from tests.evaluation.sweep.plans import grip


def by_index(results: Sequence[TaskResult]) -> list[TaskResult]:
    return sorted(results, key=lambda result: result.index)


class Deadly(KilledWorker):
    """What Dask says of a task that has cost too many workers."""

    def __init__(self) -> None:
        Exception.__init__(self)

    def __str__(self) -> str:
        return "deadly"


sizes: list[int] = []
"""Of the batches that `counted` had."""


def another(version: str) -> None:
    """What a worker does that has another version."""
    check_version("another than " + version)


def counted(lines: Sequence[bytes], version: str) -> list[bytes]:
    sizes.append(len(lines))
    return drive_lines(lines, version)


def deadly(lines: Sequence[bytes], version: str) -> list[bytes]:
    """Drive nothing, but end with the sixth of all tasks."""
    indices = [from_bytes(line).index for line in lines]
    if 5 in indices:
        raise Deadly
    return [msgspec.json.encode(TaskResult(index=index, outcome="driven")) for index in indices]


@contextmanager
def scheduler() -> Iterator[str]:
    """One with a worker of one thread, both in this process; its address."""
    with LocalCluster(  # type: ignore[no-untyped-call]
        n_workers=1, threads_per_worker=1, processes=False, protocol="tcp://", dashboard_address=":0"
    ) as there:
        yield there.scheduler_address


def test_dasks_workers_give_the_same_though_one_is_killed(tmp_path: Path) -> None:
    tasks = grip(tmp_path, 24).tasks
    with cluster(tmp_path, 2) as there, closing(drive_on_dask(tasks, there.url)) as driven:
        results = [next(driven)]
        there.workers[0].kill()
        results += driven
    assert by_index(results) == [drive_task(task) for task in tasks]


def test_a_scheduler_that_ends_is_one_line(tmp_path: Path) -> None:
    with cluster(tmp_path, 1) as there, closing(drive_on_dask(grip(tmp_path, 24).tasks, there.url)) as driven:
        next(driven)
        there.scheduler.kill()
        with pytest.raises(SimConsoleError, match=f"--scheduler: value {there.url}: it has ended"):
            list(driven)


def test_a_worker_of_another_version_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_engine, "check_version", another)
    with scheduler() as url, pytest.raises(SimConsoleError, match=f"{url}: ImportError: a worker: "):
        list(drive_on_dask(grip(tmp_path, 2).tasks, url))
    with pytest.raises(ImportError, match="this machine another"):
        drive_lines((), "another")


def test_batches_leave_each_thread_some_of_them() -> None:
    assert [batch_size(60, threads) for threads in (0, 1, 2, 8, 100)] == [15, 15, 7, 1, 1]
    assert batch_size(1000, 1) == 16


def test_no_drive_of_a_batch_is_begun_after_its_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is left of it is driven in the next ones: each has one result here."""
    monkeypatch.setattr(dask_engine, "_BATCH_S", 0.0)
    sizes.clear()
    monkeypatch.setattr(dask_engine, "drive_lines", counted)
    tasks = grip(tmp_path, 8, duration_s=1.0).tasks
    with scheduler() as url:
        results = list(drive_on_dask(tasks, url))
    assert by_index(results) == [drive_task(task) for task in tasks]
    assert sorted(sizes) == [1, 1, 1, 1, 2, 2, 2, 2]


def test_a_batch_that_costs_every_worker_loses_the_one_drive_that_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dask_engine, "drive_lines", deadly)
    with scheduler() as url:
        results = list(drive_on_dask(grip(tmp_path, 16).tasks, url))
    outcomes = [result.outcome for result in by_index(results)]
    assert outcomes == ["driven"] * 5 + ["crashed"] + ["driven"] * 10
