"""The server's side of rosbridge without a socket: texts of many clients in, texts for each of them out.

The router owns topics, subscriptions, latched messages and the commander's lease. Time comes in as an argument, and
nothing a client sends raises: it is answered with a status and counted.
"""

from collections.abc import Callable
from typing import Any, Final, Literal, NamedTuple

from simconsole.bridge.access import OPEN, Role
from simconsole.bridge.calls import Calls
from simconsole.bridge.documents import Document, has_duplicate_keys, read
from simconsole.bridge.forms import Dialect, Encoder, Form
from simconsole.bridge.fragments import Assembler
from simconsole.bridge.lease import Lease
from simconsole.bridge.messages import Registry, is_stamped
from simconsole.bridge.operations import (
    Advertise,
    Auth,
    CallOperation,
    CallService,
    Fragment,
    Operation,
    Publish,
    SetLevel,
    Status,
    Subscribe,
    Unadvertise,
    Unsubscribe,
    id_of,
    publish_head,
    read_operation,
)
from simconsole.bridge.outgoing import Outlet
from simconsole.bridge.session import Session, resolve_topic
from simconsole.errors import BridgeError, LocalProtocolError, RemoteProtocolError
from simconsole.profiles.bridge import BridgeLimits
from simconsole.units import NS_PER_S

RELAY_DEPTH: Final = 100
"""Messages kept of a topic between clients for a slow subscriber that did not say how many it wants."""

_UINT32: Final = 0xFFFFFFFF

Accept = Callable[[dict[str, Any], Any, int], None]
"""Takes a command as decoded, typed, and the time; raises RemoteProtocolError to refuse it."""


class Command(NamedTuple):
    """A topic by which clients command the console."""

    accept: Accept
    leased: bool  # only for the holder of the lease; a request such as an emergency stop is open to everyone


class Outcome(NamedTuple):
    """What became of one text, for the log of whoever owns the connection."""

    kind: Literal["done", "command", "refused", "remark"]
    topic: str
    text: str  # why refused, or what the client remarked


class Topic:
    """One topic: who listens, what it carries, and whose it is."""

    def __init__(
        self, name: str, type_name: str, depth: int, owned: bool, command: Command | None, latch: bool
    ) -> None:
        """Create a topic; `owned` topics belong to the console and stay."""
        self.name = name
        self.type = type_name
        self.depth = depth
        self.owned = owned
        self.command = command
        self.latch = latch
        self.latched: Encoder | None = None
        self.sequence = 0
        self.head = publish_head(name)
        self.publishers: set[int] = set()
        self.subscribers: dict[int, tuple[Session, Outlet]] = {}


