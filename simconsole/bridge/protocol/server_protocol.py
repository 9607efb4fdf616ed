"""The server's side of rosbridge without a socket: texts of many clients in, texts for each of them out.

The router owns topics, subscriptions, latched messages and the commander's lease. Time comes in as an argument, and
nothing a client sends raises: it is answered with a status and counted.
"""

from collections.abc import Callable
from typing import Any, Final, Literal, NamedTuple

import msgspec

from simconsole.bridge.messages import Registry, is_stamped
from simconsole.bridge.protocol.access import OPEN, Role, message_limit
from simconsole.bridge.protocol.calls import Calls
from simconsole.bridge.protocol.client_session import ClientSession, MessageCounts, resolve_topic
from simconsole.bridge.protocol.fragments import FragmentAssembler
from simconsole.bridge.protocol.lease import CommandDesk
from simconsole.bridge.protocol.message_decoding import (
    Binary,
    DecodedMessage,
    all_finite,
    decode,
    has_duplicate_keys,
    read_complete,
)
from simconsole.bridge.protocol.message_encoding import Dialect
from simconsole.bridge.protocol.operations import (
    Advertise,
    Auth,
    CallOperation,
    CallService,
    Fragment,
    Operation,
    Publish,
    SendActionGoal,
    SetLevel,
    Status,
    Subscribe,
    Unsubscribe,
    id_of,
    read_operation,
    read_published,
)
from simconsole.bridge.protocol.rate_limiter import RateLimiter
from simconsole.bridge.protocol.rosapi_graph import NO_GRAPH
from simconsole.bridge.protocol.subscription_queue import SendBudget
from simconsole.bridge.protocol.topic_registry import RELAY_DEPTH, Accept, Command, Origin, Topic, TopicRegistry
from simconsole.profiles.bridge import BridgeLimits
from simconsole.values.errors import BridgeError, RemoteProtocolError
from simconsole.values.units import NS_PER_S

WRONG_TOKENS: Final = 5
"""As many may one connection try."""


class Outcome(NamedTuple):
    """What became of one received text, for the connection's log."""

    kind: Literal["done", "command", "refused", "remark", "throttled"]
    topic: str
    text: str  # why refused, or what the client remarked


class _CommandReader(NamedTuple):
    """A topic of commands, and what reads its messages."""

    topic: Topic
    command: Command
    reader: msgspec.json.Decoder[Any]


