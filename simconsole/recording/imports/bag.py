"""Recordings of any ROS system: MCAP, rosbag2 and ROS 1 bags through one reader, their messages as plain values.

Nothing in such a file is trusted: whatever the reader trips over is one error that names the file.
"""

from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.definition_text import full_text
from simconsole.values.errors import RecordingError, one_line

SUFFIXES: Final = (".mcap", ".bag", ".db3")
METADATA: Final = "metadata.yaml"
MAX_METADATA_BYTES: Final = 16 << 20
WALL_TIME_NS: Final = 10**18
"""Times from here on (September 2001) are those of a wall clock; a simulation that counts from 0 never comes there."""
_PLACEHOLDER: Final = "structure_needs_at_least_one_member"


class BagTopic(NamedTuple):
    """One topic of a bag: its type in three parts, and how many messages it has."""

    name: str
    type: str
    messages: int


class BagMessage(NamedTuple):
    """One message: when it was recorded, in the bag's time, and its content as dicts, lists and scalars."""

    topic: str
    time_ns: int
    plain: dict[str, Any]


class Bag:
    """A bag whose topics are known; messages are read from the file at each pass, in the order of their times.

    Attributes:
        path: the file or folder.
        topics: every topic in it.
        start_ns: the time of its first message; 0 where it has none.
    """

    def __init__(self, path: Path, types: Sequence[str] = ()) -> None:
        """Look into a bag.

        Args:
            path: an .mcap, .bag or .db3 file, or a folder of rosbag2.
            types: those to know where the bag holds no definitions, as those of older ROS 2 do not.

        Raises:
            RecordingError: no bag, or damaged.
        """
        self.path = path
        self._types = tuple(types)
        _check_kind(path)
        with self._reader() as reader:
            self.topics = tuple(
                BagTopic(connection.topic, connection.msgtype, connection.msgcount) for connection in reader.connections
            )
            self.start_ns = int(reader.start_time) if any(topic.messages for topic in self.topics) else 0

    @property
    def offset_ns(self) -> int:
        """What to subtract from its times: nothing of simulated time, its start of a wall clock's."""
        return self.start_ns if self.start_ns >= WALL_TIME_NS else 0

    def messages(self, topics: Sequence[str]) -> Generator[BagMessage, None, None]:
        """Yield the messages of these topics, at their times less `offset_ns`. Memory does not grow with the bag.

        Raises:
            RecordingError: the bag is damaged.
        """
        offset_ns = self.offset_ns
        with self._reader() as reader:
            wanted = [connection for connection in reader.connections if connection.topic in topics]
            if not wanted:
                return
            for connection, time_ns, data in reader.messages(connections=wanted):
                content = _plain(reader.typestore, reader.deserialize(data, connection.msgtype))
                yield BagMessage(connection.topic, int(time_ns) - offset_ns, content)

    @contextmanager
    def _reader(self) -> Iterator[Any]:
        """Open the bag; errors of the reading library, whatever they are, become one of ours."""
        from rosbags.highlevel import AnyReader

        try:
            with AnyReader([self.path], default_typestore=_typestore(self._types)) as reader:
                yield reader
        except RecordingError:
            raise
        except Exception as error:  # noqa: BLE001  a damaged file may raise anything in the library
            raise RecordingError(f"{self.path}: cannot be read as a bag: {one_line(error)[:300]}") from None


def _check_kind(path: Path) -> None:
    if path.is_dir():
        metadata = path / METADATA
        if not metadata.is_file():
            raise RecordingError(f"{path}: not a bag: it holds no {METADATA}")
        if metadata.stat().st_size > MAX_METADATA_BYTES:
            raise RecordingError(f"{metadata}: {metadata.stat().st_size} bytes, allowed up to {MAX_METADATA_BYTES}")
    elif not path.is_file():
        raise RecordingError(f"{path}: not a bag: no such file")
    elif path.suffix not in SUFFIXES:
        raise RecordingError(f"{path}: not a bag: a folder of rosbag2, or a file {', '.join(SUFFIXES)}")


def _typestore(types: Sequence[str]) -> Any:
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    registry, store = standard_registry(), get_typestore(Stores.EMPTY)
    definitions: dict[str, Any] = {}
    for name in types:
        definitions.update(get_types_from_msg(full_text(registry.with_parts(name)), registry.resolve(name)))
    store.register(definitions)
    return store


def _plain(store: Any, value: Any) -> Any:
    """Return a message of the reading library as plain values: its fields, without constants and placeholders."""
    kind = getattr(value, "__msgtype__", None)
    if kind is not None:
        names = (name for name, _ in store.fielddefs[kind][1] if name != _PLACEHOLDER)
        return {name: _plain(store, getattr(value, name)) for name in names}
    if isinstance(value, np.ndarray):
        return value.tobytes() if value.dtype == np.uint8 else value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(store, item) for item in value]
    return value.item() if isinstance(value, np.generic) else value
