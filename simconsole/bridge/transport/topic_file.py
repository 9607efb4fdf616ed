"""Topics in one MCAP file, in CDR with their definitions: what rosbag2 and every MCAP tool reads."""

from typing import IO, Final

from simconsole.bridge.messages import Registry
from simconsole.bridge.messages.definition_text import full_text

LATCHED: Final = """\
- history: 1
  depth: 1
  reliability: 1
  durability: 1
  deadline: {sec: 0, nsec: 0}
  lifespan: {sec: 0, nsec: 0}
  liveliness: 1
  liveliness_lease_duration: {sec: 0, nsec: 0}
  avoid_ros_namespace_conventions: false
"""
"""Quality of service of a latched topic in rosbag2's numbers (keep last, reliable, transient local): who plays the file
latches it again."""


class TopicFile:
    """Writes messages of topics to an open file. A failing disk raises OSError."""

    def __init__(self, file: IO[bytes], registry: Registry) -> None:
        """Begin the file; `registry` has the definitions of its types."""
        from mcap.writer import Writer

        self._registry = registry
        self._channels: dict[str, tuple[str, int]] = {}
        self._schemas: dict[str, int] = {}
        self._sequences: dict[str, int] = {}
        self._writer = Writer(file)
        self._writer.start(profile="ros2", library="simconsole")

    def add(self, topic: str, type_name: str, latched: bool = False) -> None:
        """Add a topic, or one of another type under its name; harmless when it is there."""
        known = self._channels.get(topic)
        if known is not None and known[0] == type_name:
            return
        if type_name not in self._schemas:
            text = full_text(self._registry.with_parts(type_name))
            self._schemas[type_name] = self._writer.register_schema(type_name, "ros2msg", text.encode())
        quality = {"offered_qos_profiles": LATCHED} if latched else {}
        channel = self._writer.register_channel(topic, "cdr", self._schemas[type_name], quality)
        self._channels[topic] = (type_name, channel)

    def write(self, topic: str, time_ns: int, data: bytes) -> None:
        """Append a message in CDR of a topic that was added, logged and published at `time_ns`."""
        number = self._sequences[topic] = self._sequences.get(topic, 0) + 1
        self._writer.add_message(self._channels[topic][1], time_ns, data, time_ns, number)

    def finish(self) -> None:
        """Write the index. The file itself stays open."""
        self._writer.finish()  # type: ignore[no-untyped-call]
