"""The append log as a file: one write() per tick or block of ticks, a thread that only syncs, and a reader.

A frame reaches the kernel whole with its write(), so a killed process loses at most the tick it was working on, or the
block of ticks that were made at once (docs/decisions/0017-ticks-at-once.md); a power cut loses at most the time between
two syncs. The thread also keeps the file's checksum up to date, so that the end of a long drive does not wait for one.
"""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from hashlib import sha256
from itertools import islice
from pathlib import Path
from threading import Event, Thread
from types import TracebackType
from typing import Final

import numpy as np

from simconsole.recording.framing import (
    MAX_FRAME_BYTES,
    START_OF_CHAIN,
    Message,
    Record,
    seal,
    seal_block,
    seal_message,
)
from simconsole.recording.log_header import LogHeader, encode_header, stream_index
from simconsole.recording.reading import BLOCK_TICKS, Block, LogTable, gathered, places
from simconsole.recording.scan import Break, Scan
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import replaced
from simconsole.values.kernels import Row

SYNC_INTERVAL_S: Final = 1.0
"""Longest time whose ticks a power cut may lose."""

LAST_TICKS: Final = 2
"""Ticks still tried once recording has failed: the one that failed, and the next, which holds the alarm."""

_READ_BYTES: Final = 1 << 20
_AT_ONCE: Final = 256  # ticks; BLOCK_TICKS is a multiple of it
_NO_MESSAGES: Final[tuple[bytes, dict[int, bytes]]] = (b"", {})

_synchronise = getattr(os, "fdatasync", os.fsync)


