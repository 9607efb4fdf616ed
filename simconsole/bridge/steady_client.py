"""A rosbridge client that comes back: after a lost, dead or restarted server it has everything again.

What the program advertised and subscribed is one table in the protocol core, repeated on each new connection.
"""

import logging
import random
import time
from collections.abc import Callable
from types import TracebackType
from typing import Any, Final, Literal, Self

from simconsole.bridge.backoff import CAP_S, FIRST_S, Backoff, Liveness
from simconsole.bridge.client import BridgeClient
from simconsole.bridge.client_protocol import Callback, Received
from simconsole.bridge.messages import Registry
from simconsole.errors import BridgeError

State = Literal["connecting", "connected"]
_ATTEMPT_S: Final = 1.0

_logger = logging.getLogger("simconsole.bridge.client")


class SteadyClient:
    """Verbs as BridgeClient's, without `connect`: `receive` and `publish` connect as soon as it is possible.

    Not safe to share between threads. Nothing is sent, received or noticed but within a call.
    """

    def __init__(
        self,
        url: str,
        *,
        registry: Registry | None = None,
        token: str | None = None,
        certificate: str | None = None,
        on_state: Callable[[State], None] = lambda state: None,
        first_s: float = FIRST_S,
        cap_s: float = CAP_S,
    ) -> None:
        """Remember where to connect.

        Args:
            url: ws:// or wss:// address.
            registry: message types, the standard ones without.
            token: shown to the server.
            certificate: PEM file that a wss:// server is checked against.
            on_state: called with each change of the connection's state.
            first_s: the first pause between attempts.
            cap_s: the longest, without its scatter.

        Raises:
            BridgeError: as `BridgeClient`.
        """
        self._client = BridgeClient(
            url, registry=registry, connect_timeout_s=_ATTEMPT_S, token=token, certificate=certificate
        )
        self._on_state = on_state
        self._backoff = Backoff(first_s, cap_s)
        self._liveness = Liveness()
        self._chance = random.Random()
        self._next_attempt_s = 0.0
        self.state: State = "connecting"
        self.connections = 0
        """How often the connection was made."""
        self.failure = ""
        """Why there is, or was last, no connection."""

    def __enter__(self) -> Self:
        """Return the client; it is closed at the end of the block."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the connection."""
        self.close()

    @property
    def registry(self) -> Registry:
        """The message types of this client."""
        return self._client.registry

    def close(self) -> None:
        """Say good-bye and close."""
        self._client.close()

    def advertise(self, topic: str, type_name: str) -> None:
        """Announce a publisher, now and on every later connection. Errors as `ClientProtocol.advertise`."""
        self._try(lambda: self._client.advertise(topic, type_name))

    def unadvertise(self, topic: str) -> None:
        """Withdraw a publisher."""
        self._try(lambda: self._client.unadvertise(topic))

    def subscribe(
        self,
        topic: str,
        type_name: str,
        callback: Callback | None = None,
        throttle_rate: int = 0,
        queue_length: int = 0,
    ) -> None:
        """Ask for a topic, now and on every later connection. Arguments as `ClientProtocol.subscribe`."""
        self._try(lambda: self._client.subscribe(topic, type_name, callback, throttle_rate, queue_length))

    def unsubscribe(self, topic: str) -> None:
        """End a subscription."""
        self._try(lambda: self._client.unsubscribe(topic))

    def publish(self, topic: str, message: Any) -> bool:
        """Send a message; False when there is no connection: an old command must not be sent later.

        Raises:
            LocalProtocolError: as `ClientProtocol.publish`.
        """
        if not self._connect():
            return False
        return self._try(lambda: self._client.publish(topic, message))

    def receive(self, timeout_s: float) -> Received | None:
        """Return the next message without a callback, or None after `timeout_s`, with a connection or without."""
        deadline_s = time.monotonic() + timeout_s
        while True:
            now_s = time.monotonic()
            left_s = max(0.0, deadline_s - now_s)
            if not self._connect():
                time.sleep(min(left_s, max(0.0, self._next_attempt_s - time.monotonic())))
            else:
                received = self._receive(min(left_s, self._liveness.patience_s(now_s)))
                if received is not None:
                    return received
            if time.monotonic() >= deadline_s:
                return None

    def _receive(self, timeout_s: float) -> Received | None:
        try:
            received = self._client.receive(timeout_s)
            now_s = time.monotonic()
            self._liveness.heard(self._client.heard_s)
            if received is None and self._liveness.is_dead(now_s):
                raise BridgeError("the server has been silent for too long")
            if self._liveness.ping_due(now_s):
                self._client.ping()
        except BridgeError as error:
            self._lost(error)
            return None
        return received

    def _connect(self) -> bool:
        """Return whether there is a connection, made now if it is time for an attempt."""
        if self._client.connected:
            return True
        if self.state == "connected":
            self._lost(BridgeError("connection closed"))
        if time.monotonic() < self._next_attempt_s:
            return False
        try:
            self._client.connect()
        except BridgeError as error:
            self._lost(error)
            return False
        self.connections += 1
        self._backoff.reset()
        self._liveness.begin(time.monotonic())
        self._change("connected")
        return True

    def _try(self, send: Callable[[], None]) -> bool:
        try:
            send()
        except BridgeError as error:
            if self._client.connected or self.state == "connecting":
                raise  # not the connection's fault
            self._lost(error)
            return False
        return True

    def _lost(self, error: BridgeError) -> None:
        self.failure = str(error)
        self._client.drop()
        self._next_attempt_s = time.monotonic() + self._backoff.pause_s(self._chance.random())
        self._change("connecting")

    def _change(self, state: State) -> None:
        if state != self.state:
            self.state = state
            _logger.info("%s: %s %s", self._client.url, state, self.failure if state == "connecting" else "")
            self._on_state(state)
