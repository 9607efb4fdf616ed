"""One pass over a log's bytes: its whole records, and what is not whole in it.

A frame may be damaged in any byte, its length too. Reading goes on at the next place where a whole frame begins: a tick
still to come stands at its offset 8, and its checksum is right.
"""

from collections.abc import Callable, Iterator
from typing import Final, NamedTuple

import numpy as np

from simconsole.recording.framing import (
    MAX_FRAME_BYTES,
    TORN,
    Record,
    frame_size,
    plausible,
    promised_size,
    unseal,
)
from simconsole.recording.log_header import read_header

_SEARCH_BYTES: Final = 1 << 20
_NEEDLE_BYTES: Final = 16  # length, checksum and tick: what is looked for
_MAX_TICK: Final = 1 << 53


class Break(NamedTuple):
    """A place where the log is not whole."""

    offset: int
    size_bytes: int
    reason: str

    @property
    def torn(self) -> bool:
        """Whether it is the beginning of a tick and no more, as a killed process leaves it; anything else is damage."""
        return self.reason.startswith(TORN)

    def __str__(self) -> str:
        """One line for a person."""
        return f"{self.size_bytes} bytes from byte {self.offset}: {self.reason}"


class Scan:
    """One pass over a log: iterate for its whole records, then look at `breaks`.

    Raises RecordingError when it is made, for a header that cannot be read; never while iterating.

    Attributes:
        header: what the streams mean.
        start: the bytes before the first frame, magic and header.
        breaks: where the log is not whole, so far.
    """

    def __init__(self, read: Callable[[int], bytes], name: str) -> None:
        self.header, self.start = read_header(read, name)
        self.breaks: list[Break] = []
        self._offset = len(self.start)
        self._least = frame_size(len(self.header.columns))
        self._read = read
        self._ahead, self._ahead_at = b"", 0  # read, but not yet taken: what lies behind a damaged frame

    def __iter__(self) -> Iterator[Record]:
        """Yield every whole record in file order; a damaged one is named in `breaks` and left out."""
        expected: int | None = None
        while frame := self._next_frame():
            record = unseal(frame, self.header)
            if isinstance(record, str):
                expected = self._resume(frame, record, expected)
                continue
            expected = record.tick if expected is None else expected
            if record.tick == expected:
                yield record
            else:
                self._note(len(frame), f"tick {record.tick} where tick {expected} belongs")
            self._offset += len(frame)
            expected += 1

    def _next_frame(self) -> bytes:
        frame = self._take(self._least)
        size = promised_size(frame, self._least)
        if len(frame) == self._least < size and plausible(size, self.header):
            frame += self._take(size - self._least)
        return frame

    def _take(self, size: int) -> bytes:
        if not self._ahead:
            return self._read(size)
        part = self._ahead[self._ahead_at : self._ahead_at + size]
        self._ahead_at += len(part)
        if self._ahead_at == len(self._ahead):
            self._ahead, self._ahead_at = b"", 0
            if len(part) < size:
                part += self._read(size - len(part))
        return part

    def _resume(self, content: bytes, reason: str, expected: int | None) -> int | None:
        """Note the break at which `content` begins, and go on at the next whole frame.

        Return its tick, or None where none follows.
        """
        lost, first = 0, 1  # bytes that were searched and dropped; where to look in `content`
        while True:
            window = len(content)
            for at in self._candidates(content, first, expected):
                size = promised_size(content[at : at + 4], self._least)
                if not plausible(size, self.header):
                    continue
                content += self._take(max(0, at + size - len(content)))
                record = unseal(content[at : at + size], self.header)
                if isinstance(record, Record):
                    self._note(lost + at, "damaged, wrong length" if reason.startswith(TORN) else reason)
                    self._offset += lost + at
                    self._ahead = content[at:] + self._ahead[self._ahead_at :]
                    self._ahead_at = 0
                    return record.tick
            more = self._take(_SEARCH_BYTES)
            if not more and len(content) == window:
                self._note(lost + len(content), reason)
                self._offset += lost + len(content)
                return None
            searched = max(0, window - _NEEDLE_BYTES + 1)
            lost, first, content = lost + searched, int(searched == 0), content[searched:] + more

    def _candidates(self, content: bytes, first: int, expected: int | None) -> list[int]:
        """Return where frames may begin in `content` from `first` on: a possible size, and a tick still to come."""
        found: list[int] = []
        for start in range(first, first + 8):
            count = (len(content) - start) // 8
            if count < 2:
                continue
            words = np.frombuffer(content, "<u8", count, start)
            sizes, ticks = (words[:-1] & 0xFFFFFFFF) + 8, words[1:].view("<i8")
            near = (
                (sizes >= self._least) & (sizes <= MAX_FRAME_BYTES) & (ticks >= (expected or 0)) & (ticks < _MAX_TICK)
            )
            found += [start + 8 * int(index) for index in np.flatnonzero(near)]
        return sorted(found)

    def _note(self, size: int, reason: str) -> None:
        last = self.breaks[-1] if self.breaks else None
        if last is not None and last.offset + last.size_bytes == self._offset:
            self.breaks[-1] = Break(last.offset, last.size_bytes + size, last.reason)
        else:
            self.breaks.append(Break(self._offset, size, reason))
