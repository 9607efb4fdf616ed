"""A node of rclpy on a thread of its own, and all that it has in the graph."""

import logging
import os
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Final, NamedTuple

from simconsole.bridge.console.graph_view import (
    ANYONE,
    NOTHING,
    GraphEntities,
    GraphOperation,
    GraphPublisher,
    GraphView,
    Kind,
)
from simconsole.bridge.protocol.rosapi_graph import NodeNames
from simconsole.bridge.ros2.endpoints import POLL_S, Endpoints
from simconsole.bridge.ros2.message_types import load
from simconsole.bridge.ros2.offered_calls import OfferedCalls
from simconsole.bridge.ros2.service_calls import GraphCalls
from simconsole.profiles.bridge import Ros2Profile
from simconsole.values.errors import BridgeError

DEPTH: Final = 10
LATCHED_DEPTH: Final = 100
DETAIL_POLLS: Final = 10
"""Polls between two looks at what each node has."""
MAX_POLLS: Final = 10
MAX_PENDING: Final = 100
MAX_SENT: Final = 100
UNNAMED: Final = b""
"""The identity of all publishers where ROS does not name them."""
_NAMELESS: Final = "_NODE_NAME_UNKNOWN_"
"""rmw's name of a node whose endpoints are known before itself."""
NOT_INSTALLED: Final = (
    "outputs.bridge.ros2: there is no rclpy; pip install 'simconsole[ros2]', or source a ROS 2 that uses this Python"
)
_JOIN_S: Final = 3.0
_DISCOVERY: Final = "ROS_AUTOMATIC_DISCOVERY_RANGE"
MAX_ERRORS: Final = 100
"""Turns of rclpy's executor that may fail one after the other before the whole node is taken for broken."""
_ERROR_PAUSE_S: Final = 0.02

_logger: Final = logging.getLogger("simconsole.bridge.ros2.graph")


class ReceivedMessage(NamedTuple):
    """A message of the graph, in CDR, and the node that published it."""

    topic: str
    type: str
    data: bytes
    node: str
    latched_by: bytes | None


class _PendingMessage(NamedTuple):
    """A message whose publisher's node is not known yet, and for how many polls of the graph it has waited."""

    topic: str
    type: str
    data: bytes
    identity: bytes
    latched: bool
    polls: int


class _SubscriptionSettings(NamedTuple):
    """How a topic is subscribed to."""

    type: str
    reliable: bool
    latched: bool

    @property
    def depth(self) -> int:
        """Messages that wait to be read; of latched ones each publisher has one at once."""
        return LATCHED_DEPTH if self.latched else DEPTH


