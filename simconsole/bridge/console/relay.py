"""The console as a node of a ROS 2 graph, without the graph: what to offer it, and what passes between it and clients.

To the router the graph is a client like any other, with the same checks, roles and lease: one session for everything
that is not a command, and one for each node that commands, so that two nodes never drive at once. Messages cross in
CDR; what comes from the graph is read and checked as if it came from a rosbridge client.
"""

from collections.abc import Callable, Mapping
from typing import Any, Final, Literal, NamedTuple

import cbor2
import msgspec
import orjson

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.messages import Definition
from simconsole.bridge.messages.cdr import deserialize, serialize
from simconsole.bridge.messages.rosidl_types import is_same_layout
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.protocol.operations import ABORTED, SUCCEEDED
from simconsole.values.errors import BridgeError

Describe = Callable[[str], tuple[Definition, ...] | None]
"""Returns the messages that a type of the graph is made of, None where it is not installed."""

ANYONE: Final = "graph"
"""The publishing node where ROS does not name it: all unnamed publishers count as one node."""

OUTPUT_DEPTH: Final = 10
"""Messages of a topic of the console that ROS keeps for a slow node: rclpy's default."""

MAX_NODES: Final = 64
"""Nodes that are distinguished as commanders; further ones count as one."""
_UNASKED: Final = frozenset({"rcl_interfaces", "type_description_interfaces"})
"""Packages of services that every node has; six for each would fill the table."""


class GraphView(NamedTuple):
    """What others have in the graph: topics, services, actions with their types, topics listened to, nodes."""

    topics: Mapping[str, str]
    listened: frozenset[str]
    services: Mapping[str, str]
    actions: Mapping[str, str]
    nodes: frozenset[str]


class GraphPublisher(NamedTuple):
    """One topic that the relay publishes in the graph."""

    type: str
    latched: bool
    depth: int
    best_effort: bool = False
    deadline_ns: int | None = None
    lifespan_ns: int | None = None


class GraphEntities(NamedTuple):
    """What the relay needs to have in the graph, by name: publishers, and types of topics, services and actions."""

    publishers: dict[str, GraphPublisher]
    subscriptions: dict[str, str]
    services: dict[str, str]
    actions: dict[str, str]


