"""What waits to be sent to one client: a bounded queue for each topic, the oldest dropped first and counted.

No client can make this grow: a topic keeps at most its depth of messages, all topics together a number of bytes (or
the newest message of each), and all clients together another number of bytes.
"""

from collections import deque
from collections.abc import Callable, Iterator
from typing import Final, NamedTuple

from simconsole.bridge.protocol.fragments import split
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.protocol.message_encoding import PLAIN_JSON, Encoding
from simconsole.bridge.protocol.operations import Id
from simconsole.values.units import NS_PER_S

MAX_REPLIES: Final = 256
_PIECE_BYTES: Final = 64
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
        "told_ns",
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
        self.told_ns: int | None = None
        """When the client was last told that messages of this topic are dropped."""
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


class SendBudget:
    """The bytes that may wait for all clients of a server together; the longest queue pays for more."""

    def __init__(self, max_bytes: int) -> None:
        """Start with nobody."""
        self.max_bytes = max_bytes
        self._queues: set[SendQueue] = set()
        self.bytes = 0

    def join(self, queue: "SendQueue") -> None:
        """Count a client's queue, which is empty."""
        self._queues.add(queue)

    def leave(self, queue: "SendQueue") -> None:
        """Count a client's queue no more."""
        self._queues.discard(queue)
        self.bytes -= queue.waiting_bytes

    def make_room(self, size: int, now_ns: int) -> None:
        """Drop the oldest of the longest queue until `size` bytes more fit, or nothing waits."""
        while self.bytes + size > self.max_bytes and self.bytes:
            max(self._queues, key=lambda queue: queue.waiting_bytes).drop_oldest(now_ns)


Dropped = Callable[[SubscriptionQueue, int], None]
"""Told of each message of a topic that is lost to its client, with the time in ns."""


class SendQueue:
    """Everything that waits to be sent to one client: replies first, then topics in turn.

    All messages together have a bound, but the newest of each topic is kept whatever its length.
    """

    def __init__(
        self, max_bytes: int, budget: SendBudget | None = None, on_dropped: Dropped = lambda queue, now_ns: None
    ) -> None:
        """Hold at most `max_bytes`, or the newest message of each topic, and no more than `budget` has."""
        self.max_bytes = max_bytes
        self.bytes = 0
        self.dropped = 0
        self.taken = 0
        """Texts that were taken to be sent."""
        self._budget = budget or SendBudget(2**63)
        self._budget.join(self)
        self._on_dropped = on_dropped
        self._backlog = 0
        """Bytes of messages that are not the newest of their topic."""
        self._replies: deque[tuple[bytes, int | None]] = deque()
        self._reply_bytes = 0
        self.answered_bytes = 0
        """What all answers so far have cost, each piece of one something more."""
        self._pieces: Iterator[bytes] = iter(())
        self._piece: bytes | None = None
        self._messages = 0
        self._waiting: dict[SubscriptionQueue, None] = {}

    @property
    def waiting_bytes(self) -> int:
        """What waits, replies too."""
        return self.bytes + self._reply_bytes

    def close(self) -> None:
        """Give back what the budget has counted."""
        self._budget.leave(self)

    def reply(self, text: bytes, fragment_size: int | None = None) -> None:
        """Queue an answer to the client itself; of too many, or too long ones, the oldest is dropped."""
        self._replies.append((text, fragment_size))
        self.answered_bytes += len(text) + (_PIECE_BYTES * (len(text) // fragment_size) if fragment_size else 0)
        self._reply_bytes += len(text)
        self._budget.bytes += len(text)
        while len(self._replies) > MAX_REPLIES or (self._reply_bytes > self.max_bytes and len(self._replies) > 1):
            self._take_reply()
            self.dropped += 1

    def put(self, queue: SubscriptionQueue, text: bytes, now_ns: int = 0) -> None:
        """Queue a message of a topic; what must make room for it is dropped."""
        texts = queue.texts
        if len(texts) >= queue.depth:
            self._shorten(queue, now_ns)
        size, budget = len(text), self._budget
        if budget.bytes + size > budget.max_bytes:
            budget.make_room(size, now_ns)
        if texts:
            self._backlog += len(texts[-1])
        else:
            self._waiting[queue] = None
        texts.append(text)
        self.bytes += size
        budget.bytes += size
        while self.bytes > self.max_bytes and self._backlog:
            longer = queue if len(queue.texts) > 1 else next(each for each in self._waiting if len(each.texts) > 1)
            self._drop(longer, now_ns)

    def lose(self, queue: SubscriptionQueue, count: int, now_ns: int) -> None:
        """Count lost messages of a topic; a client that has asked for the newest now and then is not told."""
        queue.dropped += count
        self.dropped += count
        if queue.depth > 1 and not queue.throttle_ns:
            self._on_dropped(queue, now_ns)

    def take(self, now_ns: int) -> bytes | None:
        """Return the next text that may be sent at `now_ns`, or None."""
        if self._piece is not None:
            self.taken += 1
            piece, self._piece = self._piece, next(self._pieces, None)
            return piece
        if self._replies:
            self.taken += 1
            return self._in_pieces(*self._take_reply())
        if not self._waiting:
            return None
        for queue in self._waiting:
            if queue.next_ns <= now_ns:
                break
        else:
            return None
        self.taken += 1
        text = self._pop(queue)
        queue.next_ns = now_ns + queue.throttle_ns
        if queue.texts:  # behind the others
            del self._waiting[queue]
            self._waiting[queue] = None
        return text if queue.fragment_size is None else self._in_pieces(text, queue.fragment_size)

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
        if not self._waiting:
            return None
        return min(queue.next_ns for queue in self._waiting)

    def forget(self, queue: SubscriptionQueue) -> None:
        """Discard what waits of a topic that the client has unsubscribed from."""
        while queue.texts:
            self._pop(queue)

    def drop_oldest(self, now_ns: int) -> None:
        """Drop one message to make room for other clients: of a topic if there is one."""
        if self._waiting:
            self._drop(max(self._waiting, key=lambda queue: len(queue.texts[0])), now_ns)
        else:
            self._take_reply()
            self.dropped += 1

    def _shorten(self, queue: SubscriptionQueue, now_ns: int) -> None:
        """Make room for one more message in a topic's queue that is full."""
        while len(queue.texts) >= queue.depth:
            self._pop(queue)
            self.lose(queue, 1, now_ns)

    def _drop(self, queue: SubscriptionQueue, now_ns: int) -> None:
        self._pop(queue)
        queue.dropped += 1
        self.dropped += 1
        self._on_dropped(queue, now_ns)

    def _pop(self, queue: SubscriptionQueue) -> bytes:
        text = queue.texts.popleft()
        size = len(text)
        self.bytes -= size
        self._budget.bytes -= size
        if queue.texts:
            self._backlog -= size
        else:
            del self._waiting[queue]
        return text

    def _take_reply(self) -> tuple[bytes, int | None]:
        text, size = self._replies.popleft()
        self._reply_bytes -= len(text)
        self._budget.bytes -= len(text)
        return text, size
