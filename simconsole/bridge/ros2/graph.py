"""A node of rclpy on a thread of its own, and all that it has in the graph."""

import logging
import os
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Final

from simconsole.bridge.console.graph_view import (
    NOTHING,
    GraphEntities,
    GraphOperation,
    GraphView,
    Kind,
)
from simconsole.bridge.protocol.rosapi_graph import NodeNames
from simconsole.bridge.ros2.endpoints import POLL_S, Endpoints
from simconsole.bridge.ros2.graph_topics import GraphTopics, ReceivedMessage, path
from simconsole.bridge.ros2.offered_calls import OfferedCalls
from simconsole.bridge.ros2.service_calls import GraphCalls
from simconsole.profiles.bridge import Ros2Profile
from simconsole.values.errors import BridgeError

DETAIL_POLLS: Final = 10
"""Polls between two looks at what each node has."""
NOT_INSTALLED: Final = (
    "outputs.bridge.ros2: there is no rclpy; pip install 'simconsole[ros2]', or source a ROS 2 that uses this Python"
)
_JOIN_S: Final = 3.0
_DISCOVERY: Final = "ROS_AUTOMATIC_DISCOVERY_RANGE"
MAX_ERRORS: Final = 100
"""Turns of rclpy's executor that may fail one after the other before the whole node is taken for broken."""
_ERROR_PAUSE_S: Final = 0.02

_logger: Final = logging.getLogger("simconsole.bridge.ros2.graph")


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
        self._topics = GraphTopics(node, self._group, receive, self._reporter("topic"))
        self._services = Endpoints(self._offered.make_service, self._offered.end, self._reporter("service"))
        self._actions = Endpoints(self._offered.make_action, self._offered.end, self._reporter("action"))
        self.broken = False
        """Whether rclpy's thread has ended unexpectedly."""
        self._closing = False
        self._details: dict[str, NodeNames] = {}
        self._polls = 0
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
            self._topics.send(operation.name, operation.type, operation.data or b"")
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
            if node.count_subscribers(name) > (name in self._topics.subscriptions):
                listened.add(name)
            others_publish = node.count_publishers(name) > (name in self._topics.publishers)
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
        others = {path(space, name): (name, space) for name, space in named if path(space, name) != self._name}
        if others.keys() != self._details.keys() or self._polls % DETAIL_POLLS == 0:
            self._details = {full: self._names_of(*parts) for full, parts in others.items()}
        self._polls += 1
        self._topics.poll()
        self._calls.poll()
        self._offered.poll()
        view = GraphView(
            topics=topics,
            listened=frozenset(listened),
            services=services,
            actions=actions,
            nodes=frozenset(path(space, name) for name, space in named),
            details=self._details,
            latching=self._topics.latching(self._entities.subscriptions),
        )
        self._put("view", view)
        self._update_entities()

    def _names_of(self, name: str, namespace: str) -> NodeNames:
        def visible(found: list[tuple[str, list[str]]]) -> tuple[str, ...]:
            """Return the sorted names that are no inside of an action."""
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
        topics = self._topics
        wanted: tuple[tuple[Endpoints, Mapping[str, Any]], ...] = (
            (topics.publishers, entities.publishers),
            (topics.subscriptions, topics.settings(entities.subscriptions)),
            (self._services, entities.services),
            (self._actions, entities.actions),
        )
        # A node cannot have one name in two types: all that ends does so before anything is made.
        for endpoints, names in wanted:
            endpoints.retire(names)
        for endpoints, names in wanted:
            endpoints.create(names)
        topics.forget()

    def _reporter(self, kind: Kind) -> Callable[[str, str], None]:
        return lambda name, why: self._put("failed", kind, name, why)


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
