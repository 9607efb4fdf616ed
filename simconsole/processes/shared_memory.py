"""Shared memory between the core and its workers: mmap files in a run folder that only this user can read.

One writer and any number of readers a file; nobody waits for anybody. A record carries its number before and after
its content, written in that order and read in the opposite one: a reader that sees both equal has a whole record.
Files live in /dev/shm where there is one. `multiprocessing.shared_memory` is not used: in Python 3.11 the exit of any
reader unlinks the segment.
"""

import contextlib
import mmap
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.processes.lifetimes import undone
from simconsole.values.errors import WorkerError
from simconsole.values.kernels import Row
from simconsole.values.signals import Event

PREFIX: Final = "simconsole-"
MAGIC: Final = 0x53494D52494E4701  # 'SIMRING', layout 1
HEADER_WORDS: Final = 8  # magic, width, capacity, newest number, then spare
RECORD_HEAD_WORDS: Final = 3  # number, stamp, second stamp; the number again behind the values
_SYNCHRONIZE: Final = 0x00100000  # winnt.h
_WAIT_TIMEOUT: Final = 0x102  # winerror.h
_ERROR_ACCESS_DENIED: Final = 5
READ_TRIES: Final = 8
"""A reader gives up after so many records were overwritten under it; the next call succeeds."""

_owned: dict[Path, int] = {}  # run folders of this process, locked through these descriptors until it ends


class Record(NamedTuple):
    """One record: its number from 1, two integer stamps and a copy of its values."""

    number: int
    stamp: int
    second_stamp: int
    values: Row


class Ring:
    """Fixed-size float64 records, the newest `capacity` of them. Made by the writer, opened by readers.

    With capacity 4 it is a latest-wins slot: the writer never touches the record a reader is most likely reading.
    """

    def __init__(self, path: Path, width: int, capacity: int, writable: bool) -> None:
        size = 8 * (HEADER_WORDS + capacity * (RECORD_HEAD_WORDS + width + 1))
        flags = os.O_RDWR if writable else os.O_RDONLY
        try:
            descriptor = os.open(path, flags | getattr(os, "O_CLOEXEC", 0))
        except OSError as error:
            raise WorkerError(f"{path}: shared memory cannot be opened: {error.strerror}") from None
        try:
            access = mmap.ACCESS_WRITE if writable else mmap.ACCESS_READ
            self._memory = mmap.mmap(descriptor, size, access=access)
        except (OSError, ValueError) as error:
            raise WorkerError(f"{path}: shared memory of {size} bytes cannot be mapped: {error}") from None
        finally:
            os.close(descriptor)
        self._head: NDArray[np.int64] = np.frombuffer(self._memory, np.int64, HEADER_WORDS)
        words = RECORD_HEAD_WORDS + width + 1
        self._words = np.frombuffer(self._memory, np.int64, capacity * words, 8 * HEADER_WORDS).reshape(capacity, words)
        self._values = self._words.view(np.float64)[:, RECORD_HEAD_WORDS : RECORD_HEAD_WORDS + width]
        self.width, self.capacity = width, capacity

    @classmethod
    def create(cls, path: Path, width: int, capacity: int) -> "Ring":
        """Make a ring's file (mode 0600) and return its writer.

        Raises:
            WorkerError: the file is there already or cannot be made.
        """
        size = 8 * (HEADER_WORDS + capacity * (RECORD_HEAD_WORDS + width + 1))
        try:
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o600)
            try:
                _reserve(descriptor, size)
            finally:
                os.close(descriptor)
        except OSError as error:
            raise WorkerError(f"{path}: shared memory cannot be made: {error.strerror}") from None
        ring = cls(path, width, capacity, writable=True)
        ring._head[1], ring._head[2], ring._head[3] = width, capacity, 0
        ring._head[0] = MAGIC  # last: a reader that sees it sees a whole header
        return ring

    @classmethod
    def open(cls, path: Path, *, writable: bool = False) -> "Ring":
        """Open a ring that somebody else made.

        Raises:
            WorkerError: not there, or no ring of this layout.
        """
        try:
            with path.open("rb") as file:
                head = np.frombuffer(file.read(8 * HEADER_WORDS), np.int64)
        except OSError as error:
            raise WorkerError(f"{path}: shared memory cannot be opened: {error.strerror}") from None
        if len(head) != HEADER_WORDS or head[0] != MAGIC or head[1] < 1 or head[2] < 1:
            raise WorkerError(f"{path}: not a ring of this version")
        return cls(path, int(head[1]), int(head[2]), writable)

    @property
    def newest(self) -> int:
        """Number of the newest record, 0 before the first."""
        return int(self._head[3])

    def write(self, values: Row, stamp: int = 0, second_stamp: int = 0) -> None:
        """Publish a record. Only ever called by the one writer."""
        number = int(self._head[3]) + 1
        index = (number - 1) % self.capacity
        words = self._words[index]
        words[0] = number
        words[1] = stamp
        words[2] = second_stamp
        self._values[index] = values
        words[-1] = number
        self._head[3] = number

    def latest(self) -> Record | None:
        """Return the newest record, None before the first or if the writer laps this reader again and again."""
        for _ in range(READ_TRIES):
            number = int(self._head[3])
            if number == 0:
                return None
            record = self._read(number)
            if record is not None:
                return record
        return None

    def since(self, number: int) -> list[Record]:
        """Return all records after `number` that are still there, oldest first."""
        newest = int(self._head[3])
        first = max(number + 1, newest - self.capacity + 2)  # the oldest may be overwritten while it is read
        records = (self._read(index) for index in range(first, newest + 1))
        return [record for record in records if record is not None]

    def _read(self, number: int) -> Record | None:
        index = (number - 1) % self.capacity
        words = self._words[index]
        if int(words[-1]) != number:
            return None
        stamp, second_stamp, values = int(words[1]), int(words[2]), self._values[index].copy()
        if int(words[0]) != number:
            return None
        return Record(number, stamp, second_stamp, values)