class Router:
    """All clients of one server."""

    def __init__(
        self, registry: Registry, limits: BridgeLimits, lease_ns: int, on_refused: Callable[[], None] = lambda: None
    ) -> None:
        """Start without topics. `on_refused` is called for each refused command of whoever may command."""
        self.registry = registry
        self.lease = Lease(lease_ns)
        self.ros_time_ns = 0
        """What a message that comes without a stamp is stamped with."""
        self.on_new_commander: Callable[[], None] = lambda: None
        """Called when a command comes while nobody holds the lease, before it is checked."""
        self._limits = limits
        self._on_refused = on_refused
        self._topics: dict[str, Topic] = {}
        self._sessions: dict[int, Session] = {}
        self._numbers = 0
        self.calls = Calls(registry, limits)
        self.access = OPEN

    @property
    def sessions(self) -> tuple[Session, ...]:
        """The clients connected now."""
        return tuple(self._sessions.values())

    @property
    def topics(self) -> dict[str, Topic]:
        """Every topic by name."""
        return dict(sorted(self._topics.items()))

    def add_output(self, name: str, type_name: str, depth: int = 1, latch: bool = False) -> None:
        """Add a topic that only the console publishes, keeping the `depth` newest messages for a slow client."""
        self._add(Topic(name, self.registry.resolve(type_name), depth, True, None, latch))

    def add_command(self, name: str, type_name: str, accept: Accept, leased: bool = True) -> None:
        """Add a topic by which clients command the console."""
        self._add(Topic(name, self.registry.resolve(type_name), RELAY_DEPTH, True, Command(accept, leased), False))

    def _add(self, topic: Topic) -> None:
        if topic.name in self._topics:
            raise LocalProtocolError(f"{topic.name}: two of the console's topics have this name")
        self._topics[topic.name] = topic

    def connect(
        self,
        peer: str,
        wake: Callable[[], None] = lambda: None,
        dialect: Dialect = "ros2",
        role: Role | None = None,
    ) -> Session:
        """Take in a client; `peer` names it in logs, `wake` is called when something waits for it."""
        role = self.access.anonymous if role is None else role
        self._numbers += 1
        limits = self._limits
        assembler = Assembler(limits.message_bytes, limits.message_fragments)
        session = Session(self._numbers, peer, limits.queued_bytes, wake, dialect, assembler, role)
        self._sessions[session.number] = session
        return session

    def disconnect(self, session: Session, now_ns: int) -> bool:
        """Remove a client and everything of it; return whether it was commanding the console."""
        if self._sessions.pop(session.number, None) is None:
            return False
        for name in (*session.outlets, *session.advertised):
            topic = self._topics.get(name)
            if topic is not None:
                topic.subscribers.pop(session.number, None)
                topic.publishers.discard(session.number)
                self._clear(topic)
        session.outlets.clear()
        session.advertised.clear()
        self.calls.disconnect(session)
        return self.lease.release(session.number, now_ns)

    def wanted(self, name: str) -> bool:
        """Return whether publishing on an output would reach anyone, now or by a latch."""
        topic = self._topics[name]
        return bool(topic.subscribers) or topic.latch

    def publish(self, name: str, message: Any, now_ns: int) -> None:
        """Send a typed message of the console to all subscribers: encoded once, queued for each."""
        self._distribute(self._topics[name], message, now_ns)

    def receive(self, session: Session, text: bytes, now_ns: int) -> Outcome:
        """Apply one text of a client. Never raises for what is in it."""
        session.received += 1
        self.calls.expire(now_ns)
        return self._receive(session, text, now_ns, False)

    def _receive(self, session: Session, text: bytes, now_ns: int, assembled: bool) -> Outcome:
        document = Document({}, False)
        try:
            document = read(text)
            operation = read_operation(document.fields)
            if not isinstance(operation, Fragment):
                return self._apply(session, operation, document, text, now_ns)
            if assembled:
                raise RemoteProtocolError("a fragment of fragments")
            whole = session.assembler.add(operation, now_ns)
        except BridgeError as error:
            return self._refuse(session, document.fields, str(error), now_ns)
        return Outcome("done", "", "") if whole is None else self._receive(session, whole, now_ns, True)

    def refuse(self, session: Session, reason: str, now_ns: int) -> Outcome:
        """Answer something that was not even text, such as a binary message."""
        session.received += 1
        return self._refuse(session, {}, reason, now_ns)

    def _refuse(self, session: Session, fields: dict[str, Any], reason: str, now_ns: int) -> Outcome:
        session.refused += 1
        name = next((fields[key] for key in ("topic", "service", "action") if key in fields), "")
        name = name[:256] if isinstance(name, str) else ""
        topic = self._topics.get(name if name.startswith("/") else f"/{name}")
        # A stranger's mistakes must not count against the commander who drives.
        if session.role < Role.CONTROL:
            pass
        elif topic is not None and topic.command is not None and topic.command.leased:
            if self.lease.is_open_to(session.number, now_ns):
                self._on_refused()
        elif not fields and self.lease.holder(now_ns) == session.number:
            self._on_refused()
        op = fields.get("op")
        place = " ".join(part for part in (op if isinstance(op, str) else "", name) if part)
        session.remark("error", f"{place[:300]}: {reason}" if place else reason, id_of(fields))
        return Outcome("refused", name, reason)

    def _apply(self, session: Session, operation: Operation, document: Document, text: bytes, now_ns: int) -> Outcome:
        if isinstance(operation, Status):
            return Outcome("remark", "", f"{operation.level}: {operation.msg[:1000]}")
        if isinstance(operation, SetLevel):
            session.set_level(operation.level)
            return Outcome("done", "", "")
        if isinstance(operation, Auth):
            session.role = self.access.admit(operation)
            return Outcome("done", "", "")
        needed = Role.VIEW if isinstance(operation, Subscribe | Unsubscribe | CallService) else Role.PUBLISH
        self._require(session, needed)
        if isinstance(operation, CallOperation):
            return Outcome("done", self.calls.apply(session, operation, now_ns), "")
        assert not isinstance(operation, Fragment)
        name = resolve_topic(operation.topic)
        if isinstance(operation, Publish):
            return self._publish(session, name, operation, document, text, now_ns)
        if isinstance(operation, Subscribe):
            self._subscribe(session, name, operation, now_ns)
        elif isinstance(operation, Unsubscribe):
            self._unsubscribe(session, name, operation)
        elif isinstance(operation, Advertise):
            self._advertise(session, name, operation)
        else:
            self._unadvertise(session, name, operation)
        return Outcome("done", name, "")

    def _require(self, session: Session, role: Role) -> None:
        if session.role < role:
            held = f"role {session.role.name.lower()}" if session.role else "no token"
            raise RemoteProtocolError(f"this needs the role {role.name.lower()}; you have {held}")

    def _publish(
        self, session: Session, name: str, operation: Publish, document: Document, text: bytes, now_ns: int
    ) -> Outcome:
        topic = self._topics.get(name)
        if topic is None:
            raise RemoteProtocolError("advertise the topic first: nobody has said its type")
        if not isinstance(operation.msg, dict):
            raise RemoteProtocolError("msg must be an object")
        if topic.command is not None:
            return self._command(session, topic, topic.command, operation, document, text, now_ns)
        if topic.owned:
            raise RemoteProtocolError("only the console publishes this topic")
        message = self.registry.from_plain(topic.type, operation.msg, now_ns=self.ros_time_ns)
        self._stamp(topic.type, operation.msg, message)
        topic.latch = topic.latch or operation.latch
        self._distribute(topic, message, now_ns)
        return Outcome("done", name, "")

    def _command(
        self,
        session: Session,
        topic: Topic,
        command: Command,
        operation: Publish,
        document: Document,
        text: bytes,
        now_ns: int,
    ) -> Outcome:
        self._require(session, Role.CONTROL)
        if document.literals:
            raise RemoteProtocolError("NaN and Infinity are not JSON and no command")
        if has_duplicate_keys(text, document.fields):
            raise RemoteProtocolError("a key is given twice")
        if command.leased and not self.lease.is_open_to(session.number, now_ns):
            raise RemoteProtocolError("another client commands the console")
        message = self.registry.from_plain(topic.type, operation.msg, gaps=False, now_ns=self.ros_time_ns)
        if command.leased and self.lease.holder(now_ns) is None:
            self.on_new_commander()
        command.accept(operation.msg, message, now_ns)
        if command.leased:
            self.lease.renew(session.number, now_ns)
        self._distribute(topic, message, now_ns)
        return Outcome("command", topic.name, "")

    def _stamp(self, type_name: str, plain: dict[str, Any], message: Any) -> None:
        """Give a message that came without a stamp the present, as the protocol promises."""
        if is_stamped(self.registry.definition(type_name)):
            header = plain.get("header")
            if not isinstance(header, dict) or "stamp" not in header:
                message.header.stamp.sec, message.header.stamp.nanosec = divmod(self.ros_time_ns, NS_PER_S)

    def _distribute(self, topic: Topic, message: Any, now_ns: int) -> None:
        if not topic.subscribers and not topic.latch:
            return
        topic.sequence = (topic.sequence + 1) & _UINT32
        encoder = Encoder(self.registry, topic.type, message, topic.sequence, self.ros_time_ns)
        if topic.latch:
            topic.latched = encoder
        for session, outlet in topic.subscribers.values():
            session.deliver(outlet, encoder.text(outlet.form, outlet.head, outlet.topic), now_ns)

    def _topic(self, name: str, type_name: str | None) -> Topic:
        """Return the topic, created if a client names its type."""
        topic = self._topics.get(name)
        full = self.registry.resolve(type_name) if type_name else None
        if topic is None:
            if full is None:
                raise RemoteProtocolError("the topic is not known here: give its type")
            if len(self._topics) >= self._limits.topics:
                raise RemoteProtocolError(f"there are {self._limits.topics} topics already, the most allowed")
            topic = self._topics[name] = Topic(name, full, RELAY_DEPTH, False, None, False)
        elif full is not None and full != topic.type:
            raise RemoteProtocolError(f"the topic is {topic.type}, not {full}")
        return topic

    def _subscribe(self, session: Session, name: str, operation: Subscribe, now_ns: int) -> None:
        form = Form(session.dialect, operation.compression)
        outlet = session.outlets.get(name)
        if outlet is None:
            if len(session.outlets) >= self._limits.subscriptions:
                raise RemoteProtocolError(f"{self._limits.subscriptions} subscriptions are the most allowed")
            topic = self._topic(name, operation.type)
            # The client is answered with the name it used, which is what it looks up.
            head = topic.head if operation.topic == name else publish_head(operation.topic)
            outlet = session.outlets[name] = Outlet(head, topic.depth, operation.topic)
            topic.subscribers[session.number] = (session, outlet)
            if topic.latched is not None:
                session.deliver(outlet, topic.latched.text(form, head, operation.topic), now_ns)
        else:
            self._topic(name, operation.type)
        if operation.id not in outlet.wishes and len(outlet.wishes) >= self._limits.subscriptions:
            raise RemoteProtocolError(f"{self._limits.subscriptions} subscriptions are the most allowed")
        depth = min(operation.queue_length, self._limits.queue_length)
        outlet.wish(operation.id, operation.throttle_rate, depth, form, operation.fragment_size)

    def _unsubscribe(self, session: Session, name: str, operation: Unsubscribe) -> None:
        outlet = session.outlets.get(name)
        if outlet is None or not outlet.withdraw(operation.id):
            raise RemoteProtocolError("not subscribed")
        if not outlet.wishes:
            session.outgoing.forget(outlet)
            del session.outlets[name]
            topic = self._topics[name]
            del topic.subscribers[session.number]
            self._clear(topic)

    def _advertise(self, session: Session, name: str, operation: Advertise) -> None:
        topic = self._topic(name, operation.type)
        if topic.owned and topic.command is None:
            raise RemoteProtocolError("only the console publishes this topic")
        topic.publishers.add(session.number)
        topic.latch = topic.latch or (operation.latch and not topic.owned)
        identifiers = session.advertised.setdefault(name, set())
        if len(identifiers) < self._limits.topics:
            identifiers.add(operation.id)

    def _unadvertise(self, session: Session, name: str, operation: Unadvertise) -> None:
        identifiers = session.advertised.get(name)
        if identifiers is None or (operation.id is not None and operation.id not in identifiers):
            raise RemoteProtocolError("not advertised")
        identifiers.discard(operation.id)
        if operation.id is None or not identifiers:
            del session.advertised[name]
            topic = self._topics[name]
            topic.publishers.discard(session.number)
            self._clear(topic)

    def _clear(self, topic: Topic) -> None:
        """Forget a topic of clients that nobody publishes or hears any more."""
        if not topic.owned and not topic.publishers and not topic.subscribers:
            self._topics.pop(topic.name, None)
