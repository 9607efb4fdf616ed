"""Files that are replaced at once: a reader, a crash or a full disk sees the old one or the new one, never a part."""

import errno
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

DRAFT: Final = ".new"
"""Suffix of the draft that holds a file's next content while it is being written."""

_FILE: Final = os.O_RDWR | os.O_CREAT | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)


def draft_of(path: Path) -> Path:
    """Return where the next content of `path` is written before it takes its place."""
    return path.with_name(path.name + DRAFT)


def write_atomically(path: Path, content: bytes | str, durable: bool = True) -> None:
    """Replace `path` by `content` (text as UTF-8). Raises OSError, and then leaves what was there and no draft.

    Args:
        path: the file; it need not exist.
        content: what it holds afterwards.
        durable: wait until it is on the disk. Files that a power cut may lose, as in shared memory, need not be.
    """
    with replaced(path) as draft:
        # Not truncated first: so it uses the space that `reserve` took, even on a disk that has filled since.
        descriptor = os.open(draft, _FILE, 0o644)
        try:
            content = content.encode() if isinstance(content, str) else content
            _write(descriptor, content)
            os.ftruncate(descriptor, len(content))
            if durable:
                os.fsync(descriptor)
        finally:
            os.close(descriptor)
    if durable:
        sync_folder(path.parent)


def sync_folder(folder: Path) -> None:
    """Sync the names in a folder to the disk. Raises OSError. Does nothing where folders cannot be opened."""
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


@contextmanager
def replaced(path: Path) -> Iterator[Path]:
    """Yield a draft to write; on leaving, it replaces `path`, or is removed after an error."""
    draft = draft_of(path)
    try:
        yield draft
        draft.replace(path)
    except BaseException:
        with suppress(OSError):
            draft.unlink()
        raise


@contextmanager
def held_alone(path: Path) -> Iterator[None]:
    """Hold a file (made where it is missing) that no other process or thread holds meanwhile; wait for who does.

    The end of a process lets go of what it held. Does not wait on Windows, nor on a disk that has no locks, as those of
    some clusters. Raises OSError: the file cannot be made.
    """
    descriptor = os.open(path, _FILE, 0o644)
    try:
        if sys.platform != "win32":
            import fcntl

            with suppress(OSError):
                fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def reserve(path: Path, size_bytes: int) -> None:
    """Reserve space for the next `write_atomically` of `path`: it then succeeds on a full disk. Raises OSError."""
    descriptor = os.open(draft_of(path), _FILE, 0o644)
    try:
        _take_room(descriptor, size_bytes)
    except BaseException:
        with suppress(OSError):
            draft_of(path).unlink()
        raise
    finally:
        os.close(descriptor)


def give_back(path: Path, size_bytes: int) -> None:
    """Shrink the space that `reserve` took to `size_bytes`; does nothing where it is smaller. Raises OSError."""
    if draft_of(path).stat().st_size > size_bytes:
        os.truncate(draft_of(path), size_bytes)


def _take_room(descriptor: int, size_bytes: int) -> None:
    if hasattr(os, "posix_fallocate"):
        try:
            os.posix_fallocate(descriptor, 0, size_bytes)
            return
        except OSError as error:
            if error.errno not in (errno.EOPNOTSUPP, errno.EINVAL):
                raise
    _write(descriptor, bytes(size_bytes))


def _write(descriptor: int, content: bytes) -> None:
    view = memoryview(content)
    while view:
        view = view[os.write(descriptor, view) :]
