"""The journal of a sweep: one line for each finished drive, so that a sweep that was cut off goes on where it was."""

import os
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Final, Self

import msgspec

from simconsole.evaluation.sweep.plan import Plan
from simconsole.evaluation.sweep.task import TaskResult
from simconsole.values.errors import RecordingError

JOURNAL: Final = "sweep.jsonl"


class _Head(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    plan: str
    drives: int


class Journal:
    """The results so far, on the disk before they count.

    Attributes:
        results: by index; a drive that was cut off is not among them.
    """

    def __init__(self, folder: Path, plan: Plan) -> None:
        """Open the journal in `folder`, which is made; one that is there must be of the same plan.

        Raises:
            RecordingError: it is of another plan or version, or cannot be read or written.
        """
        self.results: dict[int, TaskResult] = {}
        path = folder / JOURNAL
        with ExitStack() as stack:
            try:
                folder.mkdir(parents=True, exist_ok=True)
                self._file = stack.enter_context(path.open("a+b"))
                self._read(path, _Head(plan=plan.digest, drives=len(plan.tasks)))
            except (OSError, msgspec.MsgspecError) as error:
                raise RecordingError(f"{path}: cannot be gone on with: {error}") from error
            self._open = stack.pop_all()

    def _read(self, path: Path, head: _Head) -> None:
        """Take what is whole, and drop a line that was being written when the sweep was cut off."""
        self._file.seek(0)
        whole = 0
        for number, line in enumerate(self._file):
            if not line.endswith(b"\n"):
                break
            whole += len(line)
            if number == 0:
                self._check(path, line, head)
            else:
                result = msgspec.json.decode(line, type=TaskResult)
                self.results[result.index] = result
        self._file.truncate(whole)
        if not whole:
            self._write(head)

    def _check(self, path: Path, line: bytes, head: _Head) -> None:
        if msgspec.json.decode(line, type=_Head) != head:
            raise RecordingError(f"{path}: of another plan, other profiles or another version: --out another folder")

    def add(self, result: TaskResult) -> None:
        """Keep one result; once this returns, a power cut does not take it.

        Raises:
            RecordingError: the disk takes no more.
        """
        try:
            self._write(result)
        except OSError as error:
            raise RecordingError(f"{self._file.name}: cannot be written: {error.strerror}") from error
        self.results[result.index] = result

    def _write(self, record: msgspec.Struct) -> None:
        self._file.write(msgspec.json.encode(record) + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._open.close()