class Graph:
    """The console's node. Public methods belong to the bridge's thread, all others to rclpy's."""

    def __init__(
        self,
        settings: Ros2Profile,
        call_s: float,
        put: Callable[..., None],
        receive: Callable[[ReceivedMessage], None],
    ) -> None:
        """Join; `put` and `receive` are called on rclpy's thread, `call_s` is how long a service may take to answer.

        Raises:
            BridgeError: rclpy is not installed, or cannot join.
        """
        try:
            import rclpy
            import rclpy.action
            from rclpy.callback_groups import ReentrantCallbackGroup
            from rclpy.executors import SingleThreadedExecutor
        except ImportError as error:
            raise BridgeError(f"{NOT_INSTALLED}: {error}") from None
        self._rclpy: Any = rclpy
        self._put = put
        self._receive = receive
        self._context: Any = rclpy.Context()
        try:
            with _environment(_DISCOVERY, settings.discovery.upper()):
                rclpy.init(context=self._context, domain_id=settings.domain_id)
            node: Any = rclpy.create_node(
                settings.node, context=self._context, enable_rosout=False, start_parameter_services=False
            )
        except (RuntimeError, ValueError) as error:
            raise BridgeError(f"outputs.bridge.ros2: cannot join the graph: {error}") from None
        self._node = node
        self._name = node.get_fully_qualified_name()
        self._group = ReentrantCallbackGroup()
        self._executor: Any = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(node)
        self._calls = GraphCalls(node, self._group, put, call_s)
        self._offered = OfferedCalls(node, self._executor, self._group, put)
        self._entities = GraphEntities({}, {}, {}, {})
        self._publishers = Endpoints(self._make_publisher, node.destroy_publisher, self._reporter("topic"))
        self._subscriptions = Endpoints(self._make_subscription, node.destroy_subscription, self._reporter("topic"))
        self._services = Endpoints(self._offered.make_service, self._offered.end, self._reporter("service"))
        self._actions = Endpoints(self._offered.make_action, self._offered.end, self._reporter("action"))
        self.broken = False
        """Whether rclpy's thread has ended unexpectedly."""
        self._closing = False
        self._early: dict[str, tuple[str, bytes]] = {}
        """The newest message, and its type, of each topic whose publisher is not yet made."""
        self._lock = threading.Lock()
        self._sent: dict[str, deque[bytes]] = {}
        """The newest messages that were sent on topics which are also subscribed to."""
        self._pending: list[_PendingMessage] = []
        self._details: dict[str, NodeNames] = {}
        self._polls = 0
        self._nodes: dict[bytes, str] = {}
        """Who publishes, by the identity of the publisher."""
        node.create_timer(POLL_S, self._poll, callback_group=self._group)
        self._thread = threading.Thread(target=self._spin, name="ros2", daemon=True)
        self._thread.start()

    def set_entities(self, entities: GraphEntities) -> None:
        """Create and destroy publishers, subscriptions, services and actions to match `entities`, soon."""
        if entities != self._entities:
            self._entities = entities
            self._executor.create_task(self._update_entities)

    def execute(self, operation: GraphOperation) -> None:
        """Carry out one operation of the relay."""
        if operation.kind == "send":
            self._send(operation.name, operation.type, operation.data or b"")
        else:
            self._executor.create_task(self._execute, operation)

    def close(self) -> None:
        """Leave; harmless when closed."""
        if self._closing:
            return
        self._closing = True
        self._executor.wake()
        self._thread.join(_JOIN_S)
        self._executor.shutdown()
        self._node.destroy_node()
        self._rclpy.shutdown(context=self._context)

    def _send(self, name: str, type_name: str, data: bytes) -> None:
        known = self._publishers.find(name)
        if known is None or known[0].type != type_name:
            self._early[name] = (type_name, data)
            return
        if name in self._subscriptions:
            with self._lock:
                self._sent.setdefault(name, deque(maxlen=MAX_SENT)).append(data)
        try:
            known[1].publish(data)
        except Exception as error:  # noqa: BLE001  it may have been destroyed meanwhile, because nothing subscribes any more
            _logger.debug("%s: not published: %s", name, error)

    def _spin(self) -> None:
        errors = 0
        try:
            while not self._closing and errors < MAX_ERRORS:
                try:
                    self._executor.spin_once()
                    errors = 0
                except Exception as error:  # noqa: BLE001  of one callback, or of one endpoint that ended while it was read
                    errors += 1
                    self._put("remarked", "rclpy", f"{type(error).__name__}: {error}")
                    time.sleep(_ERROR_PAUSE_S)
        finally:
            if not self._closing:
                self.broken = True
                self._put("view", NOTHING)

    def _execute(self, operation: GraphOperation) -> None:
        match operation.kind:
            case "call" | "goal":
                self._calls.request(operation)
            case "cancel":
                self._calls.cancel(operation)
            case "reply" | "end":
                self._offered.finish(operation)
            case "feedback":
                self._offered.publish_feedback(operation)

    def _poll(self) -> None:
        node = self._node
        topics, listened = {}, set()
        for name, types in node.get_topic_names_and_types():
            if "/_" in name:
                continue  # hidden: an action's inside
            if node.count_subscribers(name) > (name in self._subscriptions):
                listened.add(name)
            others_publish = node.count_publishers(name) > (name in self._publishers)
            if len(types) == 1 and (others_publish or name in listened):
                topics[name] = types[0]
        services = {
            name: types[0]
            for name, types in node.get_service_names_and_types()
            if "/_" not in name and len(types) == 1 and node.count_services(name) > (name in self._services)
        }
        actions = {
            name: types[0]
            for name, types in self._rclpy.action.get_action_names_and_types(node)
            if len(types) == 1 and node.count_services(f"{name}/_action/send_goal") > (name in self._actions)
        }
        named = node.get_node_names_and_namespaces()
        nodes = {_path(space, name) for name, space in named}
        if nodes != self._details.keys() or self._polls % DETAIL_POLLS == 0:
            self._details = {_path(space, name): self._names_of(name, space) for name, space in named}
        self._polls += 1
        self._resolve_publishers(1)
        self._calls.poll()
        self._offered.poll()
        view = GraphView(
            topics=topics,
            listened=frozenset(listened),
            services=services,
            actions=actions,
            nodes=frozenset(nodes),
            details=self._details,
            latching=self._latching(),
        )
        self._put("view", view)
        self._update_entities()

    def _names_of(self, name: str, namespace: str) -> NodeNames:
        def visible(found: list[tuple[str, list[str]]]) -> tuple[str, ...]:
            return tuple(sorted(each for each, _ in found if "/_" not in each))

        node = self._node
        try:
            return NodeNames(
                publishing=visible(node.get_publisher_names_and_types_by_node(name, namespace)),
                subscribing=visible(node.get_subscriber_names_and_types_by_node(name, namespace)),
                services=visible(node.get_service_names_and_types_by_node(name, namespace)),
            )
        except Exception:  # noqa: BLE001  it may have left just now
            return NodeNames((), (), ())

    def _update_entities(self) -> None:
        entities = self._entities
        ways = {name: self._subscription_settings(name, kind) for name, kind in entities.subscriptions.items()}
        wanted = (
            (self._publishers, entities.publishers),
            (self._subscriptions, ways),
            (self._services, entities.services),
            (self._actions, entities.actions),
        )
        # A node cannot have one name in two types: all that ends does so before anything is made.
        for endpoints, names in wanted:
            endpoints.retire(names)
        for endpoints, names in wanted:
            endpoints.create(names)
        for name in [name for name in self._early if name not in entities.publishers]:
            self._early.pop(name, None)
        for name in [name for name in self._sent if name not in self._subscriptions]:
            with self._lock:
                self._sent.pop(name, None)

    def _latching(self) -> dict[str, frozenset[bytes]]:
        """Return who publishes what is subscribed to as latched."""
        found = {}
        for name in self._entities.subscriptions:
            known = self._subscriptions.find(name)
            if known is not None and known[0].latched:
                publishers = self._node.get_publishers_info_by_topic(name)
                found[name] = frozenset([*(bytes(each.endpoint_gid) for each in publishers), UNNAMED])
        return found

    def _reporter(self, kind: Kind) -> Callable[[str, str], None]:
        return lambda name, why: self._put("failed", kind, name, why)

    def _make_publisher(self, name: str, offer: GraphPublisher) -> Any:
        from rclpy.qos import DurabilityPolicy, QoSProfile

        durability = DurabilityPolicy.TRANSIENT_LOCAL if offer.latched else DurabilityPolicy.VOLATILE
        qos = QoSProfile(depth=offer.depth, durability=durability)
        publisher = self._node.create_publisher(load(offer.type), name, qos)
        early = self._early.pop(name, None)
        if early is not None and early[0] == offer.type:
            publisher.publish(early[1])
        return publisher

    def _subscription_settings(self, name: str, kind: str) -> _SubscriptionSettings:
        """Return settings that fit all publishers: a reliable subscription gets nothing from a best-effort one."""
        from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

        found = self._node.get_publishers_info_by_topic(name)
        others = [info.qos_profile for info in found if _path(info.node_namespace, info.node_name) != self._name]
        reliable = all(qos.reliability != ReliabilityPolicy.BEST_EFFORT for qos in others)
        latched = bool(others) and all(qos.durability == DurabilityPolicy.TRANSIENT_LOCAL for qos in others)
        return _SubscriptionSettings(kind, reliable, latched)

    def _make_subscription(self, name: str, way: _SubscriptionSettings) -> Any:
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

        qos = QoSProfile(
            depth=way.depth,
            reliability=ReliabilityPolicy.RELIABLE if way.reliable else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if way.latched else DurabilityPolicy.VOLATILE,
        )

        def take(data: bytes, info: Any) -> None:
            # Where ROS does not name the publisher (before Kilted), the whole graph counts as one node.
            identity = (info.get("publisher_gid") or {}).get("data")
            if identity is None:
                if not self._is_own(name, data):
                    self._receive(ReceivedMessage(name, way.type, data, ANYONE, UNNAMED if way.latched else None))
                return
            message = _PendingMessage(
                topic=name, type=way.type, data=data, identity=bytes(identity), latched=way.latched, polls=0
            )
            self._pending.append(message)
            self._resolve_publishers(0)

        return self._node.create_subscription(load(way.type), name, take, qos, raw=True, callback_group=self._group)

    def _is_own(self, name: str, data: bytes) -> bool:
        """Return whether a message is one that was sent from here, where ROS does not name the publisher."""
        with self._lock:
            try:
                self._sent[name].remove(data)
            except (KeyError, ValueError):
                return False
        return True

    def _resolve_publishers(self, polls: int) -> None:
        """Pass on, in order, what has come from publishers whose node is known by now.

        A publisher is found some moments before the name of its node. Such messages wait rather than be taken for
        another node's; for a second at most.
        """
        waiting, self._pending = self._pending, []
        for each in waiting:
            node = self._publisher(each)
            if node is None and each.polls < MAX_POLLS:
                self._pending.append(each._replace(polls=each.polls + polls))
            elif node != self._name:
                latched_by = each.identity if each.latched else None
                self._receive(ReceivedMessage(each.topic, each.type, each.data, node or ANYONE, latched_by))
        del self._pending[:-MAX_PENDING]

    def _publisher(self, message: _PendingMessage) -> str | None:
        if message.identity not in self._nodes:
            for known in self._node.get_publishers_info_by_topic(message.topic):
                if known.node_name != _NAMELESS:
                    self._nodes[bytes(known.endpoint_gid)] = _path(known.node_namespace, known.node_name)
        return self._nodes.get(message.identity)


def _path(namespace: str, name: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"


@contextmanager
def _environment(name: str, value: str) -> Iterator[None]:
    """Set an environment variable only while ROS reads it: programs started later keep their own value."""
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before
