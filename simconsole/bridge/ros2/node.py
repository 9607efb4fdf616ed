"""The ROS 2 graph as one more client of a console's bridge, beside the sockets.

rclpy spins on a thread of its own; its callbacks only put what they got into an inbox and wake the bridge's thread,
which does everything else in `pump`.
"""

import importlib.util
import logging
from collections import deque
from collections.abc import Callable, Iterator
from typing import Any, Final

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.relay import Relay
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.ros2.graph import NOT_INSTALLED, Graph
from simconsole.bridge.ros2.graph_topics import ReceivedMessage
from simconsole.bridge.ros2.message_types import describe
from simconsole.bridge.ros2.received_messages import TURN_BYTES, TURN_MESSAGES, ReceivedMessages
from simconsole.profiles.bridge import BridgeProfile, Ros2Profile
from simconsole.values.errors import BridgeError, ProfileError

LOGGED: Final = 10
LOGGED_EVERY: Final = 1000
"""Remarks of a node that are logged, the first ones and then now and again: a flood must not fill the disk."""

_logger = logging.getLogger("simconsole.bridge.ros2.node")


class Ros2Link:
    """Joins a console bridge to the graph. All methods belong to the bridge's thread."""

    def __init__(self, console: ConsoleBridge, profile: BridgeProfile, wake: Callable[[], None]) -> None:
        """Join the graph.

        Args:
            console: whose router the graph becomes a client of.
            profile: its `ros2` section says how.
            wake: called on any thread when `pump` has something to do.

        Raises:
            BridgeError: rclpy is not installed, or cannot join.
            ProfileError: the graph would be open to other machines.
        """
        settings = profile.ros2 or Ros2Profile()
        self._inbox: deque[tuple[str, tuple[Any, ...]]] = deque()
        self._received = ReceivedMessages()
        self._remarks: dict[str, int] = {}
        self._wake = wake
        self._relay = Relay(console, role_of_graph(profile, console.router.access.anonymous), describe, wake)
        try:
            self._graph = Graph(settings, profile.limits.call_s, self._put, self._receive)
        except BridgeError:
            self._relay.leave(0)
            raise

    def check(self) -> None:
        """Raise BridgeError if rclpy has failed."""
        if self._graph.broken:
            raise BridgeError("outputs.bridge.ros2: rclpy has failed; its own message stands above")

    def pump(self, now_ns: int) -> None:
        """Pass on what has come from the graph, as much as one turn may take, and what is for it."""
        for event, arguments in self._events_of_turn():
            if event == "view":
                self._graph.set_entities(self._relay.observe(arguments[0], now_ns))
            elif event in ("failed", "remarked"):
                getattr(self._relay, event)(*arguments, now_ns)
            else:
                getattr(self._relay.calls, event)(*arguments, now_ns)
        for message in self._received.take():
            self._relay.receive(*message, now_ns)
        for topic, count in self._received.take_dropped().items():
            self._relay.lost(topic, count, now_ns)
        if self._inbox or self._received.waits:
            self._wake()
        for operation in self._relay.operations(now_ns):
            if operation.kind == "remark":
                self._log(operation.name, operation.text)
            else:
                self._graph.execute(operation)

    def close(self) -> None:
        """Leave the graph; harmless when closed."""
        self._graph.close()

    def _events_of_turn(self) -> Iterator[tuple[str, tuple[Any, ...]]]:
        """Take from the inbox what one turn may: clients need not wait for a flood of calls."""
        size = 0
        for _ in range(TURN_MESSAGES):
            if not self._inbox or size >= TURN_BYTES:
                return
            event, arguments = self._inbox.popleft()
            size += sum(len(each) for each in arguments if isinstance(each, bytes))
            yield event, arguments

    def _log(self, node: str, text: str) -> None:
        count = self._remarks[node] = self._remarks.get(node, 0) + 1
        if count <= LOGGED or count % LOGGED_EVERY == 0:
            _logger.warning("%s (%d): %s", node, count, text)

    def _put(self, event: str, *arguments: Any) -> None:
        self._inbox.append((event, arguments))
        self._wake()

    def _receive(self, message: ReceivedMessage) -> None:
        self._received.put(message)
        self._wake()


def check(profile: BridgeProfile) -> None:
    """Find out at once, and not in the bridge's own process, that the graph cannot be joined.

    Raises:
        BridgeError: rclpy is not installed.
        ProfileError: the graph would be open to other machines.
    """
    if profile.ros2 is None:
        return
    role_of_graph(profile, Role.VIEW)
    if importlib.util.find_spec("rclpy") is None:
        raise BridgeError(NOT_INSTALLED)


def role_of_graph(profile: BridgeProfile, anonymous: Role) -> Role:
    """Return what the nodes of the graph may do: what the profile says, else what a client without token may.

    Raises:
        ProfileError: the graph would reach beyond this machine without `trust_network`.
    """
    settings = profile.ros2 or Ros2Profile()
    if settings.discovery != "localhost" and not profile.trust_network:
        raise ProfileError("outputs.bridge.ros2.discovery: value subnet: only with outputs.bridge.trust_network")
    return max(Role.VIEW, anonymous) if settings.role is None else Role[settings.role.upper()]
