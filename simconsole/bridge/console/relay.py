"""The console as a node of a ROS 2 graph, without the graph: what to offer it, and what passes between it and clients.

To the router the graph is a client like any other, with the same checks, roles and lease: one session for everything
that is not a command, and one for each node that commands, so that two nodes never drive at once. Messages cross in
CDR; what comes from the graph is read and checked as if it came from a rosbridge client.
"""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final, Literal, NamedTuple

import cbor2
import msgspec
import orjson

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.graph_view import (
    ANYONE,
    GraphEntities,
    GraphOperation,
    GraphPublisher,
    GraphView,
    Kind,
    full_type,
    why_unfit,
)
from simconsole.bridge.console.relay_calls import RelayCalls
from simconsole.bridge.messages import Definition
from simconsole.bridge.messages.cdr import deserialize
from simconsole.bridge.messages.rosidl_types import is_same_layout
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.protocol.rosapi_graph import NO_GRAPH, GraphNames, Unrelayed
from simconsole.bridge.protocol.topic_registry import Origin
from simconsole.values.errors import BridgeError
from simconsole.values.units import NS_PER_S

Describe = Callable[[str], tuple[Definition, ...] | None]
"""Returns the messages that a type of the graph is made of, None where it is not installed."""

OUTPUT_DEPTH: Final = 10
"""Messages of a topic of the console that ROS keeps for a slow node: rclpy's default."""

MAX_NODES: Final = 64
"""Nodes that are distinguished as commanders; further ones count as one."""
APPEARING_NS: Final = NS_PER_S
"""How long a call waits for a service that the graph may just be getting."""
MAX_CALLS: Final = 200
"""Calls and goals of the whole graph that may be with clients at a time; one client's limit is not meant for it."""


class _Unrelayed(NamedTuple):
    """Why something is not in the graph, how bad that is, and the clients that are to be told."""

    type: str
    why: str
    level: Literal["error", "warning"]
    clients: frozenset[int]


