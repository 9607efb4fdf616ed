"""All topics of one server: type, owner, publishers, subscribers. A message is encoded once for all subscribers."""

from collections.abc import Callable
from typing import Any, Final, NamedTuple

from simconsole.bridge.messages import Registry
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.lease import CommandDesk
from simconsole.bridge.protocol.message_encoding import PLAIN_JSON, Encoder, Encoding
from simconsole.bridge.protocol.operations import NO_QOS, Advertise, Publish, Qos, Subscribe, publish_head
from simconsole.bridge.protocol.subscription_queue import SubscriptionQueue
from simconsole.profiles.bridge import BridgeLimits
from simconsole.values.errors import LocalProtocolError, RemoteProtocolError

RELAY_DEPTH: Final = 100
"""Messages kept of a topic between clients for a slow subscriber that gave no queue length."""

_UINT32: Final = 0xFFFFFFFF

Accept = Callable[[dict[str, Any] | None, Any, int], None]
"""Takes a command as decoded (None: every field was given), typed, and the time; raises RemoteProtocolError to refuse
it."""


class Command(NamedTuple):
    """A topic by which clients command the console."""

    accept: Accept
    desk: CommandDesk | None  # only the holder of its lease; None: open to everyone, such as an emergency stop


class Origin(NamedTuple):
    """One latching publisher of a graph: the relay's session, and who it is there."""

    session: int
    publisher: bytes


class Topic:
    """One topic: its type, publishers, subscribers, and whether the console owns it."""

    def __init__(
        self,
        name: str,
        type_name: str,
        depth: int,
        *,
        owned: bool = False,
        shared: bool = False,
        command: Command | None = None,
        latch: bool = False,
        stays: bool = False,
    ) -> None:
        """Create a topic.

        Args:
            name: on the server.
            type_name: of its messages.
            depth: messages kept for a slow subscriber that gave no queue length.
            owned: it belongs to the console and stays.
            shared: it is the console's, and clients publish on it, too.
            command: what clients command by it.
            latch: who comes later gets the newest message.
            stays: it stays without publishers and subscribers.
        """
        self.name = name
        self.type = type_name
        self.depth = depth
        self.owned = owned
        self.is_private = owned and not shared and command is None
        """Whether only the console may publish on it."""
        self.stays = owned or stays
        self.command = command
        self.latch = latch
        self.latched: dict[Origin | None, tuple[Encoder, int]] = {}
        """The message, and when it came in ns, that who comes later gets: the newest of the clients and the console,
        and of a graph the newest of each publisher."""
        self.lifespan_ns: int | None = None
        self.deadline_ns: int | None = None
        """Promised to the nodes of a graph."""
        self.is_best_effort = False
        """Whether the nodes of a graph may lose messages of it."""
        self.sequence = 0
        self.head = publish_head(name)
        self.publishers: set[int] = set()
        self.subscribers: dict[int, tuple[ClientSession, SubscriptionQueue]] = {}

    @property
    def is_wanted(self) -> bool:
        """Whether a message would reach anyone, now or by a latch."""
        return self.latch or bool(self.subscribers)

    def latched_messages(self, session: int, now_ns: int) -> list[Encoder]:
        """Return what a new subscriber gets: no message whose lifespan is over, nor a graph its own."""
        if self.lifespan_ns is not None:
            self.latched = {
                origin: (message, then_ns)
                for origin, (message, then_ns) in self.latched.items()
                if now_ns - then_ns <= self.lifespan_ns
            }
        return [message for origin, (message, _) in self.latched.items() if origin is None or origin.session != session]