class LogWriter:
    """Appends state vectors to a new log file. A failing disk stops the recording, never the drive.

    Attributes:
        failure: why recording stopped, or None while all is well. Worth an alarm: the session raises it.
        ticks: state vectors that reached the file.
        digest: chained hash of the state vectors after the last of them.
        size_bytes: of the file's whole frames.
        sha256: of these, once closed; None if they could not be read.
    """

    def __init__(
        self,
        path: Path,
        header: LogHeader,
        sync_interval_s: float = SYNC_INTERVAL_S,
        free_room: Callable[[], None] = lambda: None,
    ) -> None:
        """Create the file (it must not exist) and write the header.

        Args:
            path: the file.
            header: what its streams mean.
            sync_interval_s: longest time whose ticks a power cut may lose.
            free_room: frees the disk space that was reserved for the last ticks; may raise OSError.

        Raises:
            RecordingError: the file cannot be created or takes no header.
        """
        start = encode_header(header)
        try:
            flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_APPEND | getattr(os, "O_BINARY", 0)
            self._fd = os.open(path, flags, 0o644)
            # Read through a descriptor of its own: the position of the other one belongs to the loop that writes.
            self._reading = os.open(path, os.O_RDONLY | getattr(os, "O_BINARY", 0))
        except OSError as error:
            raise RecordingError(f"{path}: cannot be recorded to: {error.strerror}") from None
        self.path = path
        self.failure: str | None = None
        self.ticks = 0
        self.digest = START_OF_CHAIN
        self.size_bytes = 0
        self.sha256: str | None = None
        self._hasher, self._hashed_bytes = sha256(), 0
        self._vector_bytes = 8 * len(header.columns)
        self._streams = {stream.name: at for at, stream in enumerate(header.streams) if stream.kind == "messages"}
        self._message_digests = dict.fromkeys(self._streams.values(), START_OF_CHAIN)
        self._free_room = free_room
        self._last_ticks = LAST_TICKS
        problem = self._problem(start)
        if problem is not None:
            self._close_descriptors()
            raise RecordingError(f"{path}: cannot be recorded to: {problem}")
        self._closing = Event()
        self._syncer = Thread(target=self._sync, args=(sync_interval_s,), name="log sync", daemon=True)
        self._syncer.start()

    def append(self, tick: int, vector: Row, messages: Sequence[tuple[str, bytes]] = ()) -> None:
        """Write one tick. Once recording has failed, only the last ticks.

        A failed write is tried once more in the space reserved for it, so that the log's last tick can hold the alarm.

        Args:
            tick: its number.
            vector: its state vector.
            messages: those that arrived in it, each with the name of its stream.

        Raises:
            ValueError: a state vector of another width, a message of no stream, or too large a tick, which are bugs.
        """
        if self.failure is not None and self._last_ticks <= 0:
            return
        content = vector.tobytes()
        if len(content) != self._vector_bytes:
            raise ValueError(f"a state vector of {len(content)} bytes in a log of {self._vector_bytes}")
        sealed, digests = self._sealed(tick, messages) if messages else _NO_MESSAGES
        frame, digest = seal(self.digest, tick, content, sealed)
        problem = self._problem(frame)
        if problem is not None:
            self._fail(tick, problem)
            with suppress(OSError):
                self._free_room()
            problem = self._problem(frame)
        if self.failure is not None:
            self._last_ticks = 0 if problem is not None else self._last_ticks - 1
        if problem is None:
            self.ticks += 1
            self.digest = digest
            if digests:
                self._message_digests.update(digests)

    def append_block(self, tick: int, vectors: Row, messages: Sequence[tuple[str, bytes]] = ()) -> int:
        """Write ticks of which only the first may have messages, all at once; return how many, at least one.

        Where recording fails or has failed these are the ticks up to the failure, as `append` leaves them.

        Args:
            tick: the number of the first.
            vectors: their state vectors, float64 [ticks, columns].
            messages: those that arrived in the first, each with the name of its stream.

        Raises:
            ValueError: as of `append`, which is a bug.
        """
        if 8 * vectors.shape[1] != self._vector_bytes:
            raise ValueError(f"state vectors of {8 * vectors.shape[1]} bytes in a log of {self._vector_bytes}")
        if self.failure is None:
            sealed, digests = self._sealed(tick, messages) if messages else _NO_MESSAGES
            frames, digest = seal_block(self.digest, tick, vectors, sealed)
            problem = self._problem(frames)
            if problem is None:
                self.ticks += len(vectors)
                self.digest = digest
                self._message_digests.update(digests)
                return len(vectors)
            if os.fstat(self._fd).st_size != self.size_bytes:  # ticks that cannot be taken back must not come twice
                self._fail(tick, problem)
                self._last_ticks = 0
        for count, vector in enumerate(vectors, start=1):  # finds the tick with which it fails
            self.append(tick + count - 1, vector, messages if count == 1 else ())
            if self.failure is not None:
                return count
        return len(vectors)

    def _sealed(self, tick: int, messages: Sequence[tuple[str, bytes]]) -> tuple[bytes, dict[int, bytes]]:
        """Return the messages of a tick as they lie in its frame, and the chained hashes of their streams after it."""
        digests: dict[int, bytes] = {}
        parts: list[bytes] = []
        for name, content in messages:
            if name not in self._streams:
                raise ValueError(f"a message for {name!r}, which is no stream of messages of this log")
            at = self._streams[name]
            part, digests[at] = seal_message(digests.get(at, self._message_digests[at]), tick, at, content)
            parts.append(part)
        sealed = b"".join(parts)
        if len(sealed) > MAX_FRAME_BYTES - self._vector_bytes - MAX_FRAME_BYTES // 64:
            raise ValueError(f"messages of {len(sealed)} bytes in one tick")
        return sealed, digests

    def close(self) -> None:
        """Sync and close. May be called again."""
        if self._closing.is_set():
            return
        self._closing.set()
        self._syncer.join()
        try:
            _synchronise(self._fd)
        except OSError as error:
            self._fail(self.ticks, f"sync: {error.strerror}")
        with suppress(OSError):
            self._hash()
            self.sha256 = self._hasher.hexdigest()
        self._close_descriptors()

    def put_back(self) -> None:
        """Write the file again where it was removed while it was open: its content is still there. Raises OSError."""
        if os.fstat(self._fd).st_nlink > 0 or self.path.exists():
            return
        with replaced(self.path) as draft, draft.open("wb") as file:
            for part in self._parts(0):
                file.write(part)
            file.flush()
            os.fsync(file.fileno())

    def __enter__(self) -> "LogWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _problem(self, frame: bytes) -> str | None:
        """Write frames; return why they are not in the file, None if they are. What is written in part is truncated."""
        try:
            written = os.write(self._fd, frame)
            if 0 < written < len(frame):
                written += os.write(self._fd, frame[written:])  # only this second write tells why not all of it fitted
            if written == len(frame) and os.fstat(self._fd).st_nlink > 0:
                self.size_bytes += written
                return None
            problem = "the file was removed" if written == len(frame) else f"only {written} of {len(frame)} bytes fit"
        except OSError as error:
            problem = str(error.strerror)
        with suppress(OSError):  # else the torn tail stays: readers report it and keep all whole frames
            os.ftruncate(self._fd, self.size_bytes)
        return problem

    def _fail(self, tick: int, problem: str | None) -> None:
        if problem is not None and self.failure is None:
            self.failure = f"{self.path}: recording stopped at tick {tick}: {problem}"

    def _parts(self, start: int) -> Iterator[bytes]:
        """Yield the whole frames written so far as blocks of bytes, from byte `start` of the file on."""
        end = self.size_bytes
        os.lseek(self._reading, start, os.SEEK_SET)
        while start < end and (part := os.read(self._reading, min(_READ_BYTES, end - start))):
            yield part
            start += len(part)

    def _close_descriptors(self) -> None:
        os.close(self._fd)
        os.close(self._reading)

    def _hash(self) -> None:
        for part in self._parts(self._hashed_bytes):
            self._hasher.update(part)
            self._hashed_bytes += len(part)

    def _sync(self, interval_s: float) -> None:
        while not self._closing.wait(interval_s):
            try:
                _synchronise(self._fd)
                self._hash()
            except OSError as error:
                # Only noted: the tick loop is the one that writes and truncates.
                self._fail(self.ticks, f"sync: {error.strerror}")
                return


