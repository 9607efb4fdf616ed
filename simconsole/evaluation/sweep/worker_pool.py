"""Processes that drive one task after the other (`worker.py`), one for each thread that asks.

What takes one down, an error in compiled code, the kernel for want of memory, a drive that never ends, loses the drive
that it was at and nothing else.
"""

import threading
from contextlib import suppress
from typing import Final

import msgspec

from simconsole.evaluation.sweep.task import Outcome, Task, TaskResult, to_bytes
from simconsole.processes.lifetimes import close_pipe, spawn

_MODULE: Final = "simconsole.evaluation.sweep.worker"
_ENDS_S: Final = 10.0


class PoolWorker:
    """One such process, started when it is needed. For one thread at a time; `close` may come from another."""

    def __init__(self) -> None:
        self._process = spawn(["-m", _MODULE], stdout=-1)
        self._gave_up = False

    def drive(self, task: Task) -> TaskResult | None:
        """Drive a task there; None if the process has ended meanwhile, or was ended because it took too long."""
        process = self._process
        assert process.stdin is not None
        assert process.stdout is not None
        timer = threading.Timer(task.timeout_s, self._give_up)
        timer.daemon = True
        timer.start()
        try:
            process.stdin.write(to_bytes(task) + b"\n")
            process.stdin.flush()
            line = process.stdout.readline()
        except (OSError, ValueError):  # it was gone already, or is closed by another thread
            return None
        finally:
            timer.cancel()
        return msgspec.json.decode(line, type=TaskResult) if line.endswith(b"\n") else None

    @property
    def gave_up(self) -> bool:
        """Whether it was ended because a task took too long."""
        return self._gave_up

    def _give_up(self) -> None:
        self._gave_up = True
        self._process.kill()

    def close(self) -> None:
        """End it; harmless twice."""
        self._process.kill()
        self._process.wait(_ENDS_S)
        close_pipe(self._process)
        if self._process.stdout is not None:
            with suppress(OSError):
                self._process.stdout.close()


class WorkerPool:
    """A process for each thread that asks; a drive that takes one down is tried once more in another."""

    def __init__(self) -> None:
        self._of_thread = threading.local()
        self._all: set[PoolWorker] = set()
        self._lock = threading.Lock()
        self._closed = False

    def drive(self, task: Task) -> TaskResult:
        """Drive a task in this thread's process."""
        outcome: Outcome = "crashed"
        for _ in range(2):
            worker = self._worker()
            found = worker.drive(task)
            if found is not None:
                return found
            outcome = "timed out" if worker.gave_up else "crashed"
            self._drop(worker)
        detail = f"twice, after {task.timeout_s:g} s" if outcome == "timed out" else "twice: the process has ended"
        return TaskResult(index=task.index, outcome=outcome, detail=detail)

    def close(self) -> None:
        """End all of them. Threads that wait for one get no result."""
        with self._lock:
            self._closed, workers = True, tuple(self._all)
        for worker in workers:
            worker.close()

    def _worker(self) -> PoolWorker:
        worker: PoolWorker | None = getattr(self._of_thread, "worker", None)
        if worker is None:
            with self._lock:
                if self._closed:
                    raise InterruptedError("the sweep has ended")
                worker = PoolWorker()
                self._all.add(worker)
            self._of_thread.worker = worker
        return worker

    def _drop(self, worker: PoolWorker) -> None:
        worker.close()
        self._of_thread.worker = None
        with self._lock:
            self._all.discard(worker)
