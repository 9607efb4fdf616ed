"""One rosbridge client for several nodes of one program: each gets what it subscribed to, and may wait for it."""

from collections import deque
from collections.abc import Callable
from typing import Any

import msgspec

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.protocol.client_protocol import Callback, Goal, Received

Take = Callable[[str, Any], None]


class SharedClient:
    """Hands the messages of one connection to its nodes."""

    def __init__(self, client: BridgeClient) -> None:
        """Share `client`, which is not connected yet."""
        self.client = client
        self._ports: list[NodePort] = []

    def port(self) -> "NodePort":
        """Return the share of one more node."""
        self._ports.append(NodePort(self))
        return self._ports[-1]

    def pump(self, timeout_s: float) -> bool:
        """Receive one message and hand it on; False where none has come.

        Raises:
            BridgeError: the connection has ended.
        """
        received = self.client.receive(timeout_s)
        if received is None:
            return False
        for port in self._ports:
            if received.topic in port.topics:
                port.hand(received)
        return True


class NodePort:
    """One node's share of a client (`RosClient`).

    Attributes:
        topics: that it has subscribed to.
        waiting: what came for it, where it takes messages itself.
        at_once: takes each message when it comes, in place of `waiting`: of a node that waits for nobody.
    """

    def __init__(self, shared: SharedClient) -> None:
        """Start without topics."""
        self.topics: set[str] = set()
        self.waiting: deque[Received] = deque()
        self.at_once: Take | None = None
        self._shared = shared

    def hand(self, received: Received) -> None:
        """Take a message of the connection."""
        if self.at_once is None:
            self.waiting.append(received)
        else:
            self.at_once(*received)

    def advertise(self, topic: str, type_name: str, latch: bool = False) -> None:
        """Announce a publisher."""
        self._shared.client.advertise(topic, type_name, latch)

    def publish(self, topic: str, message: Any) -> bool:
        """Send one message; False where there is no connection."""
        return self._shared.client.publish(topic, message)

    def subscribe(
        self,
        topic: str,
        type_name: str,
        callback: Callback | None = None,
        throttle_rate: int = 0,
        queue_length: int = 0,
        reads: type[msgspec.Struct] | None = None,
    ) -> None:
        """Ask for a topic; nodes that share one ask for it alike."""
        self.topics.add(topic)
        self._shared.client.subscribe(topic, type_name, callback, throttle_rate, queue_length, reads)

    def advertise_action(self, action: str, type_name: str, pursue: Callable[[Goal], None]) -> None:
        """Take the goals of an action."""
        self._shared.client.advertise_action(action, type_name, pursue)

    def receive(self, timeout_s: float) -> Received | None:
        """Return the node's next message, None where none has come; other nodes get theirs meanwhile."""
        if not self.waiting:
            self._shared.pump(timeout_s)
        return self.waiting.popleft() if self.waiting else None