class GraphOperation(NamedTuple):
    """One thing to do in the graph; `data` is CDR, None where something failed and `text` says why.

    send a message; call a service or pursue a goal of the graph; cancel such a goal; reply to a call of the graph;
    tell feedback and the end of a goal of the graph; remark something about a node.
    """

    kind: Literal["send", "call", "goal", "cancel", "reply", "feedback", "end", "remark"]
    name: str
    key: str = ""
    type: str = ""
    data: bytes | None = None
    text: str = ""
    status: int = 0


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
        self._usable: dict[str, bool] = {}
        self._missing: list[str] = []
        self._advertised: dict[str, dict[str, str]] = {"topic": {}, "service": {}, "action": {}}
        self._listening: set[str] = set()
        self._asked: dict[str, str] = {}
        """Services and actions by key that the graph waits for, with their types."""
        self._operations: list[GraphOperation] = []

    def observe(self, view: GraphView, now_ns: int) -> GraphEntities:
        """Take in what the graph has now; return what the relay needs to have in it."""
        for node in [node for node in self._nodes if node not in view.nodes and node != ANYONE]:
            self._console.disconnect(self._nodes.pop(node), now_ns)
        if self._role >= Role.PUBLISH:
            self._advertise("topic", view.topics, now_ns)
            self._advertise("service", view.services, now_ns)
            self._advertise("action", view.actions, now_ns)
        entities = self._entities()
        if self._missing:
            text = f"not relayed, because this ROS 2 has no such type: {', '.join(self._missing)}"
            self._operations.append(GraphOperation("remark", "ros2", text=text))
            self._missing.clear()
        heard = {name for name, offer in entities.publishers.items() if offer.latched or name in view.listened}
        for name in sorted(heard - self._listening):
            self._submit(now_ns, op="subscribe", topic=name, compression="cbor-raw")
        for name in sorted(self._listening - heard):
            self._submit(now_ns, op="unsubscribe", topic=name)
        self._listening = heard
        return entities

    def receive(self, name: str, data: bytes, node: str, now_ns: int) -> None:
        """Take a message of the graph's `node`."""
        topic = self._router.topic(name)
        if topic is None:
            return
        session = self._main if topic.command is None else self._session_of(node)
        try:
            plain = deserialize(self._registry, topic.type, data)
        except BridgeError as error:
            self._operations.append(GraphOperation("remark", node, text=f"{name}: {error}"))
            return
        self._drain(now_ns)
        self._console.receive_plain(session, name, plain, now_ns)
        echo = self._main.queues.get(name)
        if echo is not None:
            # What was drained before was for the graph; what waits now came from it and must not go back.
            self._main.send_queue.forget(echo)

    def call_service(self, key: str, service: str, data: bytes, now_ns: int) -> None:
        """Take a call by the graph of a client's service; a `reply` operation with this key will follow."""
        self._pass_on(key, service, "Request", data, now_ns, op="call_service", service=service)

    def send_goal(self, key: str, action: str, data: bytes, now_ns: int) -> None:
        """Take a goal of the graph for a client's action; an `end` operation with this key will follow."""
        self._pass_on(key, action, "Goal", data, now_ns, op="send_action_goal", action=action, feedback=True)

    def cancel(self, key: str, action: str, now_ns: int) -> None:
        """Take the graph's request to cancel a goal."""
        self._submit(now_ns, op="cancel_action_goal", action=action, id=key)

    def service_responded(self, key: str, service: str, data: bytes | None, why: str, now_ns: int) -> None:
        """Take the graph's answer to a `call`, None for a failure."""
        values = self._values("service", service, "Response", data)
        self._submit(
            now_ns, op="service_response", service=service, id=key, result=values is not None,
            values=why if values is None else values,
        )  # fmt: skip

    def feedback_received(self, key: str, action: str, data: bytes, now_ns: int) -> None:
        """Take feedback on a `goal`."""
        values = self._values("action", action, "Feedback", data)
        self._submit(now_ns, op="action_feedback", action=action, id=key, values=values)

    def goal_ended(self, key: str, action: str, data: bytes | None, status: int, why: str, now_ns: int) -> None:
        """Take the end of a `goal`, None for a failure."""
        values = self._values("action", action, "Result", data)
        self._submit(
            now_ns, op="action_result", action=action, id=key, status=status, result=status == SUCCEEDED,
            values=why if values is None else values,
        )  # fmt: skip

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

    def _entities(self) -> GraphEntities:
        router, own = self._router, self._main.number
        publishers, subscriptions = {}, {}
        for name, topic in router.topics.items():
            if not self._is_usable(topic.type):
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
        services = self._offered("srv", calls.services(), calls.providers())
        actions = self._offered("action", calls.actions(), calls.action_providers())
        return GraphEntities(publishers, subscriptions, services, actions)

    def _offered(self, kind: str, types: Mapping[str, str], providers: Mapping[str, int]) -> dict[str, str]:
        offered = {}
        for name, number in providers.items():
            full = _three_parts(types[name], kind)
            if number != self._main.number and self._role >= Role.PUBLISH and self._is_usable(full):
                offered[name] = full
        return offered

    def _advertise(self, kind: Literal["topic", "service", "action"], seen: Mapping[str, str], now_ns: int) -> None:
        """Advertise to the clients what the graph has."""
        known = self._advertised[kind]
        op = "advertise" if kind == "topic" else f"advertise_{kind}"
        for name in [name for name in known if seen.get(name) != known[name]]:
            del known[name]
            self._submit(now_ns, op=f"un{op}", **{kind: name})
        for name, type_name in seen.items():
            if (
                name in known
                or (kind == "service" and type_name.partition("/")[0] in _UNASKED)
                or not self._is_free(kind, name, type_name)
            ):
                continue
            if self._is_usable(type_name) and self._submit(now_ns, op=op, type=type_name, **{kind: name}):
                known[name] = type_name

    def _is_free(self, kind: str, name: str, type_name: str) -> bool:
        """Return whether what the graph has is not the console's, and no client has it in its place."""
        if kind == "topic":
            topic = self._router.topic(name)
            return topic is None or (not topic.owned and topic.type == type_name)
        calls = self._router.calls
        return name not in (calls.services() if kind == "service" else calls.actions())

    def _is_usable(self, type_name: str) -> bool:
        """Return whether a type is installed in the graph and the same there; makes it known here."""
        if type_name not in self._usable:
            self._usable[type_name] = self._learn(type_name)
        return self._usable[type_name]

    def _learn(self, type_name: str) -> bool:
        found = self._describe(type_name)
        if found is None:
            self._missing.append(type_name)
            return False
        names = set(self._registry.names())
        for definition in found:
            if definition.name not in names:
                self._registry.add_definition(definition)
            elif not is_same_layout(definition, self._registry.definition(definition.name)):
                text = f"{type_name} is not relayed: {definition.name} has other fields in this ROS 2"
                self._operations.append(GraphOperation("remark", "ros2", text=text))
                return False
        return True

    def _session_of(self, node: str) -> ClientSession:
        session = self._nodes.get(node)
        if session is None:
            if len(self._nodes) >= MAX_NODES:
                return self._main
            session = self._nodes[node] = self._router.connect(f"ros2:{node}", self._wake, role=self._role)
            session.set_level("warning")
        return session

    def _submit(self, now_ns: int, **operation: Any) -> bool:
        """Send an operation to the router as a client; return whether it was accepted."""
        return self._router.receive(self._main, msgspec.json.encode(operation), now_ns).kind == "done"

    def _pass_on(self, key: str, name: str, part: str, data: bytes, now_ns: int, **operation: Any) -> None:
        type_name = (self._router.calls.actions() if part == "Goal" else self._router.calls.services()).get(name, "")
        self._asked[key] = type_name
        try:
            args = deserialize(self._registry, self._registry.part(type_name, part) or "", data)
        except BridgeError as error:
            self._finish(
                key, GraphOperation("end" if part == "Goal" else "reply", name, text=str(error), status=ABORTED)
            )
            return
        self._submit(now_ns, id=key, args=args, **operation)

    def _values(self, kind: str, name: str, part: str, data: bytes | None) -> Any:
        if data is None:
            return None
        full = self._registry.part(self._advertised[kind].get(name, ""), part)
        return None if full is None else deserialize(self._registry, full, data)

    def _drain(self, now_ns: int) -> None:
        for name, session in (("ros2", self._main), *self._nodes.items()):
            while (text := session.next_text(now_ns)) is not None:
                self._translate(name, text)

    def _translate(self, peer: str, text: bytes) -> None:
        """Turn what the router sends to one of the relay's sessions into a graph operation."""
        if isinstance(text, Binary):
            published = cbor2.loads(text)
            self._operations.append(GraphOperation("send", published["topic"], data=published["msg"]["bytes"]))
            return
        said = orjson.loads(text)
        key = said.get("id")
        match said["op"]:
            case "status":
                self._operations.append(GraphOperation("remark", peer, text=said["msg"]))
            case "call_service":
                self._operations.append(self._request("call", "service", said, "Request"))
            case "send_action_goal":
                self._operations.append(self._request("goal", "action", said, "Goal"))
            case "cancel_action_goal":
                self._operations.append(GraphOperation("cancel", said["action"], key))
            case "action_feedback":
                data, why = self._cdr(self._asked.get(key, ""), "Feedback", said["values"])
                self._operations.append(GraphOperation("feedback", said["action"], key, data=data, text=why))
            case "service_response":
                data, why = self._ending(key, "Response", said)
                self._finish(key, GraphOperation("reply", said["service"], data=data, text=why))
            case _:  # action_result
                data, why = self._ending(key, "Result", said)
                self._finish(key, GraphOperation("end", said["action"], data=data, text=why, status=said["status"]))

    def _request(
        self, operation: Literal["call", "goal"], kind: str, said: dict[str, Any], part: str
    ) -> GraphOperation:
        name = said[kind]
        type_name = self._advertised[kind].get(name, "")
        data, why = self._cdr(type_name, part, said["args"])
        return GraphOperation(operation, name, key=said["id"], type=type_name, data=data, text=why)

    def _ending(self, key: str, part: str, said: dict[str, Any]) -> tuple[bytes | None, str]:
        if not isinstance(said["values"], dict):
            return None, str(said["values"])
        return self._cdr(self._asked.get(key, ""), part, said["values"])

    def _finish(self, key: str, operation: GraphOperation) -> None:
        self._asked.pop(key, None)
        self._operations.append(operation._replace(key=key))
        self._wake()

    def _cdr(self, type_name: str, part: str, values: Any) -> tuple[bytes | None, str]:
        full = self._registry.part(type_name, part)
        if full is None:
            return None, "it has left the graph"
        return serialize(self._registry, full, self._registry.from_plain(full, values)), ""


def _three_parts(name: str, kind: str) -> str:
    package, _, rest = name.partition("/")
    return f"{package}/{kind}/{rest.removeprefix(f'{kind}/')}"
