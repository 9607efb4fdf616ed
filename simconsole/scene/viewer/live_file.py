"""The file that a running drive's scene is appended to, whole batches only: whoever reads it never sees half of one."""

import os
import struct
from pathlib import Path
from typing import Final

from simconsole.values.errors import WorkerError

HEAD: Final = b"RRF2"
HEAD_BYTES: Final = 12
FRAME: Final = struct.Struct("<QQ")
"""What stands before each message of an RRD stream: its kind and its length in bytes."""
END: Final = 0
"""Kind of the message with which a stream ends; an index of the stream follows."""


def messages_of(stream: bytes) -> bytes:
    """Return the messages of a whole RRD stream, without its head and without its end and index.

    Raises:
        WorkerError: it is none.
    """
    at = HEAD_BYTES
    while stream.startswith(HEAD) and at + FRAME.size <= len(stream):
        kind, length = FRAME.unpack_from(stream, at)
        if kind == END:
            return stream[HEAD_BYTES:at]
        at += FRAME.size + length
    raise WorkerError("rerun has written no stream of the kind that simconsole knows")


class LiveFile:
    """Appends to a file. A process that was restarted goes on where the one before it stopped."""

    def __init__(self, path: Path) -> None:
        """Open or make the file.

        Raises:
            WorkerError: it cannot be opened.
        """
        self._path = path
        try:
            self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND | getattr(os, "O_BINARY", 0), 0o666)
            self.length = os.fstat(self._file).st_size
        except OSError as problem:
            raise WorkerError(f"{path}: the scene cannot be written: {problem.strerror}") from None

    def append(self, stream: bytes) -> None:
        """Write the messages of a stream; what does not fit leaves nothing. The file is one stream without an end.

        Raises:
            WorkerError: they cannot be written whole.
        """
        if not stream:
            return
        batch = messages_of(stream) if self.length else stream[:HEAD_BYTES] + messages_of(stream)
        try:
            written = os.write(self._file, batch)
            if written < len(batch):
                os.ftruncate(self._file, self.length)
                raise WorkerError(f"{self._path}: the scene cannot be written: the disk is full")
        except OSError as problem:
            raise WorkerError(f"{self._path}: the scene cannot be written: {problem.strerror}") from None
        self.length += written

    def close(self) -> None:
        """Close the file."""
        os.close(self._file)
