"""A process that drives one task after the other: `python -m simconsole.evaluation.sweep.worker [SOCKET]`.

A task is a line of JSON on its standard input, its result one on its standard output; RECEIVED tells that it has come.
It ends with whoever holds its input. Between two tasks FORK makes another such process of it, with all that is loaded
and compiled here; what the copy reads from and answers to comes through the inherited SOCKET.
"""

import os
import socket
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final, NoReturn

import msgspec

from simconsole.evaluation.sweep.driving import drive_task
from simconsole.evaluation.sweep.task import FORK, RECEIVED, from_bytes
from simconsole.processes.lifetimes import SIGNALS, end_at_once, handle

_MOMENT_S: Final = 0.0005


def main() -> NoReturn:
    """Drive what comes until standard input ends."""
    answers = os.dup(1)
    os.dup2(2, 1)  # what a drive prints must not come between the answers
    handle(lambda number, frame: end_at_once(1), SIGNALS)
    copies: list[int] = []
    while line := _line():
        if line == FORK:
            _fork(int(sys.argv[1]), answers, copies)
        else:
            with _ending_with_parent():
                _answer(answers, msgspec.json.encode(drive_task(from_bytes(line))))
    for pid in copies:  # they end by their input, too; their processor time is of this process, whose parent counts it
        os.waitpid(pid, 0)
    end_at_once(0)


def _line() -> bytes:
    """Return the next line of standard input, empty at its end. Nothing is read ahead: it is all that was sent."""
    with open(0, "rb", closefd=False) as pipe:
        return pipe.readline()


@contextmanager
def _ending_with_parent() -> Iterator[None]:
    """Within the block this process ends with its parent. After it there is no thread but this: it can be forked."""
    watching = threading.Thread(target=_watch, name="parent", daemon=True)
    watching.start()
    yield
    watching.join()
    # Python lets go of a thread a moment before the system does, at whose threads `_fork` looks.
    while Path(f"/proc/self/task/{watching.native_id}").exists():
        time.sleep(_MOMENT_S)


def _watch() -> None:
    if os.read(0, len(RECEIVED)) != RECEIVED:
        end_at_once(0)


def _answer(answers: int, result: bytes) -> None:
    line = result + b"\n"
    while line:
        line = line[os.write(answers, line) :]


def _fork(control: int, answers: int, copies: list[int]) -> None:
    """Make a copy of this process and answer its number; 0 if other threads run here, of Python or of a library.

    What another thread has locked would be locked in the copy for ever.
    """
    if sys.platform != "linux":
        raise NotImplementedError("nobody asks for it there")
    with socket.socket(fileno=os.dup(control)) as through:
        (end,) = socket.recv_fds(through, 1, 1)[1]
    copies[:] = [pid for pid in copies if not os.waitpid(pid, os.WNOHANG)[0]]
    is_alone = len(list(Path("/proc/self/task").iterdir())) == 1
    pid = os.fork() if is_alone else -1
    if pid == 0:
        os.dup2(end, 0)
        os.dup2(end, answers)
        os.close(control)
    else:
        copies += [pid] * (pid > 0)
        _answer(answers, b"%d" % max(pid, 0))
    os.close(end)


if __name__ == "__main__":
    main()