class EventCounters:
    """Edges from one writer: a counter for each event, so none can be lost, however many come between two ticks.

    A mask of what happened since the last look is all that a tick wants; an emergency stop is therefore latched where
    it is written.
    """

    BITS: Final = 64

    def __init__(self, ring: Ring) -> None:
        self._counts: NDArray[np.int64] = ring._words[0, RECORD_HEAD_WORDS : RECORD_HEAD_WORDS + self.BITS]
        self._ring = ring
        self._seen = self._counts.tobytes()

    @classmethod
    def create(cls, path: Path) -> "EventCounters":
        """Make the file. Errors as `Ring.create`."""
        return cls(Ring.create(path, cls.BITS, 1))

    @classmethod
    def open(cls, path: Path, *, writable: bool = False) -> "EventCounters":
        """Open counters that somebody else made. Errors as `Ring.open`."""
        return cls(Ring.open(path, writable=writable))

    def raise_events(self, mask: int) -> None:
        """Count each event of a mask of `Event`. Only ever called by the one writer."""
        for event in Event:
            if mask & event:
                self._counts[event.value.bit_length() - 1] += 1

    def take(self) -> int:
        """Return the mask of events since the last call."""
        counts = self._counts.tobytes()
        if counts == self._seen:  # nearly every tick, and a tenth of the price of comparing arrays
            return 0
        moved = np.flatnonzero(np.frombuffer(counts, np.int64) != np.frombuffer(self._seen, np.int64))
        self._seen = counts
        return sum(1 << bit for bit in moved.tolist())


