"""Messages of the graph on their way from rclpy's thread to the bridge's: bounded topic by topic, still in CDR.

What is too much for the bridge is dropped here, before it costs anything; no topic pushes out another's messages.
"""

import threading
from collections import deque
from typing import Final

from simconsole.bridge.ros2.graph_topics import ReceivedMessage

TOPIC_MESSAGES: Final = 100
TOPIC_BYTES: Final = 4_194_304
"""What waits of one topic; its newest message does whatever its length."""
TURN_MESSAGES: Final = 32
TURN_BYTES: Final = 262_144
"""What is taken at once, so that clients need not wait for longer."""


class ReceivedMessages:
    """What has come and was not taken yet. Threads may use it together."""

    def __init__(self) -> None:
        """Start empty."""
        self._lock = threading.Lock()
        self._topics: dict[str, deque[ReceivedMessage]] = {}
        self._bytes: dict[str, int] = {}
        self._dropped: dict[str, int] = {}

    @property
    def waits(self) -> bool:
        """Whether there is something to take."""
        return bool(self._topics)

    def put(self, message: ReceivedMessage) -> None:
        """Add a message; the oldest of its topic are dropped when too many wait."""
        name = message.topic
        with self._lock:
            queue = self._topics.setdefault(name, deque())
            queue.append(message)
            self._bytes[name] = self._bytes.get(name, 0) + len(message.data)
            while len(queue) > 1 and (len(queue) > TOPIC_MESSAGES or self._bytes[name] > TOPIC_BYTES):
                self._bytes[name] -= len(queue.popleft().data)
                self._dropped[name] = self._dropped.get(name, 0) + 1

    def take(self) -> list[ReceivedMessage]:
        """Return some messages, topic by topic in turn; what is left is for the next time."""
        taken: list[ReceivedMessage] = []
        size = 0
        with self._lock:
            while self._topics and len(taken) < TURN_MESSAGES and size < TURN_BYTES:
                name = next(iter(self._topics))
                queue = self._topics.pop(name)
                message = queue.popleft()
                taken.append(message)
                size += len(message.data)
                self._bytes[name] -= len(message.data)
                if queue:
                    self._topics[name] = queue  # behind the others
        return taken

    def take_dropped(self) -> dict[str, int]:
        """Return how many messages of each topic were lost since this was last asked."""
        with self._lock:
            dropped, self._dropped = self._dropped, {}
        return dropped
