"""Where the drives of a sweep are driven: in processes of this machine, or by the workers of a Dask scheduler."""

import threading
from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from typing import Any, Final

import msgspec

from simconsole.evaluation.sweep.task import Task, TaskResult, from_bytes, to_bytes
from simconsole.evaluation.sweep.worker_pool import WorkerPool
from simconsole.values.errors import SimConsoleError

_TRIES: Final = 3
"""How often Dask may give a drive to another worker because the one that had it has ended."""


def drive_here(tasks: Sequence[Task], jobs: int) -> Generator[TaskResult, None, None]:
    """Drive tasks in `jobs` processes of this machine; yield results as they come."""
    pool = WorkerPool()
    with ThreadPoolExecutor(jobs) as threads:
        try:
            waiting: list[Future[TaskResult]] = [threads.submit(pool.drive, task) for task in tasks]
            for future in as_completed(waiting):
                yield future.result()
        finally:
            threads.shutdown(wait=False, cancel_futures=True)
            pool.close()


def drive_on_dask(tasks: Sequence[Task], scheduler: str) -> Generator[TaskResult, None, None]:
    """Drive tasks by the workers of a scheduler (tcp://HOST:PORT); yield results as they come.

    A worker drives them in processes of its own, one for each of its threads. Drives of a worker that has ended go to
    the others. Files that sessions name, traces, scripts and road maps, must lie where this machine has them.

    Raises:
        SimConsoleError: no such scheduler, or Dask is not installed (extra `dask`).
    """
    try:
        from distributed import as_completed as each_completed
        from distributed.scheduler import KilledWorker
    except ImportError as error:
        raise SimConsoleError(f"sweep: --engine dask: needs the extra `dask`: {error}") from None
    with _client(scheduler) as client:
        futures = {client.submit(drive_line, to_bytes(task), pure=False, retries=_TRIES): task for task in tasks}
        try:
            for future in each_completed(list(futures), loop=client.loop):  # type: ignore[no-untyped-call]
                failure = future.exception()
                if failure is None:
                    yield msgspec.json.decode(future.result(), type=TaskResult)
                elif isinstance(failure, KilledWorker):
                    yield TaskResult(index=futures[future].index, outcome="crashed", detail="its workers have ended")
                else:
                    raise failure
                future.release()
        finally:
            client.cancel(list(futures))
            client.run(close_pool)


@contextmanager
def _client(scheduler: str) -> Iterator[Any]:
    from distributed import Client

    try:
        client = Client(scheduler, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise SimConsoleError(f"sweep: --scheduler: value {scheduler}: {error}") from None
    with client:
        yield client


_pool: WorkerPool | None = None
_lock: Final = threading.Lock()


def drive_line(line: bytes) -> bytes:
    """Drive the task in a line of JSON in the calling thread's process, and return its result likewise: for Dask."""
    global _pool  # of Dask's worker, for all its threads
    with _lock:
        if _pool is None:
            _pool = WorkerPool()
        pool = _pool
    return msgspec.json.encode(pool.drive(from_bytes(line)))


def close_pool() -> None:
    """End the processes that `drive_line` has started."""
    global _pool
    with _lock:
        pool, _pool = _pool, None
    if pool is not None:
        pool.close()
