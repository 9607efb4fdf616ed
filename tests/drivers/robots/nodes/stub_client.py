"""A rosbridge client without a server: what a node registers and publishes, as its messages' types have it."""

from collections import defaultdict
from collections.abc import Callable
from typing import Any

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.messages import standard_registry
from simconsole.bridge.protocol.client_protocol import Received


class StubClient(BridgeClient):
    def __init__(self) -> None:
        self.types: dict[str, str] = {}
        self.latched: set[str] = set()
        self.actions: dict[str, Callable[[Any], None]] = {}
        self.told: dict[str, list[Any]] = defaultdict(list)
        self.coming: list[Received] = []
        self._known = standard_registry()

    def advertise(self, topic: str, type_name: str, latch: bool = False) -> None:
        self.types[topic] = self._known.resolve(type_name)
        if latch:
            self.latched.add(topic)

    def advertise_action(self, action: str, type_name: str, pursue: Callable[[Any], None]) -> None:
        self.actions[action] = pursue

    def subscribe(self, topic: str, type_name: str, *given: Any, **more: Any) -> None:
        self.types[topic] = self._known.resolve(type_name)

    def publish(self, topic: str, message: Any) -> bool:
        self.told[topic].append(self._known.from_plain(self.types[topic], message))
        return True

    def receive(self, timeout_s: float) -> Received | None:
        return self.coming.pop(0) if self.coming else None

    def typed(self, topic: str, plain: dict[str, Any]) -> Any:
        """A message of a topic that the node has subscribed to."""
        return self._known.from_plain(self.types[topic], plain)
