"""The drives of a sweep by the workers of a Dask scheduler.

Each task costs Dask processor time in scheduler, worker and client, 13 ms together: a tenth of a short drive. So a task
of Dask's is a batch of drives, as many as are driven in seconds.
"""

import asyncio
import threading
import time
from collections.abc import Callable, Collection, Generator, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Final

import msgspec

from simconsole.evaluation.sweep.task import Task, TaskResult, from_bytes, to_bytes
from simconsole.evaluation.sweep.worker_pool import WorkerPool
from simconsole.values.errors import SimConsoleError, one_line
from simconsole.values.version import __version__

_TRIES: Final = 3
"""How often Dask may give a batch to another worker because the one that had it has ended."""
_BATCH_S: Final = 2.0
"""After which a worker begins no other drive of a batch: so late are results at most, by one drive more."""
_LARGEST: Final = 16
_TURNS: Final = 4
"""So many batches for each thread: one that is faster, or comes later, takes of the others'."""


def drive_on_dask(
    tasks: Sequence[Task], scheduler: str, told: Callable[[str], None]
) -> Generator[TaskResult, None, None]:
    """Drive tasks by the workers of a scheduler (tcp://HOST:PORT); yield results as they come.

    A worker drives them in processes of its own, one for each of its threads. Drives of a worker that has ended go to
    the others. Files that sessions name, traces, scripts and road maps, must lie where this machine has them.

    Args:
        tasks: what is driven.
        scheduler: its address.
        told: is called with a line where there is no worker yet: the drives wait for one.

    Raises:
        SimConsoleError: no such scheduler, it has ended, it or a worker has no simconsole or another version of it, or
            Dask is not installed here (extra `dask`).
    """
    try:
        from distributed import CancelledError
    except ImportError as error:
        raise SimConsoleError(f"sweep: --engine dask: needs the extra `dask`: {error}") from None
    with _client(scheduler) as client:
        batches = _Batches(client)
        try:
            for failure in client.run(check_version, __version__, on_error="return").values():
                if failure is not None:  # it would end with its first drive
                    raise ImportError(f"a worker: {one_line(failure)}")
            threads = sum(client.nthreads().values())
            if threads == 0:
                told(f"sweep: {scheduler} has no workers yet; waiting for one (dask worker {scheduler})")
            batches.give(tasks, batch_size(len(tasks), threads))
            yield from batches.results()
        except CancelledError:
            raise SimConsoleError(f"sweep: --scheduler: value {scheduler}: it has ended") from None
        except (ImportError, RuntimeError) as error:  # of a worker; of a scheduler, which cannot read what it is given
            raise SimConsoleError(f"sweep: --scheduler: value {scheduler}: {one_line(error)}") from None
        finally:
            batches.end()


def batch_size(drives: int, threads: int) -> int:
    """Return how many drives are a batch, of so many for so many threads of all workers."""
    return min(max(drives // (_TURNS * max(threads, 1)), 1), _LARGEST)


class _Batches:
    """What the workers have of a sweep: a future of Dask's for each batch."""

    def __init__(self, client: Any) -> None:
        from distributed import as_completed

        self._client = client
        self._waiting: dict[Any, Sequence[Task]] = {}
        self._completed = as_completed(loop=client.loop)  # type: ignore[no-untyped-call]

    def give(self, tasks: Sequence[Task], size: int) -> None:
        """Give tasks to the workers, so many at a time."""
        for start in range(0, len(tasks), size):
            batch = tasks[start : start + size]
            future = self._client.submit(
                drive_lines, list(map(to_bytes, batch)), __version__, self._client.id, pure=False, retries=_TRIES
            )
            self._waiting[future] = batch
            self._completed.add(future)  # type: ignore[no-untyped-call]

    def results(self) -> Iterator[TaskResult]:
        """Yield all results as they come; what of a batch was not driven in time is given again, in smaller ones."""
        for future in self._completed:
            batch = self._waiting.pop(future)
            found = _results(future, batch)
            future.release()
            self.give(batch[len(found) :], max(len(found), 1))
            yield from found

    def end(self) -> None:
        """Take back what is not driven, and end the processes that drive."""
        if self._client.status == "running":
            self._client.cancel(list(self._waiting))
            others = set(self._client.run_on_scheduler(clients_of)) - {self._client.id}
            self._client.run(close_pools, others, on_error="ignore")


def _results(future: Any, batch: Sequence[Task]) -> list[TaskResult]:
    """Return what was driven of a batch: nothing if it has cost too many workers; each is then tried alone."""
    from distributed.scheduler import KilledWorker

    failure = future.exception()
    if failure is None:
        return [msgspec.json.decode(line, type=TaskResult) for line in future.result()]
    if not isinstance(failure, KilledWorker):
        raise failure
    if len(batch) > 1:
        return []
    return [TaskResult(index=batch[0].index, outcome="crashed", detail="its workers have ended")]


@contextmanager
def _client(scheduler: str) -> Iterator[Any]:
    from distributed import Client

    try:
        asyncio.run(_reach(scheduler))
        client = Client(scheduler, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise SimConsoleError(f"sweep: --scheduler: value {scheduler}: {error}") from None
    with client:
        yield client


async def _reach(scheduler: str) -> None:
    """Connect to a scheduler: a client that cannot would hold up the process's end for a minute."""
    from distributed.comm.core import connect

    comm = await connect(scheduler)  # type: ignore[no-untyped-call]
    await comm.close()


def clients_of(dask_scheduler: Any) -> list[str]:
    """Return the ids of all clients of this scheduler; Dask tells which it is."""
    return list(dask_scheduler.clients)


_pools: Final[dict[str, WorkerPool]] = {}
"""Of Dask's worker, for all its threads: one for each sweep, by the id of its client."""
_lock: Final = threading.Lock()


def check_version(version: str) -> None:
    """Raise ImportError where this worker's version is another one: its drives might be others."""
    if version != __version__:
        raise ImportError(f"simconsole {__version__}, this machine {version}")


def drive_lines(lines: Sequence[bytes], version: str, sweep: str) -> list[bytes]:
    """Drive tasks of a sweep, each a line of JSON, one after the other, and return the results likewise: for Dask.

    None is begun after `_BATCH_S`: there may be fewer results than tasks, but one at least.

    Raises:
        ImportError: the tasks are of another version.
    """
    check_version(version)
    with _lock:
        pool = _pools.setdefault(sweep, WorkerPool())
    results: list[bytes] = []
    until_s = time.monotonic() + _BATCH_S
    for line in lines:
        results.append(msgspec.json.encode(pool.drive(from_bytes(line))))
        if time.monotonic() >= until_s:
            break
    return results


def close_pools(others: Collection[str]) -> None:
    """End the processes that `drive_lines` has started, but those of other sweeps, which still have their client."""
    with _lock:
        ended = [_pools.pop(sweep) for sweep in list(_pools) if sweep not in others]
    for pool in ended:
        pool.close()