class LogReader:
    """A recorded log. Iterating passes over the file anew, in constant memory.

    Attributes:
        header: what the streams mean.
        start: the bytes before the first frame, as they were recorded.
        breaks: where the file was not whole, as found by the latest complete pass.
        last: the last whole record, as found by the latest complete pass; None in a log without.
    """

    def __init__(self, path: Path) -> None:
        """Read the header.

        Raises:
            RecordingError: missing, not a log, damaged header, newer schema or other byte order.
        """
        self.path = path
        self.breaks: tuple[Break, ...] = ()
        self.last: Record | None = None
        try:
            with path.open("rb") as file:
                scan = Scan(file.read, str(path))
        except OSError as error:
            raise RecordingError(f"{path}: cannot be read: {error.strerror}") from None
        self.header, self.start = scan.header, scan.start

    def __iter__(self) -> Iterator[Record]:
        """Yield all whole records; never raises on a torn tail."""
        with self.path.open("rb", buffering=1 << 18) as file:
            scan = Scan(file.read, str(self.path))
            record = None
            for record in scan:
                yield record
        self.breaks, self.last = tuple(scan.breaks), record

    def messages(self, stream: str) -> Iterator[Message]:
        """Yield the messages of one stream in the order in which they arrived.

        Raises:
            RecordingError: no such stream in this recording.
        """
        at = stream_index(self.header, stream)
        for record in self:
            for message in record.messages:
                if message.stream == at:
                    yield Message(record.tick, message.content)

    def blocks(self, columns: Sequence[str] | None = None) -> Iterator[Block]:
        """Yield the whole records in blocks of at most BLOCK_TICKS, with only these columns (None: all).

        Raises:
            RecordingError: no such column in this recording.
        """
        wanted = places(self.header, columns)
        records = iter(self)
        while True:
            ticks, vectors, count = np.empty(BLOCK_TICKS, np.int64), np.empty((BLOCK_TICKS, len(wanted))), 0
            # Whole state vectors are in memory a few at a time: a block of them is larger than what is wanted of it.
            while count < BLOCK_TICKS and (some := list(islice(records, _AT_ONCE))):
                part = slice(count, count := count + len(some))
                ticks[part] = [record.tick for record in some]
                vectors[part] = np.concatenate([record.vector for record in some]).reshape(len(some), -1)[:, wanted]
            if count:
                yield Block(ticks[:count], vectors[:count])
            if count < BLOCK_TICKS:
                return

    def table(self, columns: Sequence[str] | None = None) -> LogTable:
        """Return all whole records as arrays, with only these columns (None: all).

        Raises:
            RecordingError: no such column in this recording.
        """
        return gathered(self.header, columns, self.blocks(columns))
