"""One process that drives for a pool (`worker.py`), seen from its parent: started anew, or the copy of such a one."""

import os
import signal
import socket
import subprocess
import sys
import threading
from contextlib import suppress
from multiprocessing.connection import wait
from typing import IO, Final

import msgspec

from simconsole.evaluation.sweep.task import FORK, RECEIVED, Task, TaskResult, to_bytes
from simconsole.processes.lifetimes import close_pipe, spawn

_MODULE: Final = "simconsole.evaluation.sweep.worker"
_ENDS_S: Final = 10.0
_ONE_THREAD: Final = {"OPENBLAS_NUM_THREADS": "1"}
"""In its environment: numpy's library starts threads when it is loaded, and a process with threads has no copies."""


class PoolWorker:
    """One such process. For one thread at a time; `close` may come from another.

    Attributes:
        pid: its number.
        gave_up: whether it was ended because a task took too long.
    """

    def __init__(self, pid: int, orders: IO[bytes], answers: IO[bytes]) -> None:
        self.pid = pid
        self.gave_up = False
        self._orders, self._answers = orders, answers

    def drive(self, task: Task) -> TaskResult | None:
        """Drive a task there; None if the process has ended meanwhile, or was ended because it took too long."""
        timer = threading.Timer(task.timeout_s, self._give_up)
        timer.daemon = True
        timer.start()
        try:
            self._tell(to_bytes(task) + b"\n")
            line = self._answers.readline()
        except (OSError, ValueError):  # it was gone already, or is closed by another thread
            return None
        finally:
            timer.cancel()
        if not line.endswith(b"\n"):
            return None
        with suppress(OSError, ValueError):
            self._tell(RECEIVED)
        return msgspec.json.decode(line, type=TaskResult)

    def _tell(self, line: bytes) -> None:
        self._orders.write(line)
        self._orders.flush()

    def _give_up(self) -> None:
        self.gave_up = True
        self.kill()

    def close(self) -> None:
        """End it; harmless twice."""
        self.kill()
        self._wait()
        for pipe in (self._orders, self._answers):
            with suppress(OSError):
                pipe.close()

    def kill(self) -> None:
        """End it at once; harmless twice."""
        raise NotImplementedError

    def _wait(self) -> None:
        raise NotImplementedError


class StartedWorker(PoolWorker):
    """One that was started anew, which takes seconds."""

    def __init__(self) -> None:
        self._control, theirs = socket.socketpair()
        inherited = [theirs.fileno()] if sys.platform == "linux" else []
        words = ["-m", _MODULE, *map(str, inherited)]
        with theirs:
            self._process = spawn(words, stdout=-1, environment={**os.environ, **_ONE_THREAD}, pass_fds=inherited)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        super().__init__(self._process.pid, self._process.stdin, self._process.stdout)

    def copy(self) -> "PoolWorker | None":
        """Return a copy of it, with all that it has loaded and compiled; None: nobody can make one.

        So it is if other threads run in it, and elsewhere than on Linux.

        Raises:
            ChildProcessError: it has ended.
        """
        if sys.platform != "linux" or not _has_pidfd():
            return None
        ours, theirs = socket.socketpair()
        try:
            with theirs:
                self._tell(FORK)
                socket.send_fds(self._control, [b"\n"], [theirs.fileno()])
            if pid := int(self._answers.readline()):
                return _Copy(pid, os.pidfd_open(pid), ours)
        except (OSError, ValueError) as error:
            ours.close()
            raise ChildProcessError("the process has ended") from error
        ours.close()
        return None

    def end(self) -> None:
        """Let it end in order between two tasks: it has waited for its copies then. Harmless twice."""
        close_pipe(self._process)
        with suppress(subprocess.TimeoutExpired):
            self._wait()
        self.close()

    def kill(self) -> None:
        """End it at once; harmless twice."""
        self._process.kill()

    def _wait(self) -> None:
        self._process.wait(_ENDS_S)
        self._control.close()


class _Copy(PoolWorker):
    """The copy of another worker, which is its parent; so it is held by a descriptor: no other process has it ever."""

    def __init__(self, pid: int, process: int, ours: socket.socket) -> None:
        with ours:
            super().__init__(pid, ours.makefile("wb"), ours.makefile("rb"))
        self._process: int | None = process
        self._lock = threading.Lock()

    def kill(self) -> None:
        """End it at once; harmless twice."""
        with self._lock, suppress(ProcessLookupError):
            if sys.platform == "linux" and self._process is not None:
                signal.pidfd_send_signal(self._process, signal.SIGKILL)

    def _wait(self) -> None:
        with self._lock:
            if self._process is not None:
                wait([self._process], _ENDS_S)
                os.close(self._process)
                self._process = None


def _has_pidfd() -> bool:
    """Return whether this kernel and this Python hold processes by descriptors."""
    if sys.platform != "linux":
        return False
    try:
        os.close(os.pidfd_open(os.getpid()))
    except (AttributeError, OSError):
        return False
    return True
