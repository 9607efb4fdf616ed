"""The client's side of rosbridge without a socket: operations out as text, messages in from text.

It keeps what the program asked for (advertised topics, subscriptions), so that a new connection can be given the
same wishes again.
"""

from collections.abc import Callable
from typing import Any, Final, NamedTuple

import orjson

from simconsole.bridge.documents import read
from simconsole.bridge.messages import Registry, standard_registry
from simconsole.bridge.operations import Operation, Publish, Status, read_operation, write_publish
from simconsole.errors import BridgeError, LocalProtocolError, RemoteProtocolError

MAX_STATUS: Final = 100

Callback = Callable[[str, Any], None]


class Received(NamedTuple):
    """One message of a subscribed topic."""

    topic: str
    message: Any


class _Subscription(NamedTuple):
    type_name: str
    callback: Callback | None
    text: bytes


class ClientProtocol:
    """What a client says and hears. Knows no socket and no time."""

    def __init__(self, registry: Registry | None = None) -> None:
        """Use `registry` for message types, the standard one without."""
        self.registry = registry if registry is not None else standard_registry()
        self.statuses: list[Status] = []
        """What the server remarked, newest last, at most MAX_STATUS."""
        self.refused = 0
        """Messages of the server that could not be used."""
        self._advertised: dict[str, tuple[str, bytes]] = {}
        self._subscriptions: dict[str, _Subscription] = {}

    def advertise(self, topic: str, type_name: str) -> bytes:
        """Return the text that announces a publisher.

        Raises:
            BridgeError: the type is not known.
            LocalProtocolError: the topic was advertised with another type.
        """
        full = self.registry.resolve(type_name)
        known = self._advertised.get(topic)
        if known is not None and known[0] != full:
            raise LocalProtocolError(f"{topic}: advertised as {known[0]}, cannot be {full} too")
        text = orjson.dumps({"op": "advertise", "topic": topic, "type": full})
        self._advertised[topic] = (full, text)
        return text

    def unadvertise(self, topic: str) -> bytes:
        """Return the text that withdraws a publisher."""
        self._advertised.pop(topic, None)
        return orjson.dumps({"op": "unadvertise", "topic": topic})

    def publish(self, topic: str, message: Any) -> bytes:
        """Return the text of one message: a dict, or an instance of the topic's type (`registry.struct`).

        Raises:
            LocalProtocolError: the topic is not advertised, or the message does not fit its type.
        """
        known = self._advertised.get(topic)
        if known is None:
            raise LocalProtocolError(f"{topic}: advertise it before publishing")
        try:
            self.registry.from_plain(known[0], message)
        except RemoteProtocolError as error:
            raise LocalProtocolError(f"{topic}: {error}") from None
        # As given, not with defaults filled in: a server refuses a command in which a field was forgotten.
        return write_publish(topic, message)

    def subscribe(
        self,
        topic: str,
        type_name: str,
        callback: Callback | None = None,
        throttle_rate: int = 0,
        queue_length: int = 0,
    ) -> bytes:
        """Return the text that asks for a topic.

        Args:
            topic: its name on the server.
            type_name: its type, in two or three parts.
            callback: called with (topic, message) by `receive`; without one the message is returned.
            throttle_rate: at most one message per so many milliseconds.
            queue_length: messages the server keeps for a slow client; 0 is the topic's own default.

        Raises:
            BridgeError: the type is not known.
        """
        full = self.registry.resolve(type_name)
        fields: dict[str, Any] = {"op": "subscribe", "topic": topic, "type": full}
        if throttle_rate:
            fields["throttle_rate"] = throttle_rate
        if queue_length:
            fields["queue_length"] = queue_length
        text = orjson.dumps(fields)
        self._subscriptions[topic] = _Subscription(full, callback, text)
        return text

    def unsubscribe(self, topic: str) -> bytes:
        """Return the text that ends a subscription."""
        self._subscriptions.pop(topic, None)
        return orjson.dumps({"op": "unsubscribe", "topic": topic})

    def wishes(self) -> list[bytes]:
        """Return the texts that give a new connection everything this client asked for."""
        return [
            *(text for _, text in self._advertised.values()),
            *(subscription.text for subscription in self._subscriptions.values()),
        ]

    def receive(self, text: bytes) -> Received | None:
        """Read one message of the server; return it if it is a subscribed topic's and has no callback.

        What cannot be used is counted in `refused`: a server's mistake must not end a drive.
        """
        try:
            operation = read_operation(read(text).fields)
            subscription, message = self._understand(operation)
        except BridgeError:
            self.refused += 1
            return None
        if isinstance(operation, Status):
            self.statuses = [*self.statuses[-MAX_STATUS + 1 :], operation]
        if not isinstance(operation, Publish) or subscription is None:
            return None
        if subscription.callback is None:
            return Received(operation.topic, message)
        subscription.callback(operation.topic, message)
        return None

    def _understand(self, operation: Operation) -> tuple[_Subscription | None, Any]:
        if not isinstance(operation, Publish):
            return None, None
        subscription = self._subscriptions.get(operation.topic)
        if subscription is None:
            return None, None
        return subscription, self.registry.from_plain(subscription.type_name, operation.msg)
