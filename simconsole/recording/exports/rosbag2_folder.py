"""rosbag2: a folder with metadata.yaml and an MCAP file in it, which `ros2 bag` plays."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from simconsole.bridge.messages import Registry
from simconsole.bridge.messages.definition_text import full_text
from simconsole.bridge.messages.hashes import rihs01
from simconsole.recording.exports.drive_topics import TopicMessage

SUFFIX: Final = ""
VERSION: Final = 8
"""Of metadata.yaml: what ROS 2 Jazzy writes; later ones spell quality of service in another way."""
_NEVER: Final = QosTime(0, 0)


def write_topics(registry: Registry, messages: Iterable[TopicMessage], path: Path) -> dict[str, int]:
    """Write a new folder; return the number of messages of each topic. Raises OSError."""
    counts: Counter[str] = Counter()
    connections: dict[str, Any] = {}
    writer = Writer(path, version=VERSION, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with writer:
        for message in messages:
            if message.topic not in connections:
                connections[message.topic] = _added(writer, registry, message)
            writer.write(connections[message.topic], message.time_ns, message.data)
            counts[message.topic] += 1
    return dict(counts)


def _added(writer: Writer, registry: Registry, message: TopicMessage) -> Any:
    return writer.add_connection(
        message.topic,
        message.type,
        msgdef=full_text(registry.with_parts(message.type)),
        rihs01=rihs01(registry, message.type),
        offered_qos_profiles=[_quality(message.latched)],
    )


def _quality(latched: bool) -> Qos:
    return Qos(
        history=QosHistory.KEEP_LAST,
        depth=1 if latched else 10,
        reliability=QosReliability.RELIABLE,
        durability=QosDurability.TRANSIENT_LOCAL if latched else QosDurability.VOLATILE,
        deadline=_NEVER,
        lifespan=_NEVER,
        liveliness=QosLiveliness.AUTOMATIC,
        liveliness_lease_duration=_NEVER,
        avoid_ros_namespace_conventions=False,
    )
