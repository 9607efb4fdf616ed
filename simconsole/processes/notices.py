"""What the processes beside a drive have to say to people, for the operators' log: it stands on the terminal too.

Each process has a queue of its own in the run folder. Its reader takes each notice once, also a reader that was started
again; where nobody reads, a full queue takes no more.
"""

import logging
from pathlib import Path
from typing import Final, NamedTuple

import msgspec

from simconsole.processes.shared_memory import TextQueue
from simconsole.values.errors import WorkerError

PREFIX: Final = "notices."
NOTICE_BYTES: Final = 512
CAPACITY: Final = 64
_TEXT_CHARACTERS: Final = 100
"""Of the longest text: JSON writes a character with up to 4 bytes."""


class Notice(NamedTuple):
    """One notice."""

    level: str  # WARN or ERROR
    text: str  # begins with the name of who says it


class NoticeWriter:
    """One process's notices."""

    def __init__(self, folder: Path, name: str) -> None:
        """Begin or, in a process that was started again, go on.

        Raises:
            WorkerError: the run folder is gone.
        """
        path = folder / f"{PREFIX}{name}"
        self._name = name
        self._queue = (
            TextQueue.open(path, writable=True) if path.exists() else TextQueue.create(path, NOTICE_BYTES, CAPACITY)
        )

    def tell(self, level: str, text: str) -> None:
        """Tell something; too long a text is cut."""
        said = f"{self._name}: {text}"
        if len(said) > _TEXT_CHARACTERS:
            said = said[: _TEXT_CHARACTERS - 3] + "..."
        self._queue.put(msgspec.json.encode(Notice(level, said)))


class NoticeHandler(logging.Handler):
    """Makes notices of what a process logs."""

    def __init__(self, writer: NoticeWriter) -> None:
        super().__init__(logging.WARNING)
        self._writer = writer

    def emit(self, record: logging.LogRecord) -> None:
        """Tell what is logged."""
        self._writer.tell("WARN" if record.levelno < logging.ERROR else "ERROR", record.getMessage())


def log_notices(writer: NoticeWriter) -> None:
    """Make notices of all warnings that this process logs; they go to standard error as they do without."""
    root = logging.getLogger()
    root.addHandler(NoticeHandler(writer))
    if logging.lastResort is not None:
        root.addHandler(logging.lastResort)


class NoticeReader:
    """Takes the notices of all processes of a drive."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._queues: dict[Path, TextQueue] = {}

    def take(self) -> list[Notice]:
        """Return the notices that nobody has taken yet."""
        for path in self._folder.glob(f"{PREFIX}*"):
            if path not in self._queues:
                try:
                    self._queues[path] = TextQueue.open(path, writable=True)
                except WorkerError:
                    continue  # it is only just being made
        return [
            msgspec.json.decode(text, type=Notice)
            for path in sorted(self._queues)
            for text in self._queues[path].take()
        ]
