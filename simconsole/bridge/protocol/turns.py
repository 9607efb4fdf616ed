"""Fair shares of an event loop: what one turn does for all clients together has a bound, and they take turns in it.

A client whose answers are long for what it sends (rosapi, answers in small pieces) is slowed to a rate of its own, so
that it makes nobody else wait. Time is given, in ns.
"""

from collections import deque
from collections.abc import Callable
from typing import Final

from simconsole.bridge.protocol.rate_limiter import ByteMeter

TURN_MESSAGES: Final = 64
TURN_BYTES: Final = 262_144
"""Of messages and of the answers to them, for all clients together."""
FULL_MESSAGES: Final = 256
FULL_BYTES: Final = 65_536
"""From so many on no more is read from a client, whose system then holds back what follows."""


class Inbox:
    """What has come from one client and waits for its turn."""

    def __init__(self, apply: Callable[[bytes, int], int], meter: ByteMeter) -> None:
        """Start empty; `apply` handles a message at a time in ns and returns the bytes that its answers cost."""
        self.apply = apply
        self.meter = meter
        self.messages: deque[bytes] = deque()
        self.bytes = 0

    @property
    def is_full(self) -> bool:
        """Whether no more should be read from the client."""
        return self.bytes > FULL_BYTES or len(self.messages) > FULL_MESSAGES

    def put(self, message: bytes) -> None:
        """Let a message wait."""
        self.messages.append(message)
        self.bytes += len(message)

    def pop(self) -> bytes:
        """Return the message that has waited longest."""
        message = self.messages.popleft()
        self.bytes -= len(message)
        return message


class Turns:
    """The clients' messages of one event loop."""

    def __init__(self, messages: int = TURN_MESSAGES, num_bytes: int = TURN_BYTES) -> None:
        """Handle at most so many messages, and begin none once so many bytes were handled, in one turn."""
        self._messages = messages
        self._bytes = num_bytes
        self._left_messages = messages
        self._left_bytes = num_bytes
        self._waiting: dict[Inbox, None] = {}

    @property
    def waits(self) -> bool:
        """Whether a turn is needed."""
        return bool(self._waiting)

    def receive(self, inbox: Inbox, message: bytes, now_ns: int) -> bool:
        """Handle a message at once if its client and this turn have something left; else it waits, and return False."""
        if not inbox.messages and self._left_messages > 0 and self._left_bytes > 0 and inbox.meter.ready_ns <= now_ns:
            self._handle(inbox, message, now_ns)
            return True
        inbox.put(message)
        self._waiting[inbox] = None
        return False

    def run(self, now_ns: int) -> int | None:
        """Take a turn; return when the next one is due (0: at once), None when nothing waits."""
        self._left_messages, self._left_bytes = self._messages, self._bytes
        ready = deque(inbox for inbox in self._waiting if inbox.meter.ready_ns <= now_ns)
        while ready and self._has_left():
            inbox = ready.popleft()
            self._handle(inbox, inbox.pop(), now_ns)
            del self._waiting[inbox]
            if inbox.messages:
                self._waiting[inbox] = None  # behind the others, in the next turn too
                if inbox.meter.ready_ns <= now_ns:
                    ready.append(inbox)
        if ready:
            return 0
        return min((inbox.meter.ready_ns for inbox in self._waiting), default=None)

    def leave(self, inbox: Inbox, now_ns: int) -> None:
        """Handle what a client has sent before it went, but for what would be slowed down."""
        self._waiting.pop(inbox, None)
        while inbox.messages and inbox.meter.ready_ns <= now_ns:
            self._handle(inbox, inbox.pop(), now_ns)

    def _has_left(self) -> bool:
        return self._left_messages > 0 and self._left_bytes > 0

    def _handle(self, inbox: Inbox, message: bytes, now_ns: int) -> None:
        cost = inbox.apply(message, now_ns)
        self._left_messages -= 1
        self._left_bytes -= len(message) + cost
        if cost:
            inbox.meter.charge(cost, now_ns)
