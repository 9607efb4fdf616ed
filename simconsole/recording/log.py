"""The append log as a file: one write() per tick, a thread that only syncs, and a reader.

A frame reaches the kernel whole with its write(), so a killed process loses at most the tick it was working on; a
power cut loses at most the time between two syncs.
"""

import os
from collections.abc import Iterator
from pathlib import Path
from threading import Event, Thread
from types import TracebackType
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.errors import RecordingError
from simconsole.kernels import Row
from simconsole.recording.framing import (
    START_OF_CHAIN,
    Break,
    LogHeader,
    Record,
    Scan,
    encode_header,
    frame_size,
    seal,
)

SYNC_INTERVAL_S: Final = 1.0
"""Longest time whose ticks a power cut may take."""

_synchronise = getattr(os, "fdatasync", os.fsync)


class LogWriter:
    """Appends rows to a new log file. A failing disk stops the recording, never the drive.

    Attributes:
        failure: why recording stopped, or None while all is well. Worth an alert; checked by the session.
        ticks: rows that reached the file.
        digest: chained hash after the last of them.
        size_bytes: of the file's whole frames.
    """

    def __init__(self, path: Path, header: LogHeader, sync_interval_s: float = SYNC_INTERVAL_S) -> None:
        """Create the file (it must not exist) and write the header.

        Raises:
            RecordingError: the file cannot be created.
        """
        start = encode_header(header)
        try:
            flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND | getattr(os, "O_BINARY", 0)
            self._fd = os.open(path, flags, 0o644)
        except OSError as error:
            raise RecordingError(f"{path}: cannot be recorded to: {error.strerror}") from None
        self.path = path
        self.failure: str | None = None
        self.ticks = 0
        self.digest = START_OF_CHAIN
        self.size_bytes = 0
        self._row_bytes = 8 * len(header.columns)
        self._write(start)
        self._closing = Event()
        self._syncer = Thread(target=self._sync, args=(sync_interval_s,), name="log sync", daemon=True)
        self._syncer.start()

    def append(self, tick: int, row: Row) -> None:
        """Write one tick. Does nothing once recording has failed; a row of another width is a bug and raises."""
        if self.failure is not None:
            return
        content = row.tobytes()
        if len(content) != self._row_bytes:
            raise ValueError(f"a row of {len(content)} bytes in a log of {self._row_bytes}")
        frame, digest = seal(self.digest, tick, content)
        if self._write(frame):
            self.ticks += 1
            self.digest = digest

    def close(self) -> None:
        """Sync and close. May be called again."""
        if self._closing.is_set():
            return
        self._closing.set()
        self._syncer.join()
        try:
            _synchronise(self._fd)
        except OSError as error:
            self._fail(str(error.strerror))
        os.close(self._fd)

    def __enter__(self) -> "LogWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _write(self, frame: bytes) -> bool:
        try:
            written = os.write(self._fd, frame)
        except OSError as error:
            self._fail(str(error.strerror))
            return False
        if written == len(frame):
            self.size_bytes += written
            return True
        self._fail(f"only {written} of {len(frame)} bytes of a tick fitted")
        return False

    def _fail(self, reason: str) -> None:
        if self.failure is not None:
            return
        self.failure = f"{self.path}: recording stopped after {self.ticks} ticks: {reason}"
        try:
            os.ftruncate(self._fd, self.size_bytes)
        except OSError:
            return  # the torn tail stays; readers name it and keep what is whole

    def _sync(self, interval_s: float) -> None:
        while not self._closing.wait(interval_s):
            try:
                _synchronise(self._fd)
            except OSError as error:
                # Only noted: the tick loop is the one that writes and truncates.
                self.failure = self.failure or f"{self.path}: recording stopped: sync: {error.strerror}"
                return


class LogTable(NamedTuple):
    """A whole log in memory: ticks (n) and rows (n, columns)."""

    columns: tuple[str, ...]
    tick_hz: int
    ticks: NDArray[np.int64]
    rows: NDArray[np.float64]

    def column(self, name: str) -> NDArray[np.float64]:
        """Return one column over all ticks.

        Raises:
            RecordingError: no such column in this recording.
        """
        if name not in self.columns:
            raise RecordingError(f"the recording has no column {name!r}")
        values: NDArray[np.float64] = self.rows[:, self.columns.index(name)]
        return values


class LogReader:
    """A recorded log. Iterating passes over the file anew, in constant memory.

    Attributes:
        header: what the rows mean.
        breaks: where the file was not whole, as found by the latest complete pass.
    """

    def __init__(self, path: Path) -> None:
        """Read the header.

        Raises:
            RecordingError: missing, not a log, damaged header, newer schema or other byte order.
        """
        self.path = path
        self.breaks: tuple[Break, ...] = ()
        try:
            with path.open("rb") as file:
                self.header = Scan(file.read, str(path)).header
        except OSError as error:
            raise RecordingError(f"{path}: cannot be read: {error.strerror}") from None

    def __iter__(self) -> Iterator[Record]:
        """Yield all whole records; never raises on a torn tail."""
        with self.path.open("rb", buffering=1 << 18) as file:
            scan = Scan(file.read, str(self.path))
            yield from scan
        self.breaks = tuple(scan.breaks)

    def table(self) -> LogTable:
        """Return all whole records as arrays."""
        width = len(self.header.columns)
        most = self.path.stat().st_size // frame_size(width) + 1
        ticks, rows, count = np.empty(most, np.int64), np.empty((most, width), np.float64), 0
        for record in self:
            ticks[count], rows[count] = record.tick, record.row
            count += 1
        return LogTable(self.header.columns, self.header.tick_hz, ticks[:count], rows[:count])
