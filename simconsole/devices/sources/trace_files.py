"""Write traces to files and play them from files."""

from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import IO

from simconsole.devices.synthetic.trace_format import (
    MAX_LINE,
    TraceHeader,
    TracePlayer,
    header_text,
    read_header,
    read_rows,
    row_text,
)
from simconsole.values.errors import DeviceError, ProfileError
from simconsole.values.input_table import InputTable
from simconsole.values.kernels import Row
from simconsole.values.signals import DeviceSample


class TraceWriter:
    """Appends one line per tick to a new file; a context manager."""

    def __init__(self, path: Path, header: TraceHeader) -> None:
        """Open `path`, replacing what was there.

        Raises:
            DeviceError: the file cannot be written.
        """
        self._path = path
        try:
            self._file: IO[str] = path.open("w", encoding="ascii", newline="\n")
            self._file.write(header_text(header))
        except OSError as error:
            raise DeviceError(f"{path}: file: {error.strerror}: a file that can be written") from error

    def write(self, tick: int, sample: DeviceSample) -> None:
        """Append one tick.

        Raises:
            DeviceError: the disk refuses.
        """
        try:
            self._file.write(row_text(tick, sample))
        except OSError as error:
            raise DeviceError(f"{self._path}: file: {error.strerror}: a file that can be written") from error

    def close(self) -> None:
        """Finish the file."""
        self._file.close()

    def __enter__(self) -> "TraceWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class TraceSource:
    """A recorded cockpit. The whole file is checked before the first tick, line by line, in constant memory."""

    def __init__(self, path: Path, *, tick_hz: int) -> None:
        """Open and check a trace.

        Args:
            path: What `simconsole devices record` wrote.
            tick_hz: The session's; ages are in ticks, so that the trace must have the same.

        Raises:
            ProfileError: unreadable, another tick rate, or a line that cannot be used; names file and line.
        """
        with _open(path) as file:
            lines = _lines(file, path)
            self.header = read_header(lines, str(path))
            if self.header.tick_hz != tick_hz:
                raise ProfileError(
                    f"{path}: line 1: tick_hz: value {self.header.tick_hz}: {tick_hz}, the tick rate of the session"
                )
            for _ in read_rows(lines, str(path)):
                pass
        self._file = _open(path)
        lines = _lines(self._file, path)
        read_header(lines, str(path))
        self._player = TracePlayer(read_rows(lines, str(path)))
        self._table = InputTable(len(DeviceSample._fields), self._fill)
        self.foresee = self._table.foresee

    def poll(self, tick: int) -> DeviceSample:
        """Return the sample of this tick; after the last one the devices go stale."""
        return DeviceSample(*self._table.values(tick))

    def _fill(self, tick: int, rows: Row) -> None:
        for at in range(len(rows)):
            rows[at] = self._player.poll(tick + at)

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _open(path: Path) -> IO[str]:
    try:
        return path.open(encoding="ascii", newline="\n")
    except OSError as error:
        raise ProfileError(f"{path}: file: {error.strerror}: a trace that can be read") from error


def _lines(file: IO[str], path: Path) -> Iterator[str]:
    number = 0
    try:
        while line := file.readline(MAX_LINE):
            number += 1
            if len(line) == MAX_LINE and not line.endswith("\n"):
                raise ProfileError(f"{path}: line {number}: value longer than {MAX_LINE}: a shorter line")
            yield line
    except UnicodeDecodeError:
        raise ProfileError(f"{path}: line {number + 1}: value not ASCII: numbers and commas") from None
