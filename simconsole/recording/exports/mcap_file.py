"""MCAP, profile ros2: every topic in CDR with its definition."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from simconsole.bridge.messages import Registry
from simconsole.bridge.transport.topic_file import TopicFile
from simconsole.recording.exports.drive_topics import TopicMessage

SUFFIX: Final = ".mcap"


def write_topics(registry: Registry, messages: Iterable[TopicMessage], path: Path) -> dict[str, int]:
    """Write a new file; return the number of messages of each topic. Raises OSError."""
    counts: Counter[str] = Counter()
    with path.open("xb") as file:
        topics = TopicFile(file, registry)
        for message in messages:
            topics.add(message.topic, message.type, message.latched)
            topics.write(message.topic, message.time_ns, message.data)
            counts[message.topic] += 1
        topics.finish()
    return dict(counts)
