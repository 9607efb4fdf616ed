"""What a reader of a recorded drive offers, whatever form the drive is in: pure, no file is opened here."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Final, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from simconsole.recording.framing import Message, Record
from simconsole.recording.log_header import LogHeader
from simconsole.recording.scan import Break
from simconsole.values.errors import RecordingError

BLOCK_TICKS: Final = 8192
"""Ticks that are read at once: bounds the memory of a reader, whatever the length of the drive."""


class Block(NamedTuple):
    """Ticks in a row: their numbers (n) and the values of the columns asked for (n, columns)."""

    ticks: NDArray[np.int64]
    vectors: NDArray[np.float64]


class LogTable(NamedTuple):
    """Columns of a whole drive in memory: ticks (n) and values (n, columns)."""

    columns: tuple[str, ...]
    tick_hz: int
    ticks: NDArray[np.int64]
    vectors: NDArray[np.float64]

    def column(self, name: str) -> NDArray[np.float64]:
        """Return one column over all ticks.

        Raises:
            RecordingError: no such column in this recording.
        """
        if name not in self.columns:
            raise RecordingError(f"the recording has no column {name!r}")
        values: NDArray[np.float64] = self.vectors[:, self.columns.index(name)]
        return values


class Recording(Protocol):
    """A recorded drive, opened for reading. Each pass reads it anew, in constant memory.

    Attributes:
        header: what the state vectors mean.
        breaks: where the file was not whole, as found by the latest complete pass over the records.
        last: the last whole record, as found by the latest complete pass over the records; None without one.
    """

    header: LogHeader
    breaks: tuple[Break, ...]
    last: Record | None

    def __iter__(self) -> Iterator[Record]:
        """Yield all whole records in the order of their ticks."""

    def messages(self, stream: str) -> Iterator[Message]:
        """Yield the messages of one stream in the order in which they arrived.

        Raises:
            RecordingError: no such stream in this recording.
        """

    def blocks(self, columns: Sequence[str] | None = None) -> Iterator[Block]:
        """Yield the ticks in blocks of at most BLOCK_TICKS, with only these columns (None: all), in this order.

        Raises:
            RecordingError: no such column in this recording.
        """

    def table(self, columns: Sequence[str] | None = None) -> LogTable:
        """Return these columns (None: all) of the whole drive; its memory is 8 bytes per tick and column."""


def places(header: LogHeader, columns: Sequence[str] | None) -> list[int]:
    """Return where `columns` (None: all) stand in a state vector.

    Raises:
        RecordingError: no such column in this recording.
    """
    if columns is None:
        return list(range(len(header.columns)))
    at = {name: index for index, name in enumerate(header.columns)}
    for name in columns:
        if name not in at:
            raise RecordingError(f"the recording has no column {name!r}")
    return [at[name] for name in columns]


def gathered(header: LogHeader, columns: Sequence[str] | None, blocks: Iterable[Block]) -> LogTable:
    """Return the table of `blocks` that hold `columns` of a recording with this header."""
    names = header.columns if columns is None else tuple(columns)
    parts = [Block(np.empty(0, np.int64), np.empty((0, len(names)))), *blocks]
    ticks = np.concatenate([part.ticks for part in parts])
    vectors = np.empty((len(ticks), len(names)))
    start = 0
    while parts:
        part = parts.pop(0)  # each is freed once it is copied
        vectors[start : start + len(part.ticks)] = part.vectors
        start += len(part.ticks)
        del part
    return LogTable(names, header.tick_hz, ticks, vectors)
