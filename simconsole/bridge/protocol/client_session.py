"""One connected client as the router sees it: its subscriptions, its publishers, and what waits to be sent to it."""

import re
from collections.abc import Callable
from typing import Final, NamedTuple

from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.fragments import FragmentAssembler
from simconsole.bridge.protocol.message_encoding import Dialect
from simconsole.bridge.protocol.operations import DEFAULT_LEVEL, SEVERITY, Id, write_status
from simconsole.bridge.protocol.rate_limiter import RateLimiter
from simconsole.bridge.protocol.subscription_queue import SendBudget, SendQueue, SubscriptionQueue
from simconsole.values.errors import RemoteProtocolError
from simconsole.values.units import NS_PER_S

MAX_NAME: Final = 256
_NAME: Final = re.compile(r"/?[A-Za-z_][A-Za-z0-9_]*(?:/[A-Za-z_][A-Za-z0-9_]*)*")


class MessageCounts(NamedTuple):
    """Messages between the server and its clients."""

    received: int = 0
    refused: int = 0
    throttled: int = 0
    sent: int = 0
    dropped: int = 0

    def plus(self, other: "MessageCounts") -> "MessageCounts":
        """Return the sums."""
        return MessageCounts(*map(sum, zip(self, other, strict=True)))


class ClientSession:
    """State of one connection. It is created, changed and removed by its router alone, except for taking texts."""

    def __init__(
        self,
        number: int,
        peer: str,
        max_bytes: int,
        wake: Callable[[], None],
        dialect: Dialect = "ros2",
        assembler: FragmentAssembler | None = None,
        role: Role = Role.CONTROL,
        rate_limiter: RateLimiter | None = None,
        budget: SendBudget | None = None,
    ) -> None:
        """Start with nothing; `wake` is called whenever there may be something to send."""
        self.dialect: Dialect = dialect
        self.role = role
        self.assembler = assembler or FragmentAssembler(max_bytes, 256)
        self.rate_limiter = rate_limiter or RateLimiter(None)
        self.has_token = True
        """Whether it has shown a token, or none is asked for."""
        self.wrong_tokens = 0
        self.number = number
        self.peer = peer
        self.in_graph = False
        """Whether it stands for the nodes of a graph that the console has joined."""
        self.max_calls: int | None = None
        """How many calls it may have open; without, what the server's limits say of one client."""
        self.send_queue = SendQueue(max_bytes, budget, self._tell_dropped)
        self.next_text = self.send_queue.take
        """Returns the next text to send to the client, or None when nothing may be sent at a time in ns."""
        self.due_ns = self.send_queue.due_ns
        """Returns when `next_text` has something (0: now), None while nothing waits."""
        self.queues: dict[str, SubscriptionQueue] = {}
        self.advertised: dict[str, set[Id]] = {}
        self.received = 0
        self.refused = 0
        self.throttled = 0
        self._level = SEVERITY[DEFAULT_LEVEL]
        self._warned_ns: int | None = None
        self._wake = wake

    @property
    def sent(self) -> int:
        """How many texts were taken to be sent to the client."""
        return self.send_queue.taken

    def set_level(self, level: str) -> None:
        """Set how severe a status must be to be sent."""
        self._level = SEVERITY[level]

    def send_status(self, level: str, text: str, identifier: Id = None) -> None:
        """Send a status message if the client's level admits it."""
        if SEVERITY[level] <= self._level:
            self.send_queue.reply(write_status(level, text, identifier))
            self._wake()

    def throttle(self, text: str, now_ns: int) -> None:
        """Count a message dropped by the rate limit; tell the client at most once a second."""
        self.throttled += 1
        if self._warned_ns is None or now_ns - self._warned_ns >= NS_PER_S:
            self._warned_ns = now_ns
            self.send_status("error", text)

    def counts(self) -> MessageCounts:
        """Return what went to and from this client."""
        return MessageCounts(self.received, self.refused, self.throttled, self.sent, self.send_queue.dropped)

    def answer(self, text: bytes, fragment_size: int | None = None) -> None:
        """Send a text to this client alone."""
        self.send_queue.reply(text, fragment_size)
        self._wake()

    def deliver(self, queue: SubscriptionQueue, text: bytes, now_ns: int) -> None:
        """Queue a message of a subscribed topic."""
        self.send_queue.put(queue, text, now_ns)
        self._wake()

    def _tell_dropped(self, queue: SubscriptionQueue, now_ns: int) -> None:
        """Tell the client that messages of a topic are lost, at most once a second for each topic."""
        if queue.told_ns is None or now_ns - queue.told_ns >= NS_PER_S:
            queue.told_ns = now_ns
            self.send_status("error", f"{queue.topic}: too slow: {queue.dropped} messages dropped so far")


def resolve_topic(name: str) -> str:
    """Return the absolute name of a topic; a relative one is taken from the root, as rosbridge does.

    Raises:
        RemoteProtocolError: not a ROS topic name.
    """
    if len(name) > MAX_NAME or not _NAME.fullmatch(name):
        raise RemoteProtocolError(f"topic {name[:40]!r} is not a topic name of at most {MAX_NAME} characters")
    return name if name.startswith("/") else f"/{name}"