class TextQueue:
    """Texts from one writer to one reader: each arrives once, in order. A full queue takes none, so that none is lost.

    Reader and writer each move a number of their own, and neither waits: how many were written, and how many were read.
    """

    _NEWEST: Final = 3
    _TAKEN: Final = 4  # the words of the header that the writer and the reader move

    def __init__(self, ring: Ring) -> None:
        self._ring = ring
        self._head = ring._head.data  # as an array, one look would take three times as long

    @classmethod
    def create(cls, path: Path, text_bytes: int, capacity: int) -> "TextQueue":
        """Make the file, for `capacity` texts of at most `text_bytes` (a multiple of 8). Errors as `Ring.create`."""
        return cls(Ring.create(path, text_bytes // 8, capacity))

    @classmethod
    def open(cls, path: Path, *, writable: bool = False) -> "TextQueue":
        """Open a queue that somebody else made. Errors as `Ring.open`."""
        return cls(Ring.open(path, writable=writable))

    def put(self, text: bytes) -> bool:
        """Add a text; return False where it is too long or the queue is full. Only ever called by the one writer."""
        room_bytes = 8 * self._ring.width
        if len(text) > room_bytes or self._head[self._NEWEST] - self._head[self._TAKEN] >= self._ring.capacity:
            return False
        self._ring.write(np.frombuffer(text.ljust(room_bytes, b"\0"), np.float64), stamp=len(text))
        return True

    def take(self) -> list[bytes]:
        """Return the texts since the last call, oldest first. Only ever called by the one reader."""
        newest, taken = self._head[self._NEWEST], self._head[self._TAKEN]
        if newest == taken:  # nearly every tick
            return []
        records = [self._ring._read(number) for number in range(taken + 1, newest + 1)]
        self._head[self._TAKEN] = newest
        return [record.values.tobytes()[: record.stamp] for record in records if record is not None]


def make_run_folder() -> Path:
    """Return a new folder of mode 0700 for this process's files; folders of dead owners are removed first.

    Raises:
        WorkerError: it cannot be made.
    """
    return _make(_base())


@contextlib.contextmanager
def temporary_folder() -> Iterator[Path]:
    """Give a folder of mode 0700 for files that are too large for memory; it is gone after the block.

    Where a signal ends the process at once it is gone, too; where the process is killed, at the next `sweep`.

    Raises:
        WorkerError: it cannot be made.
    """
    folder = _make(Path(tempfile.gettempdir()))
    try:
        with undone(lambda: remove_run_folder(folder)):
            yield folder
    finally:
        remove_run_folder(folder)


def _make(base: Path) -> Path:
    sweep()
    try:
        folder = Path(tempfile.mkdtemp(prefix=f"{PREFIX}{os.getpid()}-", dir=base))
        if sys.platform != "win32":
            _owned[folder] = os.open(folder, os.O_RDONLY)
            _lock(_owned[folder])
    except OSError as error:
        raise WorkerError(f"{base}: no folder can be made there: {error.strerror}") from None
    return folder


def remove_run_folder(folder: Path) -> None:
    """Remove a run folder; mappings that are still open stay valid until they are closed."""
    gone = folder.with_name(f"{folder.name}-gone")  # `sweep` knows it as well
    with contextlib.suppress(OSError):
        folder.rename(gone)  # first: whoever still writes finds no folder, and cannot keep it from being empty
    for path in (gone, folder):
        shutil.rmtree(path, ignore_errors=True)
    descriptor = _owned.pop(folder, None)
    if descriptor is not None:
        os.close(descriptor)


def run_folders() -> list[Path]:
    """Return the run folders of this user's processes that go on."""
    mine = getattr(os, "getuid", lambda: 0)()
    found = []
    for path in sorted(_base().glob(f"{PREFIX}*-*")):
        owner = path.name.removeprefix(PREFIX).partition("-")[0]
        with contextlib.suppress(OSError):
            if owner.isdigit() and _alive(int(owner)) and path.is_dir() and path.stat().st_uid == mine:
                found.append(path)
    return found


def sweep(*bases: Path) -> list[Path]:
    """Remove what dead processes of this user have left in `bases`: folders and files; return all of it.

    Without bases, where they are made.
    """
    places = set(bases) or {_base(), Path(tempfile.gettempdir())}
    stale = [path for base in places for path in base.glob(f"{PREFIX}*-*") if _is_stale(path)]
    for path in stale:
        if path.is_dir():
            remove_run_folder(path)
        else:
            path.unlink(missing_ok=True)
    return stale


def _base() -> Path:
    memory = Path("/dev/shm")
    return memory if memory.is_dir() and os.access(memory, os.W_OK) else Path(tempfile.gettempdir())


def _reserve(descriptor: int, size: int) -> None:
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(descriptor, 0, size)  # a full /dev/shm is an error here, not a bus error at the first write
    else:
        os.ftruncate(descriptor, size)


def _is_stale(path: Path) -> bool:
    owner = path.name.removeprefix(PREFIX).partition("-")[0]
    if not owner.isdigit() or _alive(int(owner)):
        return False
    if sys.platform == "win32":  # temporary folders are a user's own, and nobody hides processes there
        return True
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return False  # gone meanwhile, a link, or somebody else's
    try:
        _lock(descriptor)
        return os.fstat(descriptor).st_uid == os.getuid()
    except OSError:
        return False  # its owner lives where this process cannot see it: containers may share /dev/shm
    finally:
        os.close(descriptor)


def _lock(descriptor: int) -> None:
    if sys.platform != "win32":
        import fcntl

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _alive(process_id: int) -> bool:
    if sys.platform == "win32":  # os.kill would end it there, whatever the signal
        import ctypes

        kernel32 = ctypes.WinDLL("kernel32", use_last_error=True)
        handle = kernel32.OpenProcess(_SYNCHRONIZE, False, process_id)
        if not handle:
            return ctypes.get_last_error() == _ERROR_ACCESS_DENIED
        alive = kernel32.WaitForSingleObject(handle, 0) == _WAIT_TIMEOUT
        kernel32.CloseHandle(handle)
        return bool(alive)
    try:
        os.kill(process_id, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
