"""What waits to be sent to one client: a bounded queue for each topic, the oldest dropped first and counted.

No client can make this grow: a topic keeps at most its depth of messages, and all topics together a number of bytes.
"""

from collections import deque
from collections.abc import Iterator
from typing import Final, NamedTuple

from simconsole.bridge.protocol.fragments import split
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.protocol.message_encoding import PLAIN_JSON, Encoding
from simconsole.bridge.protocol.operations import Id
from simconsole.values.units import NS_PER_S

MAX_REPLIES: Final = 256
NS_PER_MS: Final = NS_PER_S // 1000


_PREFERRED: Final = ("cbor-raw", "cbor", "png", "none")
"""Of several subscriptions of one client to one topic, as rosbridge_suite has it."""


class _Subscription(NamedTuple):
    throttle_ns: int
    depth: int
    encoding: Encoding
    fragment_size: int | None


class SubscriptionQueue:
    """The messages of one topic that wait for one client, merged over that client's subscriptions to it."""

    __slots__ = (
        "default_depth",
        "depth",
        "dropped",
        "encoding",
        "fragment_size",
        "head",
        "next_ns",
        "subscriptions",
        "texts",
        "throttle_ns",
        "topic",
    )  # fmt: skip

    def __init__(self, head: bytes, default_depth: int, topic: str = "") -> None:
        """Start empty; `head` is the publish operation up to its message, in the client's spelling of the topic."""
        self.head = head
        self.topic = topic
        self.encoding: Encoding = PLAIN_JSON
        self.fragment_size: int | None = None
        self.default_depth = default_depth
        self.depth = default_depth
        self.throttle_ns = 0
        self.next_ns = 0
        self.dropped = 0
        self.texts: deque[bytes] = deque()
        self.subscriptions: dict[Id, _Subscription] = {}

    def subscribe(
        self,
        identifier: Id,
        throttle_ms: float,
        depth: int,
        encoding: Encoding = PLAIN_JSON,
        fragment_size: int | None = None,
    ) -> None:
        """Add or replace the subscription `identifier`; depth 0 asks for the topic's own."""
        throttle_ns = int(throttle_ms * NS_PER_MS)
        self.subscriptions[identifier] = _Subscription(
            throttle_ns, depth or self.default_depth, encoding, fragment_size
        )
        self._merge()

    def unsubscribe(self, identifier: Id) -> bool:
        """End the subscription `identifier`, or all for None; return False if there was none of that id."""
        if identifier is None:
            self.subscriptions.clear()
            return True
        known = self.subscriptions.pop(identifier, None) is not None
        self._merge()
        return known

    def _merge(self) -> None:
        # Several subscriptions of one client to one topic are served by one delivery: the most demanding wins.
        if self.subscriptions:
            subscriptions = self.subscriptions.values()
            self.throttle_ns = min(subscription.throttle_ns for subscription in subscriptions)
            self.depth = max(subscription.depth for subscription in subscriptions)
            self.encoding = min(
                (subscription.encoding for subscription in subscriptions),
                key=lambda encoding: _PREFERRED.index(encoding.compression),
            )
            self.fragment_size = min(
                (subscription.fragment_size for subscription in subscriptions if subscription.fragment_size),
                default=None,
            )


class SendQueue:
    """Everything that waits to be sent to one client: replies first, then topics in turn."""

    def __init__(self, max_bytes: int) -> None:
        """Hold at most `max_bytes` of messages."""
        self.max_bytes = max_bytes
        self.bytes = 0
        self.dropped = 0
        self._replies: deque[tuple[bytes, int | None]] = deque()
        self._reply_bytes = 0
        self._pieces: Iterator[bytes] = iter(())
        self._piece: bytes | None = None
        self._messages = 0
        self._waiting: dict[SubscriptionQueue, None] = {}

    def reply(self, text: bytes, fragment_size: int | None = None) -> None:
        """Queue an answer to the client itself; of too many, or too long ones, the oldest is dropped."""
        self._replies.append((text, fragment_size))
        self._reply_bytes += len(text)
        while len(self._replies) > MAX_REPLIES or (self._reply_bytes > self.max_bytes and len(self._replies) > 1):
            self._reply_bytes -= len(self._replies.popleft()[0])
            self.dropped += 1

    def put(self, queue: SubscriptionQueue, text: bytes) -> int:
        """Queue a message of a topic; return how many were dropped for it."""
        before = self.dropped
        while len(queue.texts) >= queue.depth:
            self._drop_oldest(queue)
        while self.bytes + len(text) > self.max_bytes and self._waiting:
            self._drop_oldest(queue if queue.texts else next(iter(self._waiting)))
        if self.bytes + len(text) > self.max_bytes:
            queue.dropped += 1
            self.dropped += 1
        else:
            queue.texts.append(text)
            self.bytes += len(text)
            self._waiting[queue] = None
        return self.dropped - before

    def take(self, now_ns: int) -> bytes | None:
        """Return the next text that may be sent at `now_ns`, or None."""
        if self._piece is not None:
            piece, self._piece = self._piece, next(self._pieces, None)
            return piece
        if self._replies:
            text, size = self._replies.popleft()
            self._reply_bytes -= len(text)
            return self._in_pieces(text, size)
        for queue in self._waiting:
            if queue.next_ns <= now_ns:
                break
        else:
            return None
        text = queue.texts.popleft()
        self.bytes -= len(text)
        queue.next_ns = now_ns + queue.throttle_ns
        del self._waiting[queue]
        if queue.texts:
            self._waiting[queue] = None
        return self._in_pieces(text, queue.fragment_size)

    def _in_pieces(self, text: bytes, size: int | None) -> bytes:
        """Return a text or, if it is longer than the fragment size, its first piece; the others are taken next."""
        if size is None or len(text) <= size or isinstance(text, Binary):
            return text
        self._messages += 1
        self._pieces = split(text, size, f"f{self._messages}")
        first, self._piece = next(self._pieces), next(self._pieces, None)
        return first

    def due_ns(self) -> int | None:
        """Return when the next waiting text may be sent (0: now), None when nothing waits."""
        if self._replies or self._piece is not None:
            return 0
        return min((queue.next_ns for queue in self._waiting), default=None)

    def forget(self, queue: SubscriptionQueue) -> None:
        """Discard what waits of a topic that the client has unsubscribed from."""
        self.bytes -= sum(map(len, queue.texts))
        queue.texts.clear()
        self._waiting.pop(queue, None)

    def _drop_oldest(self, queue: SubscriptionQueue) -> None:
        self.bytes -= len(queue.texts.popleft())
        queue.dropped += 1
        self.dropped += 1
        if not queue.texts:
            del self._waiting[queue]
