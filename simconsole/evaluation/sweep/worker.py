"""A process that drives one task after the other: `python -m simconsole.evaluation.sweep.worker`.

Tasks and results are lines of JSON on its standard input and output; it ends with whoever holds its input.
"""

import os
import queue
import threading
from typing import BinaryIO, NoReturn

import msgspec

from simconsole.evaluation.sweep.driving import drive_task
from simconsole.evaluation.sweep.task import TaskResult, from_bytes
from simconsole.processes.lifetimes import SIGNALS, end_at_once, handle


def main() -> NoReturn:
    """Drive what comes until standard input ends."""
    answers = os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)  # what a drive prints must not come between the answers
    lines: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(lines,), name="parent", daemon=True).start()
    handle(lambda number, frame: end_at_once(1), SIGNALS)
    while True:
        _answer(answers, drive_task(from_bytes(lines.get())))


def _listen(lines: "queue.SimpleQueue[bytes]") -> None:
    """Take tasks from standard input as they come, so that its end is seen in the middle of a drive."""
    with open(0, "rb", closefd=False) as pipe:
        for line in pipe:
            lines.put(line)
    end_at_once(0)


def _answer(answers: BinaryIO, result: TaskResult) -> None:
    line = msgspec.json.encode(result) + b"\n"
    while line:
        line = line[answers.write(line) :]


if __name__ == "__main__":
    main()
