"""What waits to be sent to one client: a bounded queue for each topic, the oldest dropped first and counted.

No client can make this grow: a topic keeps at most its depth of messages, and all topics together a number of bytes.
"""

from collections import deque
from typing import Final

from simconsole.bridge.operations import Id
from simconsole.units import NS_PER_S

MAX_REPLIES: Final = 64
NS_PER_MS: Final = NS_PER_S // 1000


class Outlet:
    """The messages of one topic on their way to one client."""

    __slots__ = ("default_depth", "depth", "dropped", "head", "next_ns", "texts", "throttle_ns", "wishes")

    def __init__(self, head: bytes, default_depth: int) -> None:
        """Start empty; `head` is the publish operation up to its message, in the client's spelling of the topic."""
        self.head = head
        self.default_depth = default_depth
        self.depth = default_depth
        self.throttle_ns = 0
        self.next_ns = 0
        self.dropped = 0
        self.texts: deque[bytes] = deque()
        self.wishes: dict[Id, tuple[int, int]] = {}

    def wish(self, identifier: Id, throttle_ms: float, depth: int) -> None:
        """Add or replace the subscription `identifier`; depth 0 asks for the topic's own."""
        self.wishes[identifier] = (int(throttle_ms * NS_PER_MS), depth or self.default_depth)
        self._merge()

    def withdraw(self, identifier: Id) -> bool:
        """End the subscription `identifier`, or all for None; return False if there was none of that id."""
        if identifier is None:
            self.wishes.clear()
            return True
        known = self.wishes.pop(identifier, None) is not None
        self._merge()
        return known

    def _merge(self) -> None:
        # Several subscriptions of one client to one topic are served by one delivery: the most demanding wins.
        if self.wishes:
            self.throttle_ns = min(throttle for throttle, _ in self.wishes.values())
            self.depth = max(depth for _, depth in self.wishes.values())


class Outgoing:
    """Everything that waits for one client. Topics take turns; replies go first."""

    def __init__(self, max_bytes: int) -> None:
        """Hold at most `max_bytes` of messages."""
        self.max_bytes = max_bytes
        self.bytes = 0
        self.dropped = 0
        self._replies: deque[bytes] = deque()
        self._waiting: dict[Outlet, None] = {}

    def reply(self, text: bytes) -> None:
        """Queue an answer to the client itself; of too many the oldest is dropped."""
        if len(self._replies) >= MAX_REPLIES:
            self._replies.popleft()
            self.dropped += 1
        self._replies.append(text)

    def put(self, outlet: Outlet, text: bytes) -> int:
        """Queue a message of a topic; return how many were dropped for it."""
        before = self.dropped
        while len(outlet.texts) >= outlet.depth:
            self._drop_oldest(outlet)
        while self.bytes + len(text) > self.max_bytes and self._waiting:
            self._drop_oldest(outlet if outlet.texts else next(iter(self._waiting)))
        if self.bytes + len(text) > self.max_bytes:
            outlet.dropped += 1
            self.dropped += 1
        else:
            outlet.texts.append(text)
            self.bytes += len(text)
            self._waiting[outlet] = None
        return self.dropped - before

    def take(self, now_ns: int) -> bytes | None:
        """Return the next text that may be sent at `now_ns`, or None."""
        if self._replies:
            return self._replies.popleft()
        for outlet in self._waiting:
            if outlet.next_ns <= now_ns:
                break
        else:
            return None
        text = outlet.texts.popleft()
        self.bytes -= len(text)
        outlet.next_ns = now_ns + outlet.throttle_ns
        del self._waiting[outlet]
        if outlet.texts:
            self._waiting[outlet] = None
        return text

    def due_ns(self) -> int | None:
        """Return when the next waiting text may be sent (0: now), None when nothing waits."""
        if self._replies:
            return 0
        return min((outlet.next_ns for outlet in self._waiting), default=None)

    def forget(self, outlet: Outlet) -> None:
        """Discard what waits of a topic that the client no longer wants."""
        self.bytes -= sum(map(len, outlet.texts))
        outlet.texts.clear()
        self._waiting.pop(outlet, None)

    def _drop_oldest(self, outlet: Outlet) -> None:
        self.bytes -= len(outlet.texts.popleft())
        outlet.dropped += 1
        self.dropped += 1
        if not outlet.texts:
            del self._waiting[outlet]
