"""The interface that a robot's programs need of a rosbridge client."""

from collections.abc import Callable
from typing import Any, Protocol

import msgspec

from simconsole.bridge.protocol.client_protocol import Callback, Goal, Received


class RosClient(Protocol):
    """A client as `BridgeClient` is one, or one node's share of it."""

    def advertise(self, topic: str, type_name: str, latch: bool = False) -> None:
        """Announce a publisher."""

    def publish(self, topic: str, message: Any) -> bool:
        """Send one message; False where there is no connection."""

    def subscribe(
        self,
        topic: str,
        type_name: str,
        callback: Callback | None = None,
        throttle_rate: int = 0,
        queue_length: int = 0,
        reads: type[msgspec.Struct] | None = None,
    ) -> None:
        """Ask for a topic."""

    def advertise_action(self, action: str, type_name: str, pursue: Callable[[Goal], None]) -> None:
        """Take the goals of an action."""

    def receive(self, timeout_s: float) -> Received | None:
        """Return the next message, None after `timeout_s`."""