class TopicRegistry:
    """The topics of one server by name, and the operations that change them."""

    def __init__(self, registry: Registry, limits: BridgeLimits) -> None:
        """Start without topics."""
        self.registry = registry
        self.ros_time_ns = 0
        self._limits = limits
        self._topics: dict[str, Topic] = {}

    def add(self, topic: Topic) -> None:
        """Add a topic of the console.

        Raises:
            LocalProtocolError: there is one of that name.
        """
        if topic.name in self._topics:
            raise LocalProtocolError(f"{topic.name}: two of the console's topics have this name")
        self._topics[topic.name] = topic

    def find(self, name: str) -> Topic | None:
        """Return a topic, None if there is none of that name."""
        return self._topics.get(name)

    def all(self) -> dict[str, Topic]:
        """Return every topic by name."""
        return dict(sorted(self._topics.items()))

    def distribute(self, topic: Topic, message: Any, now_ns: int, origin: Origin | None = None) -> None:
        """Send a typed message to all subscribers of a topic; one with an `origin` is kept for those who come later."""
        if not topic.subscribers and not topic.latch and origin is None:
            return
        topic.sequence = (topic.sequence + 1) & _UINT32
        encoder = Encoder(self.registry, topic.type, message, topic.sequence, self.ros_time_ns)
        if topic.latch or origin is not None:
            topic.latched[origin] = (encoder, now_ns)
        encoding, head, text = PLAIN_JSON, b"", b""
        for session, queue in topic.subscribers.values():
            if queue.head is not head or queue.encoding != encoding:  # else the same text as for the one before
                encoding, head = queue.encoding, queue.head
                text = encoder.text(encoding, head, queue.topic)
            session.deliver(queue, text, now_ns)

    def subscribe(self, session: ClientSession, name: str, operation: Subscribe, now_ns: int) -> None:
        """Add or change a subscription. Raises RemoteProtocolError with the reason why not."""
        encoding = Encoding(session.dialect, operation.compression)
        qos = operation.qos or NO_QOS
        queue = session.queues.get(name)
        if queue is None:
            if len(session.queues) >= self._limits.subscriptions:
                raise RemoteProtocolError(f"{self._limits.subscriptions} subscriptions are the most allowed")
            topic = self._topic(name, operation.type)
            # Messages carry the name that the client used, for it matches them by that.
            head = topic.head if operation.topic == name else publish_head(operation.topic)
            queue = session.queues[name] = SubscriptionQueue(head, topic.depth, operation.topic)
            topic.subscribers[session.number] = (session, queue)
            if qos.durability != "volatile":
                for latched in topic.latched_messages(session.number, now_ns):
                    session.deliver(queue, latched.text(encoding, head, operation.topic), now_ns)
        else:
            self._topic(name, operation.type)
        if operation.id not in queue.subscriptions and len(queue.subscriptions) >= self._limits.subscriptions:
            raise RemoteProtocolError(f"{self._limits.subscriptions} subscriptions are the most allowed")
        depth = operation.queue_length or self._depth(qos)
        queue.subscribe(
            operation.id,
            operation.throttle_rate,
            min(depth, self._limits.queue_length),
            encoding,
            operation.fragment_size,
        )

    def unsubscribe(self, session: ClientSession, name: str, identifier: Any) -> None:
        """End the subscription of an id, or all of a client's for None. Raises RemoteProtocolError: there is none."""
        queue = session.queues.get(name)
        if queue is None or not queue.unsubscribe(identifier):
            raise RemoteProtocolError("not subscribed")
        if not queue.subscriptions:
            session.send_queue.forget(queue)
            del session.queues[name]
            topic = self._topics[name]
            del topic.subscribers[session.number]
            self._remove_unused(topic)

    def advertise(self, session: ClientSession, name: str, operation: Advertise) -> Topic:
        """Register a client as a publisher; return the topic. Raises RemoteProtocolError with the reason why not."""
        topic = self._topic(name, operation.type)
        if topic.is_private:
            raise RemoteProtocolError("only the console publishes this topic")
        identifiers = session.advertised.get(name, set())
        if operation.id not in identifiers and len(identifiers) >= self._limits.topics:
            raise RemoteProtocolError(f"{self._limits.topics} ids for one topic are the most allowed")
        topic.publishers.add(session.number)
        self.apply_qos(topic, operation)
        session.advertised.setdefault(name, set()).add(operation.id)
        return topic

    def apply_qos(self, topic: Topic, operation: Advertise | Publish) -> None:
        """Apply a publisher's quality of service to its topic."""
        if topic.owned:
            return
        qos = operation.qos or NO_QOS
        topic.latch = topic.latch or operation.latch or qos.durability == "transient_local"
        topic.depth = min(self._depth(qos) or topic.depth, self._limits.queue_length)
        if qos.lifespan is not None:
            topic.lifespan_ns = qos.lifespan_ns
        if qos.deadline is not None:
            topic.deadline_ns = qos.deadline_ns
        if qos.reliability is not None:
            topic.is_best_effort = qos.reliability == "best_effort"

    def unadvertise(self, session: ClientSession, name: str, identifier: Any) -> None:
        """Withdraw a publisher, all of a client's for None. Raises RemoteProtocolError: there is none."""
        identifiers = session.advertised.get(name)
        if identifiers is None or (identifier is not None and identifier not in identifiers):
            raise RemoteProtocolError("not advertised")
        identifiers.discard(identifier)
        if identifier is None or not identifiers:
            del session.advertised[name]
            topic = self._topics[name]
            topic.publishers.discard(session.number)
            self._remove_unused(topic)

    def remove_client(self, session: ClientSession) -> None:
        """Remove everything of a client."""
        for name in (*session.queues, *session.advertised):
            topic = self._topics.get(name)
            if topic is not None:
                topic.subscribers.pop(session.number, None)
                topic.publishers.discard(session.number)
                self._remove_unused(topic)
        session.queues.clear()
        session.advertised.clear()

    def _topic(self, name: str, type_name: str | None) -> Topic:
        """Return the topic, created if a client names its type."""
        topic = self._topics.get(name)
        full = self.registry.resolve(type_name) if type_name else None
        if topic is None:
            if full is None:
                raise RemoteProtocolError("the topic is not known here: give its type")
            if len(self._topics) >= self._limits.topics:
                raise RemoteProtocolError(f"there are {self._limits.topics} topics already, the most allowed")
            topic = self._topics[name] = Topic(name, full, RELAY_DEPTH)
        elif full is not None and full != topic.type:
            raise RemoteProtocolError(f"the topic is {topic.type}, not {full}")
        return topic

    def _depth(self, qos: Qos) -> int:
        """Return the queue depth that a quality of service asks for, 0 without one."""
        return self._limits.queue_length if qos.history == "keep_all" else qos.depth or 0

    def _remove_unused(self, topic: Topic) -> None:
        """Remove a clients' topic that has neither publishers nor subscribers."""
        if not topic.stays and not topic.publishers and not topic.subscribers:
            self._topics.pop(topic.name, None)
