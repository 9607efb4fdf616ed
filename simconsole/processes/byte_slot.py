"""The newest of many pieces of bytes in shared memory, each with a number: pictures, from the process that draws."""

from pathlib import Path
from typing import Final, NamedTuple, Self

import numpy as np

from simconsole.processes.shared_memory import Record, Ring
from simconsole.values.errors import WorkerError

CAPACITY: Final = 4
WORD_BYTES: Final = 8


class Piece(NamedTuple):
    """Bytes, and the number that they were written with."""

    number: int
    content: bytes


class ByteSlot:
    """One writer, many readers; what was not read is replaced by the next, and nobody waits."""

    def __init__(self, ring: Ring) -> None:
        self._ring = ring
        self._seen, self._piece = 0, Piece(0, b"")
        self._taken = 0

    @classmethod
    def create(cls, path: Path, most_bytes: int) -> Self:
        """Make the memory.

        Raises:
            WorkerError: it cannot be made.
        """
        return cls(Ring.create(path, -(-most_bytes // WORD_BYTES), CAPACITY))

    @classmethod
    def open(cls, path: Path, *, writable: bool = False) -> Self:
        """Open memory that was made.

        Raises:
            WorkerError: there is none.
        """
        return cls(Ring.open(path, writable=writable))

    def write(self, number: int, content: bytes) -> None:
        """Publish a piece.

        Raises:
            WorkerError: it is longer than its memory.
        """
        room = self._ring.width * WORD_BYTES
        if len(content) > room:
            raise WorkerError(f"{len(content)} bytes: at most {room} fit in their shared memory")
        values = np.zeros(self._ring.width)
        values.view(np.uint8)[: len(content)] = np.frombuffer(content, np.uint8)
        self._ring.write(values, number, len(content))

    def newest(self) -> Piece | None:
        """Return the newest piece, None before the first."""
        if self._ring.newest != self._seen:
            record = self._ring.latest()
            if record is not None:
                self._seen = record.number
                self._piece = _piece_of(record)
        return self._piece if self._seen else None

    def take(self) -> list[Piece]:
        """Return the pieces since the last call, oldest first, as far as they are still there: CAPACITY - 1 at most."""
        records = self._ring.since(self._taken)
        if records:
            self._taken = records[-1].number
        return [_piece_of(record) for record in records]


def _piece_of(record: Record) -> Piece:
    return Piece(record.stamp, record.values.tobytes()[: record.second_stamp])
