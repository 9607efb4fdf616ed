"""The topics of a node in the graph: what it publishes, what it subscribes to, and who has published what came.

Public methods belong to rclpy's thread, but for `send`, which is the bridge's.
"""

import logging
import threading
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final, NamedTuple

from simconsole.bridge.console.graph_view import ANYONE, GraphPublisher
from simconsole.bridge.ros2.endpoints import Endpoints
from simconsole.bridge.ros2.message_types import load

DEPTH: Final = 100
"""Messages of a topic that wait to be read, by the next turn of rclpy; of a latched one each publisher has one."""
MAX_POLLS: Final = 10
MAX_PENDING: Final = 100
MAX_SENT: Final = 100
UNNAMED: Final = b""
"""The identity of all publishers where ROS does not name them."""
_NAMELESS: Final = "_NODE_NAME_UNKNOWN_"
"""rmw's name of a node whose endpoints are known before itself."""
MAX_KNOWN: Final = 1000
"""Publishers whose node is remembered."""

_logger: Final = logging.getLogger("simconsole.bridge.ros2.graph_topics")


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


class GraphTopics:
    """Publishers and subscriptions of one node."""

    def __init__(
        self,
        node: Any,
        group: Any,
        receive: Callable[[ReceivedMessage], None],
        report: Callable[[str, str], None],
    ) -> None:
        """Begin without any; `receive` gets what comes, `report` what cannot be made and why (`Endpoints`)."""
        self._node = node
        self._name = node.get_fully_qualified_name()
        self._group = group
        self._receive = receive
        self.publishers = Endpoints(self._make_publisher, node.destroy_publisher, report)
        self.subscriptions = Endpoints(self._make_subscription, node.destroy_subscription, report)
        self._early: dict[str, tuple[str, bytes]] = {}
        """The newest message, and its type, of each topic whose publisher is not yet made."""
        self._lock = threading.Lock()
        self._sent: dict[str, deque[bytes]] = {}
        """The newest messages that were sent on topics which are also subscribed to."""
        self._pending: list[_PendingMessage] = []
        self._nodes: dict[bytes, str] = {}
        """Who publishes, by the identity of the publisher."""

    def settings(self, subscriptions: Mapping[str, str]) -> dict[str, Any]:
        """Return how each topic, given with its type, is to be subscribed to now."""
        return {name: self._subscription_settings(name, kind) for name, kind in subscriptions.items()}

    def poll(self) -> None:
        """Look again for the nodes of publishers."""
        if len(self._nodes) > MAX_KNOWN:
            self._nodes.clear()
        self._resolve_publishers(1)

    def forget(self) -> None:
        """Forget what was kept for topics that the node no longer has."""
        for name in [name for name in self._early if name not in self.publishers]:
            self._early.pop(name, None)
        for name in [name for name in self._sent if name not in self.subscriptions]:
            with self._lock:
                self._sent.pop(name, None)

    def send(self, name: str, type_name: str, data: bytes) -> None:
        """Publish a message; one that comes before its publisher is made waits for it."""
        known = self.publishers.find(name)
        if known is None or known[0].type != type_name:
            self._early[name] = (type_name, data)
            return
        if name in self.subscriptions:
            with self._lock:
                self._sent.setdefault(name, deque(maxlen=MAX_SENT)).append(data)
        try:
            known[1].publish(data)
        except Exception as error:  # noqa: BLE001  it may have been destroyed meanwhile, because nothing subscribes any more
            _logger.debug("%s: not published: %s", name, error)

    def latching(self, names: Iterable[str]) -> dict[str, frozenset[bytes]]:
        """Return who publishes those of the topics that are subscribed to as latched."""
        found = {}
        for name in names:
            known = self.subscriptions.find(name)
            if known is not None and known[0].latched:
                publishers = self._node.get_publishers_info_by_topic(name)
                found[name] = frozenset([*(bytes(each.endpoint_gid) for each in publishers), UNNAMED])
        return found

    def _make_publisher(self, name: str, offer: GraphPublisher) -> Any:
        from rclpy.duration import Duration
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

        spans = {"deadline": offer.deadline_ns, "lifespan": offer.lifespan_ns}
        qos = QoSProfile(
            depth=offer.depth,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if offer.latched else DurabilityPolicy.VOLATILE,
            reliability=ReliabilityPolicy.BEST_EFFORT if offer.best_effort else ReliabilityPolicy.RELIABLE,
            **{name: Duration(nanoseconds=span_ns) for name, span_ns in spans.items() if span_ns is not None},
        )
        publisher = self._node.create_publisher(load(offer.type), name, qos)
        early = self._early.pop(name, None)
        if early is not None and early[0] == offer.type:
            publisher.publish(early[1])
        return publisher

    def _subscription_settings(self, name: str, kind: str) -> _SubscriptionSettings:
        """Return settings that fit all publishers: a reliable subscription gets nothing from a best-effort one."""
        from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

        found = self._node.get_publishers_info_by_topic(name)
        others = [info.qos_profile for info in found if path(info.node_namespace, info.node_name) != self._name]
        reliable = all(qos.reliability != ReliabilityPolicy.BEST_EFFORT for qos in others)
        latched = bool(others) and all(qos.durability == DurabilityPolicy.TRANSIENT_LOCAL for qos in others)
        return _SubscriptionSettings(kind, reliable, latched)

    def _make_subscription(self, name: str, way: _SubscriptionSettings) -> Any:
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

        qos = QoSProfile(
            depth=DEPTH,
            reliability=ReliabilityPolicy.RELIABLE if way.reliable else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if way.latched else DurabilityPolicy.VOLATILE,
        )

        def take(data: bytes, info: Any) -> None:
            """Take a message as it comes from rclpy, and those behind it: a turn of rclpy costs more than a message."""
            self._take(name, way, data, info)
            for _ in range(DEPTH):
                with subscription.handle:
                    found = subscription.handle.take_message(subscription.msg_type, subscription.raw)
                if found is None:
                    break
                self._take(name, way, *found)

        subscription: Any = self._node.create_subscription(
            load(way.type), name, take, qos, raw=True, callback_group=self._group
        )
        return subscription

    def _take(self, name: str, way: _SubscriptionSettings, data: bytes, info: Any) -> None:
        """Pass a message on as soon as its publisher's node is known."""
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
                    self._nodes[bytes(known.endpoint_gid)] = path(known.node_namespace, known.node_name)
        return self._nodes.get(message.identity)


def path(namespace: str, name: str) -> str:
    """Return the full name of a node."""
    return f"{namespace.rstrip('/')}/{name}"
