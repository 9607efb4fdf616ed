"""The drives of a sweep in processes of this machine."""

from collections.abc import Generator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed

from simconsole.evaluation.sweep.task import Task, TaskResult
from simconsole.evaluation.sweep.worker_pool import WorkerPool


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