class Relay:
    """Between one console's router and one graph. All methods belong to the router's thread."""

    def __init__(self, console: ConsoleBridge, role: Role, describe: Describe, wake: Callable[[], None]) -> None:
        """Join with `role`; `wake` is called when `operations` has something."""
        self._console = console
        self._router = console.router
        self._registry = console.router.registry
        self._role = role
        self._describe = describe
        self._wake = wake
        self._main = self._router.connect("ros2", wake, role=role)
        self._main.set_level("warning")
        self._nodes: dict[str, ClientSession] = {}
        self._main.in_graph = True
        self._main.max_calls = MAX_CALLS
        self._router.calls.held.patience_ns = APPEARING_NS
        self._unusable: dict[str, str] = {}
        """Why a type cannot be relayed, empty where it can."""
        self._advertised: dict[Kind, dict[str, str]] = {"topic": {}, "service": {}, "action": {}}
        self._listening: set[str] = set()
        self._operations: list[GraphOperation] = []
        self._unrelayed: dict[tuple[Kind, str], _Unrelayed] = {}
        self._failed: dict[tuple[Kind, str], str] = {}
        """What the graph could not make."""
        self.calls = RelayCalls(self._router, self._main, self._advertised, self._order)

    def observe(self, view: GraphView, now_ns: int) -> GraphEntities:
        """Take in what the graph has now; return what the relay needs to have in it."""
        for node in [node for node in self._nodes if node not in view.nodes and node != ANYONE]:
            self._console.disconnect(self._nodes.pop(node), now_ns)
        for name, topic in self._router.topics.items():
            present = view.latching.get(name, frozenset())
            for origin in [origin for origin in topic.latched if origin and origin.publisher not in present]:
                del topic.latched[origin]  # its publisher has left, or nobody here subscribes any more
        before, self._unrelayed = self._unrelayed, {}
        if self._role >= Role.PUBLISH:
            self._advertise("topic", view.topics, now_ns)
            self._advertise("service", view.services, now_ns)
            self._advertise("action", view.actions, now_ns)
        entities = self._entities()
        self._report(before)
        unrelayed = {name: Unrelayed(found.type, found.why) for (_, name), found in self._unrelayed.items()}
        self._router.graph = GraphNames(view.details, unrelayed)
        heard = {name for name, offer in entities.publishers.items() if offer.latched or name in view.listened}
        for name in sorted(heard - self._listening):
            self._submit(now_ns, op="subscribe", topic=name, compression="cbor-raw")
        for name in sorted(self._listening - heard):
            self._submit(now_ns, op="unsubscribe", topic=name)
        self._listening = heard
        return entities

    def receive(self, name: str, type_name: str, data: bytes, node: str, latched_by: bytes | None, now_ns: int) -> None:
        """Take a message of the graph's `node`, of the type that was subscribed to; latched by a publisher or not."""
        topic = self._router.topic(name)
        if topic is None or topic.type != type_name:
            return
        session = self._main if topic.command is None else self._session_of(node)
        try:
            plain = deserialize(self._registry, topic.type, data)
        except BridgeError as error:
            self.remarked(node, f"{name}: {error}", now_ns)
            return
        self._drain(now_ns)
        origin = None if latched_by is None else Origin(self._main.number, latched_by)
        self._console.receive_plain(session, name, plain, now_ns, origin)
        echo = self._main.queues.get(name)
        if echo is not None:
            # What was drained before was for the graph; what waits now came from it and must not go back.
            self._main.send_queue.forget(echo)

    def lost(self, name: str, count: int, now_ns: int) -> None:
        """Take the news that so many messages of a topic came faster than they could be taken; tell who subscribes."""
        topic = self._router.topic(name)
        if topic is not None:
            for session, queue in topic.subscribers.values():
                session.send_queue.lose(queue, count, now_ns)

    def failed(self, kind: Kind, name: str, why: str, now_ns: int) -> None:
        """Take the news that the graph could not make an endpoint, or, with an empty `why`, that it now could."""
        self._failed[kind, name] = why
        if not why:
            del self._failed[kind, name]

    def remarked(self, node: str, text: str, now_ns: int) -> None:
        """Take a remark on a node or name, for the log."""
        self._order(GraphOperation("remark", node, text=text))

    def operations(self, now_ns: int) -> list[GraphOperation]:
        """Return what is to be done in the graph, in order, each once."""
        self._drain(now_ns)
        operations, self._operations = self._operations, []
        return operations

    def leave(self, now_ns: int) -> None:
        """Leave the router."""
        for session in (self._main, *self._nodes.values()):
            self._console.disconnect(session, now_ns)
        self._nodes.clear()
        self._router.graph = NO_GRAPH

    def _entities(self) -> GraphEntities:
        router, own = self._router, self._main.number
        publishers, subscriptions = {}, {}
        for name, topic in router.topics.items():
            others = (topic.publishers | topic.subscribers.keys()) - {own}
            if not (topic.owned or others):
                continue
            if not self._fits("topic", name, topic.type, () if topic.owned else others):
                continue
            if topic.command is not None:
                if self._role >= Role.CONTROL:
                    subscriptions[name] = topic.type
            elif topic.owned or topic.publishers - {own}:
                depth = OUTPUT_DEPTH if topic.owned else topic.depth
                publishers[name] = GraphPublisher(
                    type=topic.type,
                    latched=topic.latch,
                    depth=1 if topic.latch else depth,
                    best_effort=topic.is_best_effort,
                    deadline_ns=topic.deadline_ns,
                    lifespan_ns=topic.lifespan_ns,
                )
            if not topic.owned and topic.subscribers.keys() - {own} and self._role >= Role.PUBLISH:
                subscriptions[name] = topic.type
        calls = router.calls
        services = self._offered("service", calls.services(), calls.providers())
        actions = self._offered("action", calls.actions(), calls.action_providers())
        return GraphEntities(publishers, subscriptions, services, actions)

    def _offered(self, kind: Kind, types: Mapping[str, str], providers: Mapping[str, int]) -> dict[str, str]:
        offered = {}
        for name, number in providers.items():
            full = full_type(types[name], kind)
            if number != self._main.number and self._role >= Role.PUBLISH and self._fits(kind, name, full, {number}):
                offered[name] = full
        return offered

    def _fits(self, kind: Kind, name: str, type_name: str, clients: Iterable[int]) -> bool:
        """Return whether the graph can have this; note why not, and who is to be told."""
        wrong = why_unfit(kind, name, type_name) or self._failed.get((kind, name), "")
        unusable = "" if wrong else self._why_unusable(type_name)
        if wrong or unusable:
            level: Literal["error", "warning"] = "error" if wrong else "warning"
            self._unrelayed[kind, name] = _Unrelayed(type_name, wrong or unusable, level, frozenset(clients))
        return not unusable and (not wrong or (kind, name) in self._failed)

    def _report(self, before: Mapping[tuple[Kind, str], _Unrelayed]) -> None:
        """Say, once each, what is not in the graph: to the clients whose it is, and in the log."""
        sessions = {session.number: session for session in self._router.sessions}
        news = []
        for (kind, name), (_, why, level, clients) in self._unrelayed.items():
            known = before.get((kind, name))
            known = known if known is not None and known.why == why else None
            for number in sorted(clients - (known.clients if known else set())):
                sessions[number].send_status(level, f"{name} is not relayed to the ROS 2 graph: {why}")
            if known is None and not clients:
                news.append(f"{name}: {why}")
        if news:
            self._order(GraphOperation("remark", "ros2", text=f"not relayed: {'; '.join(news)}"))

    def _advertise(self, kind: Kind, seen: Mapping[str, str], now_ns: int) -> None:
        """Advertise to the clients what the graph has."""
        known = self._advertised[kind]
        op = "advertise" if kind == "topic" else f"advertise_{kind}"
        for name in [name for name in known if seen.get(name) != known[name]]:
            self._submit(now_ns, op=f"un{op}", **{kind: name})
            del known[name]
        for name, type_name in seen.items():
            if name in known or not self._is_free(kind, name, type_name):
                continue
            if self._fits(kind, name, type_name, ()) and self._submit(now_ns, op=op, type=type_name, **{kind: name}):
                known[name] = type_name

    def _is_free(self, kind: str, name: str, type_name: str) -> bool:
        """Return whether what the graph has is not the console's, and no client has it in its place."""
        if kind == "topic":
            topic = self._router.topic(name)
            return topic is None or (not topic.owned and topic.type == type_name)
        calls = self._router.calls
        return name not in (calls.services() if kind == "service" else calls.actions())

    def _why_unusable(self, type_name: str) -> str:
        """Return why a type cannot be relayed, empty where it is installed and the same; makes it known here."""
        if type_name not in self._unusable:
            self._unusable[type_name] = self._learn(type_name)
        return self._unusable[type_name]

    def _learn(self, type_name: str) -> str:
        found = self._describe(type_name)
        if found is None:
            return f"this ROS 2 has no type {type_name}"
        names = set(self._registry.names())
        for definition in found:
            if definition.name not in names:
                self._registry.add_definition(definition)
            elif not is_same_layout(definition, self._registry.definition(definition.name)):
                return f"{definition.name} has other fields in this ROS 2"
        return ""

    def _session_of(self, node: str) -> ClientSession:
        session = self._nodes.get(node)
        if session is None:
            if len(self._nodes) >= MAX_NODES:
                return self._main
            session = self._nodes[node] = self._router.connect(f"ros2:{node}", self._wake, role=self._role)
            session.set_level("warning")
            session.in_graph = True
        return session

    def _submit(self, now_ns: int, **operation: Any) -> bool:
        """Send an operation to the router as a client; return whether it was accepted."""
        return self._router.receive(self._main, msgspec.json.encode(operation), now_ns).kind == "done"

    def _drain(self, now_ns: int) -> None:
        for name, session in (("ros2", self._main), *self._nodes.items()):
            while (text := session.next_text(now_ns)) is not None:
                self._translate(name, text)

    def _translate(self, peer: str, text: bytes) -> None:
        """Turn what the router sends to one of the relay's sessions into a graph operation."""
        if isinstance(text, Binary):
            published = cbor2.loads(text)
            topic = self._router.topic(published["topic"])
            assert topic is not None, "it has a subscriber, the relay"
            self._order(GraphOperation("send", topic.name, type=topic.type, data=published["msg"]["bytes"]))
            return
        said = orjson.loads(text)
        if said["op"] == "status":
            self._order(GraphOperation("remark", peer, text=said["msg"]))
        else:
            self.calls.translate(said)

    def _order(self, operation: GraphOperation) -> None:
        self._operations.append(operation)
        self._wake()