class Router:
    """All clients of one server."""

    def __init__(
        self, registry: Registry, limits: BridgeLimits, lease_ns: int, on_refused: Callable[[], None] = lambda: None
    ) -> None:
        """Start without topics. `on_refused` is called for each refused command of a client that may command."""
        self.registry = registry
        self.topic_registry = TopicRegistry(registry, limits)
        self.desk = CommandDesk(lease_ns, on_refused)
        self.desks = [self.desk]
        self._limits = limits
        self._commands: dict[bytes, _CommandReader] = {}
        self._sessions: dict[int, ClientSession] = {}
        self._numbers = 0
        self._past_counts = MessageCounts()
        self._budget = SendBudget(limits.all_queued_bytes)
        self.upstream: Literal["", "connecting", "connected", "lost"] = ""
        """State of the connection to the server that the console is a client of: empty without one; lost while it
        reconnects."""
        self.calls = Calls(registry, limits)
        self.access = OPEN
        self.graph = NO_GRAPH
        """What is known of a graph that the console has joined."""

    @property
    def sessions(self) -> tuple[ClientSession, ...]:
        """The clients connected now."""
        return tuple(self._sessions.values())

    @property
    def ros_time_ns(self) -> int:
        """ROS time in ns: the stamp of a message that comes without one."""
        return self.topic_registry.ros_time_ns

    @ros_time_ns.setter
    def ros_time_ns(self, now_ns: int) -> None:
        self.topic_registry.ros_time_ns = now_ns

    @property
    def topics(self) -> dict[str, Topic]:
        """Every topic by name."""
        return self.topic_registry.all()

    @property
    def connections(self) -> int:
        """How many clients there have been."""
        return self._numbers

    def counts(self) -> MessageCounts:
        """Return the counts of all clients together, also of those that are gone."""
        counts = self._past_counts
        for session in self._sessions.values():
            counts = counts.plus(session.counts())
        return counts

    def topic(self, name: str) -> Topic | None:
        """Return a topic, None if there is none of that name."""
        return self.topic_registry.find(name)

    def add_output(self, name: str, type_name: str, *, latch: bool = False, shared: bool = False) -> Topic:
        """Add and return a topic of the console, of which a slow client gets the newest message.

        One that is `shared` clients publish on, too: it is kept like a topic between clients.
        """
        depth = RELAY_DEPTH if shared else 1
        topic = Topic(name, self.registry.resolve(type_name), depth, owned=True, shared=shared, latch=latch)
        self.topic_registry.add(topic)
        return topic

    def add_shared(self, name: str, type_name: str) -> None:
        """Add a topic that the console publishes as its clients may, and that stays without any of them."""
        self.topic_registry.add(Topic(name, self.registry.resolve(type_name), RELAY_DEPTH, stays=True))

    def add_command(
        self, name: str, type_name: str, accept: Accept, leased: bool = True, desk: CommandDesk | None = None
    ) -> None:
        """Add a topic by which clients command the platform of `desk`, the first one without."""
        topic_type, command = self.registry.resolve(type_name), Command(accept, desk or self.desk if leased else None)
        topic = Topic(name, topic_type, RELAY_DEPTH, owned=True, command=command)
        self.topic_registry.add(topic)
        reader = msgspec.json.Decoder(self.registry.struct(topic_type))
        self._commands[name.encode()] = _CommandReader(topic, command, reader)

    def connect(
        self,
        peer: str,
        wake: Callable[[], None] = lambda: None,
        dialect: Dialect = "ros2",
        role: Role | None = None,
    ) -> ClientSession:
        """Add a client; `peer` names it in logs, `wake` is called when there is something to send to it."""
        role = self.access.anonymous if role is None else role
        self._numbers += 1
        limits = self._limits
        session = ClientSession(
            self._numbers,
            peer,
            limits.queued_bytes,
            wake,
            dialect=dialect,
            assembler=FragmentAssembler(message_limit(role, limits), limits.message_fragments),
            role=role,
            rate_limiter=RateLimiter(limits.commands_hz),
            budget=self._budget,
        )
        self._sessions[session.number] = session
        return session

    def disconnect(self, session: ClientSession, now_ns: int) -> bool:
        """Remove a client and everything of it; return whether it was commanding a platform."""
        if self._sessions.pop(session.number, None) is None:
            return False
        self._past_counts = self._past_counts.plus(session.counts())
        self.topic_registry.remove_client(session)
        self.calls.disconnect(session)
        session.send_queue.close()
        for desk in (left := [desk for desk in self.desks if desk.lease.release(session.number, now_ns)]):
            desk.on_lost()
        return bool(left)

    def has_subscribers(self, name: str) -> bool:
        """Return whether publishing on an output would reach anyone, now or by a latch."""
        topic = self.topic_registry.find(name)
        return topic is not None and topic.is_wanted

    def publish(self, name: str, message: Any, now_ns: int) -> None:
        """Send a typed message of the console to all subscribers: encoded once, queued for each."""
        topic = self.topic_registry.find(name)
        assert topic is not None
        self.topic_registry.distribute(topic, message, now_ns)

    def receive(self, session: ClientSession, text: bytes, now_ns: int) -> Outcome:
        """Apply one message of a client, text or `Binary`. Never raises for what is in it."""
        session.received += 1
        self.calls.expire(now_ns)
        return self._receive(session, text, now_ns, False)

    def _receive(self, session: ClientSession, text: bytes, now_ns: int, assembled: bool) -> Outcome:
        fields: dict[str, Any] = {}
        try:
            if not isinstance(text, Binary) and (published := read_published(text)) is not None:
                known = self._commands.get(published[0])
                if known is not None and (message := read_complete(published[1], known.reader)) is not None:
                    fields = {"op": "publish", "topic": known.topic.name}
                    return self._command(session, known.topic, known.command, lambda: (None, message), now_ns)
            decoded = decode(text)
            fields = decoded.fields
            operation = read_operation(fields)
            if isinstance(operation, Publish):  # first: by far the most are
                return self._publish(session, operation, decoded, text, now_ns)
            if not isinstance(operation, Fragment):
                return self._apply(session, operation, fields, now_ns)
            if assembled:
                raise RemoteProtocolError("a fragment of fragments")
            whole = session.assembler.add(operation, now_ns)
        except BridgeError as error:
            return self._refuse(session, fields, str(error), now_ns)
        return Outcome("done", "", "") if whole is None else self._receive(session, whole, now_ns, True)

    def receive_plain(
        self, session: ClientSession, name: str, plain: dict[str, Any], now_ns: int, origin: Origin | None = None
    ) -> Outcome:
        """Apply a message that did not come as text: checked like any other. Never raises for what is in it."""
        session.received += 1
        self.calls.expire(now_ns)
        fields = {"op": "publish", "topic": name, "msg": plain}
        try:
            return self._publish(session, Publish(name, plain), DecodedMessage(fields, False), b"", now_ns, origin)
        except BridgeError as error:
            return self._refuse(session, fields, str(error), now_ns)

    def _refuse(self, session: ClientSession, fields: dict[str, Any], reason: str, now_ns: int) -> Outcome:
        session.refused += 1
        name = next((fields[key] for key in ("topic", "service", "action") if key in fields), "")
        name = name[:256] if isinstance(name, str) else ""
        topic = self.topic_registry.find(name if name.startswith("/") else f"/{name}")
        # Mistakes of other clients must not count against the commander.
        if session.role < Role.CONTROL:
            pass
        elif topic is not None and topic.command is not None and topic.command.desk is not None:
            if topic.command.desk.lease.is_open_to(session.number, now_ns):
                topic.command.desk.on_refused()
        elif not fields:
            for desk in (desk for desk in self.desks if desk.lease.holder(now_ns) == session.number):
                desk.on_refused()
        op = fields.get("op")
        place = " ".join(part for part in (op if isinstance(op, str) else "", name) if part)
        session.send_status("error", f"{place[:300]}: {reason}" if place else reason, id_of(fields))
        return Outcome("refused", name, reason)

    def tell_commander(self, desk: CommandDesk, level: str, text: str, now_ns: int) -> None:
        """Send a status message to the client that holds the lease of a desk, if one does."""
        session = self._sessions.get(desk.lease.holder(now_ns) or 0)
        if session is not None:
            session.send_status(level, text)

    def _apply(self, session: ClientSession, operation: Operation, fields: dict[str, Any], now_ns: int) -> Outcome:
        if isinstance(operation, Status):
            return Outcome("remark", "", f"{operation.level}: {operation.msg[:1000]}")
        if isinstance(operation, SetLevel):
            session.set_level(operation.level)
            return Outcome("done", "", "")
        if isinstance(operation, Auth):
            self._admit(session, operation)
            session.assembler.max_bytes = message_limit(session.role, self._limits)
            return Outcome("done", "", "")
        needed = Role.VIEW if isinstance(operation, Subscribe | Unsubscribe | CallService) else Role.PUBLISH
        try:
            self._require(session, needed)
        except RemoteProtocolError as error:
            outcome = self._refuse(session, fields, str(error), now_ns)
            if isinstance(operation, CallService | SendActionGoal):
                self.calls.reject(session, operation, str(error))
            return outcome
        if isinstance(operation, CallOperation):
            return Outcome("done", self.calls.apply(session, operation, now_ns), "")
        assert not isinstance(operation, Fragment | Publish)
        name = resolve_topic(operation.topic)
        if isinstance(operation, Subscribe):
            self.topic_registry.subscribe(session, name, operation, now_ns)
        elif isinstance(operation, Unsubscribe):
            self.topic_registry.unsubscribe(session, name, operation.id)
        elif isinstance(operation, Advertise):
            self.topic_registry.advertise(session, name, operation)
        else:
            self.topic_registry.unadvertise(session, name, operation.id)
        return Outcome("done", name, "")

    def _admit(self, session: ClientSession, operation: Auth) -> None:
        if session.wrong_tokens >= WRONG_TOKENS:
            raise RemoteProtocolError("too many wrong tokens: connect anew")
        try:
            session.role = self.access.admit(operation)
        except RemoteProtocolError:
            session.wrong_tokens += 1
            raise
        session.has_token = True

    def _require(self, session: ClientSession, role: Role) -> None:
        if session.role < role:
            held = f"role {session.role.name.lower()}" if session.role else "no token"
            raise RemoteProtocolError(f"this needs the role {role.name.lower()}; you have {held}")

    def _publish(
        self,
        session: ClientSession,
        operation: Publish,
        decoded: DecodedMessage,
        text: bytes,
        now_ns: int,
        origin: Origin | None = None,
    ) -> Outcome:
        self._require(session, Role.PUBLISH)
        # A name that is registered as given needs no resolving.
        topic = self.topic_registry.find(operation.topic) or self.topic_registry.find(resolve_topic(operation.topic))
        if operation.type is not None and topic is not None and self.registry.resolve(operation.type) != topic.type:
            raise RemoteProtocolError(f"the topic is {topic.type}, not {self.registry.resolve(operation.type)}")
        if topic is None or not (topic.owned or session.in_graph or session.number in topic.publishers):
            topic = self._advertise_by_publishing(session, topic, operation)
        if not isinstance(operation.msg, dict):
            raise RemoteProtocolError("msg must be an object")
        if topic.command is not None:
            command, plain = topic.command, operation.msg
            return self._command(
                session, topic, command, lambda: (plain, self._read_command(topic, plain, decoded, text)), now_ns
            )
        if topic.is_private:
            raise RemoteProtocolError("only the console publishes this topic")
        message = self.registry.from_plain(topic.type, operation.msg, now_ns=self.ros_time_ns)
        self._stamp(topic.type, operation.msg, message)
        if operation.latch or operation.qos is not None:
            self.topic_registry.apply_qos(topic, operation)
        self.topic_registry.distribute(topic, message, now_ns, origin)
        return Outcome("done", topic.name, "")

    def _advertise_by_publishing(self, session: ClientSession, topic: Topic | None, operation: Publish) -> Topic:
        """Return the topic of a message whose sender has not advertised it and does so by this: nodes get it too."""
        type_name = operation.type if topic is None else topic.type
        if type_name is None:
            raise RemoteProtocolError("advertise the topic first: nobody has said its type")
        name = resolve_topic(operation.topic)
        return self.topic_registry.advertise(session, name, Advertise(operation.topic, type_name))

    def _command(
        self,
        session: ClientSession,
        topic: Topic,
        command: Command,
        read: Callable[[], tuple[dict[str, Any] | None, Any]],
        now_ns: int,
    ) -> Outcome:
        """Follow a command; `read` returns it as `Accept` takes it, and is called once it may be followed."""
        self._require(session, Role.CONTROL)
        desk = command.desk
        if desk is not None and not session.rate_limiter.allows(now_ns):
            return self._throttle(session, topic.name, now_ns)
        if desk is not None and not desk.lease.is_open_to(session.number, now_ns):
            raise RemoteProtocolError("another client commands the console")
        plain, message = read()
        if desk is not None and desk.lease.holder(now_ns) is None:
            desk.on_new_commander()
        command.accept(plain, message, now_ns)
        if desk is not None:
            desk.lease.renew(session.number, now_ns)
        self.topic_registry.distribute(topic, message, now_ns)
        return Outcome("command", topic.name, "")

    def _read_command(self, topic: Topic, plain: Any, decoded: DecodedMessage, text: bytes) -> Any:
        """Return the typed message of a command that came in any form."""
        if decoded.literals or (isinstance(text, Binary) and not all_finite(plain)):
            raise RemoteProtocolError("NaN and Infinity are not JSON and no command")
        if text and has_duplicate_keys(text, decoded.fields):
            raise RemoteProtocolError("a key is given twice")
        return self.registry.from_plain(topic.type, plain, gaps=False, now_ns=self.ros_time_ns)

    def _throttle(self, session: ClientSession, name: str, now_ns: int) -> Outcome:
        """Drop a command above the rate limit: a newer one is on its way, and it counts as no refusal."""
        reason = f"more than {self._limits.commands_hz:g} commands a second: only so many are taken"
        session.throttle(f"{name}: {reason}", now_ns)
        return Outcome("throttled", name, reason)

    def _stamp(self, type_name: str, plain: dict[str, Any], message: Any) -> None:
        """Stamp a message that came without a stamp with the present time, as the protocol requires."""
        header = plain.get("header")
        if isinstance(header, dict) and "stamp" in header:
            return
        if is_stamped(self.registry.definition(type_name)):
            message.header.stamp.sec, message.header.stamp.nanosec = divmod(self.ros_time_ns, NS_PER_S)
