"""A lab's own signals in the log: a stream of messages with columns, read back as columns beside those of a tick.

What its code says on seeing tick N lies in the frame of tick N + 1, the first that could know of it, as with traffic.
Read back it stands in the row of tick N, and stays until it is said anew.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from simconsole.recording.framing import Message, Record
from simconsole.recording.log_header import LogHeader, Stream
from simconsole.recording.reading import Block, LogTable, Recording, gathered
from simconsole.recording.scan import Break
from simconsole.values.errors import RecordingError
from simconsole.values.kernels import Row
from simconsole.values.own_signals import OWN, OwnSignals
from simconsole.values.units import unit_of

ENCODING: Final = "float64"
_NUMBERS: Final = np.dtype("<f8")


def stream_of(signals: OwnSignals) -> Stream:
    """Return what a log's header says of these signals."""
    columns = tuple(f"{OWN}.{name}" for name in signals.names)
    units = tuple(map(unit_of, columns))
    return Stream(name=OWN, kind="messages", encoding=ENCODING, columns=columns, units=units)


def own_stream(header: LogHeader) -> Stream | None:
    """Return the stream of a recording's own signals, None where it has none."""
    return next((stream for stream in header.streams[1:] if stream.name == OWN and stream.columns), None)


def with_own_signals(recording: Recording) -> Recording:
    """Return the recording with the columns of its own signals after those of a tick; itself where it has none."""
    stream = own_stream(recording.header)
    return recording if stream is None else _WithOwnSignals(recording, stream)


class _WithOwnSignals:
    """A recording whose header and blocks hold the own signals too; its records stay as recorded."""

    def __init__(self, recording: Recording, stream: Stream) -> None:
        state, *others = recording.header.streams
        units = (*state.units, *stream.units)
        widened = replace(state, columns=(*state.columns, *stream.columns), units=units)
        self._recording, self._columns = recording, stream.columns
        self.header = replace(recording.header, streams=(widened, *others))

        self.breaks: tuple[Break, ...] = ()
        self.last: Record | None = None

    def __iter__(self) -> Iterator[Record]:
        """Yield the records as they were recorded."""
        yield from self._recording
        self.breaks, self.last = self._recording.breaks, self._recording.last

    def messages(self, stream: str) -> Iterator[Message]:
        """Yield the messages of one stream; raises RecordingError where there is none."""
        return self._recording.messages(stream)

    def blocks(self, columns: Sequence[str] | None = None) -> Iterator[Block]:
        """Yield the ticks in blocks; raises RecordingError for a column that there is not."""
        names = self.header.columns if columns is None else tuple(columns)
        own = [(place, self._columns.index(name)) for place, name in enumerate(names) if name in self._columns]
        if not own:
            yield from self._recording.blocks(names)
            return
        kept = [place for place, name in enumerate(names) if name not in self._columns]
        held = _Held(self._recording.messages(OWN), len(self._columns))
        for block in self._recording.blocks([names[place] for place in kept]):
            vectors = np.empty((len(block.ticks), len(names)))
            vectors[:, kept] = block.vectors
            said = held.rows(block.ticks)
            for place, at in own:
                vectors[:, place] = said[:, at]
            yield Block(block.ticks, vectors)

    def table(self, columns: Sequence[str] | None = None) -> LogTable:
        """Return these columns of the whole drive."""
        return gathered(self.header, columns, self.blocks(columns))


class _Held:
    """The messages of own signals as rows: each holds from the tick that was seen until the next one."""

    def __init__(self, messages: Iterable[Message], width: int) -> None:
        self._messages = iter(messages)
        self._width = width
        self._now = np.full(width, math.nan)
        self._next = next(self._messages, None)

    def rows(self, ticks: NDArray[np.int64]) -> Row:
        """Return the values [ticks, signals] at the next ticks of the recording.

        Raises:
            RecordingError: a message is no row of all signals.
        """
        found = np.empty((len(ticks), self._width))
        start = 0
        while self._next is not None and self._next.tick - 1 <= ticks[-1]:
            at = int(np.searchsorted(ticks, self._next.tick - 1))
            found[start:at] = self._now
            start, self._now = at, self._values(self._next)
            self._next = next(self._messages, None)
        found[start:] = self._now
        return found

    def _values(self, message: Message) -> Row:
        if len(message.content) != self._width * _NUMBERS.itemsize:
            raise RecordingError(f"tick {message.tick}: own signals: {len(message.content)} bytes")
        return np.frombuffer(message.content, _NUMBERS).astype(np.float64)
