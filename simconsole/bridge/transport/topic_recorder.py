"""Topics of the bridge into an MCAP file, in CDR with their definitions: what rosbag2 and every MCAP tool reads.

The recorder is one more client of the router: it gets what clients get, when they get it.
"""

import logging
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Final

import cbor2
import msgspec

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.transport.topic_file import TopicFile
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import BridgeError
from simconsole.values.units import NS_PER_S

NAME: Final = "topics.mcap"
MAX_FILES: Final = 100
_QUEUE: Final = 1000

_logger = logging.getLogger("simconsole.bridge.transport.topic_recorder")


class TopicRecorder:
    """Records the topics of one console bridge. A failing disk ends the recording and nothing else."""

    def __init__(self, console: ConsoleBridge, folder: Path, patterns: tuple[str, ...]) -> None:
        """Begin a file in `folder` with the topics whose names fit one of `patterns`, as shells match file names.

        Raises:
            BridgeError: it cannot be made.
        """
        self._router = console.router
        self._patterns = patterns
        self._failed = False
        try:
            self._file = _new_file(folder)
        except OSError as error:
            raise BridgeError(f"outputs.bridge.record: {folder}: {error}") from None
        self._writer: TopicFile | None = TopicFile(self._file, self._router.registry)
        self._session = self._router.connect("record", self._drain, role=Role.VIEW)
        self._session.set_level("none")

    def update(self, now_ns: int) -> None:
        """Subscribe to new topics and unsubscribe from those that are gone."""
        if self._failed:
            self.close()  # not at once: the router was in the midst of its subscribers
        if self._writer is None:
            return
        for name, topic in self._router.topics.items():
            fits = any(fnmatchcase(name, pattern) for pattern in self._patterns)
            if fits and name not in self._session.queues:
                self._writer.add(name, topic.type)
                self._submit(now_ns, op="subscribe", topic=name, compression="cbor-raw", queue_length=_QUEUE)
            elif not topic.owned and name in self._session.queues and not topic.publishers:
                others = topic.subscribers.keys() - {self._session.number}
                if not others:  # else this recorder alone would keep it
                    self._submit(now_ns, op="unsubscribe", topic=name)

    def close(self) -> None:
        """Finish the file; harmless when closed."""
        writer, self._writer = self._writer, None
        if writer is None:
            return
        self._router.disconnect(self._session, 0)
        for end in (writer.finish, self._file.close):
            try:
                end()
            except OSError as error:
                _logger.warning("%s: %s", self._file.name, error)

    def _submit(self, now_ns: int, **operation: Any) -> None:
        self._router.receive(self._session, msgspec.json.encode(operation), now_ns)

    def _drain(self) -> None:
        """Write what has come, at once: nothing waits here, so nothing is lost to a bound."""
        while self._writer is not None and (text := self._session.next_text(0)) is not None:
            if self._failed or not isinstance(text, Binary):
                continue
            published = cbor2.loads(text)
            name, message = published["topic"], published["msg"]
            time_ns = message["secs"] * NS_PER_S + message["nsecs"]
            try:
                self._writer.write(name, time_ns, message["bytes"])
            except OSError as error:
                _logger.warning("%s: recording ends: %s", self._file.name, error)
                self._failed = True


def open_recorder(console: ConsoleBridge, profile: BridgeProfile, folder: Path | None) -> TopicRecorder | None:
    """Return a recorder if the profile asks for one and there is a bundle to record into.

    Raises:
        BridgeError: its file cannot be made.
    """
    return TopicRecorder(console, folder, profile.record) if profile.record and folder is not None else None


def _new_file(folder: Path) -> Any:
    """Open a file that is new: a bridge that was restarted does not write over what it recorded before."""
    for number in range(1, MAX_FILES + 1):
        name = NAME if number == 1 else f"{Path(NAME).stem}.{number}.mcap"
        try:
            return (folder / name).open("xb")
        except FileExistsError:
            continue
    raise OSError(f"{MAX_FILES} recordings already")
