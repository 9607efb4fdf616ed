"""Processes that drive one task after the other (`worker.py`), one for each thread that asks.

What takes one down, an error in compiled code, the kernel for want of memory, a drive that never ends, loses the drive
that it was at and nothing else. The first drive is alone, so that kernels are compiled once. The process that drove it
drives no more: the others are its copies, which have loaded already what takes seconds.
"""

import threading
from typing import Final, TypeVar

from simconsole.evaluation.sweep.pool_worker import PoolWorker, StartedWorker
from simconsole.evaluation.sweep.task import Outcome, Task, TaskResult

_TRIES: Final = 2
_Worker = TypeVar("_Worker", bound=PoolWorker)


class WorkerPool:
    """A process for each thread that asks; a drive that takes one down is tried once more in another."""

    def __init__(self) -> None:
        self._of_thread = threading.local()
        self._all: set[PoolWorker] = set()
        self._lock = threading.Lock()
        self._closed = False
        self._beginning = threading.Lock()
        self._first: StartedWorker | None = None
        self._has_copies = True  # until one is asked for and cannot be made

    def drive(self, task: Task) -> TaskResult:
        """Drive a task in this thread's process."""
        outcome: Outcome = "crashed"
        for _ in range(_TRIES):
            worker, found = self._drive(task)
            if found is not None:
                return found
            outcome = "timed out" if worker.gave_up else "crashed"
            self._drop(worker)
            self._of_thread.worker = None
        detail = f"twice, after {task.timeout_s:g} s" if outcome == "timed out" else "twice: the process has ended"
        return TaskResult(index=task.index, outcome=outcome, detail=detail)

    def close(self) -> None:
        """End all of them. Threads that wait for one get no result."""
        with self._lock:
            self._closed, first = True, self._first
            workers = [worker for worker in self._all if worker is not first]
        for worker in workers:
            worker.close()
        if first is not None:
            first.end()

    def _drive(self, task: Task) -> tuple[PoolWorker, TaskResult | None]:
        worker: PoolWorker | None = getattr(self._of_thread, "worker", None)
        if worker is None:
            with self._beginning:
                worker = self._another()
                if worker is None:
                    return self._begin(task)
            self._of_thread.worker = worker
        return worker, worker.drive(task)

    def _begin(self, task: Task) -> tuple[PoolWorker, TaskResult | None]:
        first = self._held(StartedWorker())
        found = first.drive(task)
        if found is not None:
            self._first = first
        return first, found

    def _another(self) -> PoolWorker | None:
        """Return a process for this thread. None: there is no first one, which is begun with a drive."""
        first, copy = self._first, None
        if first is None:
            return None if self._has_copies else self._held(StartedWorker())
        try:
            copy = first.copy()
        except ChildProcessError:
            self._first = None
            self._drop(first)
            return None
        if copy is not None:
            return self._held(copy)
        self._first, self._has_copies = None, False  # it is this thread's, and the others are started
        return first

    def _held(self, worker: _Worker) -> _Worker:
        with self._lock:
            if not self._closed:
                self._all.add(worker)
                return worker
        worker.close()
        raise InterruptedError("the sweep has ended")

    def _drop(self, worker: PoolWorker) -> None:
        worker.close()
        with self._lock:
            self._all.discard(worker)
