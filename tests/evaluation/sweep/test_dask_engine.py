import os
from collections.abc import Generator, Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
import pytest

from simconsole.evaluation.sweep import dask_engine
from simconsole.evaluation.sweep.dask_engine import batch_size, check_version, drive_lines, drive_on_dask
from simconsole.evaluation.sweep.driving import drive_task
from simconsole.evaluation.sweep.task import Task, TaskResult, from_bytes
from simconsole.values.errors import SimConsoleError
from tests.evaluation.sweep.clusters import cluster, pool_workers_of
from tests.evaluation.sweep.plans import grip

if TYPE_CHECKING:
    from distributed import LocalCluster


def by_index(results: Sequence[TaskResult]) -> list[TaskResult]:
    return sorted(results, key=lambda result: result.index)


sizes: list[int] = []
"""Of the batches that `counted` had."""


def another(version: str) -> None:
    """What a worker does that has another version."""
    check_version("another than " + version)


def counted(lines: Sequence[bytes], version: str, sweep: str) -> list[bytes]:
    sizes.append(len(lines))
    return drive_lines(lines, version, sweep)


def deadly(lines: Sequence[bytes], version: str, sweep: str) -> list[bytes]:
    """Drive nothing, but end with the sixth of all tasks."""
    from tests.evaluation.sweep.deadly import Deadly

    indices = [from_bytes(line).index for line in lines]
    if 5 in indices:
        raise Deadly
    return [msgspec.json.encode(TaskResult(index=index, outcome="driven")) for index in indices]


@contextmanager
def local_cluster(workers: int) -> "Iterator[LocalCluster]":
    """A scheduler and workers of one thread each, all in this process."""
    from distributed import LocalCluster

    with LocalCluster(  # type: ignore[no-untyped-call]
        n_workers=workers, threads_per_worker=1, processes=False, protocol="tcp://", dashboard_address=":0"
    ) as there:
        yield there


@contextmanager
def scheduler() -> Iterator[str]:
    """The address of one with a worker."""
    with local_cluster(1) as there:
        yield there.scheduler_address


def driven_on(url: str, tasks: Sequence[Task]) -> Generator[TaskResult, None, None]:
    return drive_on_dask(tasks, url, pytest.fail)


def test_dasks_workers_give_the_same_though_one_is_killed(tmp_path: Path) -> None:
    tasks = grip(tmp_path, 16).tasks
    with cluster(tmp_path, 2) as there, closing(driven_on(there.url, tasks)) as driven:
        results = [next(driven)]
        there.workers[0].kill()
        results += driven
    assert by_index(results) == [drive_task(task) for task in tasks]


def test_a_scheduler_that_ends_is_one_line(tmp_path: Path) -> None:
    with cluster(tmp_path, 1) as there, closing(driven_on(there.url, grip(tmp_path, 24).tasks)) as driven:
        next(driven)
        there.scheduler.kill()
        with pytest.raises(SimConsoleError, match=f"--scheduler: value {there.url}: it has ended"):
            list(driven)


def test_a_worker_of_another_version_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_engine, "check_version", another)
    with scheduler() as url, pytest.raises(SimConsoleError, match=f"{url}: ImportError: a worker: "):
        list(driven_on(url, grip(tmp_path, 2).tasks))
    with pytest.raises(ImportError, match="this machine another"):
        drive_lines((), "another", "sweep")


def test_a_sweep_waits_for_the_first_worker_and_says_so(tmp_path: Path) -> None:
    tasks, lines = grip(tmp_path, 2, duration_s=1.0).tasks, list[str]()
    with local_cluster(0) as there:

        def told(line: str) -> None:
            lines.append(line)
            there.scale(1)  # type: ignore[no-untyped-call]

        results = list(drive_on_dask(tasks, there.scheduler_address, told))
        url = there.scheduler_address
        assert lines == [f"sweep: {url} has no workers yet; waiting for one (dask worker {url})"]
    assert by_index(results) == [drive_task(task) for task in tasks]


def test_a_sweep_that_ends_leaves_the_processes_of_another_alone(tmp_path: Path) -> None:
    """Both drive in one thread: the short one's two drives, the long one's first, and the long one goes on alone."""
    short, long = grip(tmp_path / "short", 2, duration_s=1.0).tasks, grip(tmp_path / "long", 8, duration_s=1.0).tasks
    with scheduler() as url, closing(driven_on(url, short)) as one, closing(driven_on(url, long)) as other:
        found = [next(one)]
        results = [next(other)]
        both = set(pool_workers_of(os.getpid()))
        found += one
        left = both & set(pool_workers_of(os.getpid()))
        assert left, "those of the other"
        assert left < both, "it has ended its own"
        results += other
    assert by_index(found) == [drive_task(task) for task in short]
    assert by_index(results) == [drive_task(task) for task in long]
    assert not pool_workers_of(os.getpid())


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
        results = list(driven_on(url, tasks))
    assert by_index(results) == [drive_task(task) for task in tasks]
    assert sorted(sizes) == [1, 1, 1, 1, 2, 2, 2, 2]


def test_a_batch_that_costs_every_worker_loses_the_one_drive_that_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dask_engine, "drive_lines", deadly)
    with scheduler() as url:
        results = list(driven_on(url, grip(tmp_path, 16).tasks))
    outcomes = [result.outcome for result in by_index(results)]
    assert outcomes == ["driven"] * 5 + ["crashed"] + ["driven"] * 10
