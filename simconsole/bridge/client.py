"""A small synchronous rosbridge client for programs: one socket, no thread, no event loop.

Example:
    with BridgeClient("ws://127.0.0.1:9090") as client:
        client.connect()
        client.subscribe("/odom", "nav_msgs/Odometry")
        client.advertise("/cmd_vel", "geometry_msgs/Twist")
        while True:
            received = client.receive(timeout_s=1.0)
            if received is not None:
                client.publish("/cmd_vel", {"linear": {"x": 1.0}})
"""

import logging
import socket
import ssl
import time
from collections import deque
from types import TracebackType
from typing import Any, Final, Self

from websockets.client import ClientProtocol as WebSocketClientProtocol
from websockets.exceptions import InvalidURI
from websockets.frames import Frame
from websockets.protocol import SEND_EOF, State
from websockets.uri import parse_uri

from simconsole.bridge.client_protocol import Callback, ClientProtocol, Received
from simconsole.bridge.messages import Registry
from simconsole.bridge.operations import Status
from simconsole.bridge.wire import RECEIVE_BYTES, MessageAssembler, is_data
from simconsole.errors import BridgeError

MAX_MESSAGE_BYTES: Final = 16_777_216

_logger = logging.getLogger("simconsole.bridge.client")


class BridgeClient:
    """A connection to a rosbridge server. Not safe to share between threads."""

    def __init__(
        self,
        url: str,
        *,
        registry: Registry | None = None,
        connect_timeout_s: float = 5.0,
        token: str | None = None,
        certificate: str | None = None,
    ) -> None:
        """Remember where to connect; `connect` does it.

        Args:
            url: ws://HOST:PORT or wss://HOST:PORT.
            registry: message types, the standard ones without.
            connect_timeout_s: how long `connect` waits.
            token: shown to the server at once.
            certificate: a PEM file that a wss:// server is checked against, in place of the system's authorities.

        Raises:
            BridgeError: `url` is not such an address, or the certificate cannot be read.
        """
        try:
            self._uri = parse_uri(url)
        except InvalidURI as error:
            raise BridgeError(f"url: {error}") from None
        self._tls: ssl.SSLContext | None = None
        self._token = token
        if self._uri.secure:
            try:
                self._tls = ssl.create_default_context(cafile=certificate)
            except OSError as error:
                raise BridgeError(f"certificate: {certificate}: {error}") from None
        self.url = url
        self.protocol = ClientProtocol(registry)
        self._connect_timeout_s = connect_timeout_s
        self._socket: socket.socket | None = None
        self._web: WebSocketClientProtocol | None = None
        self._texts = MessageAssembler()
        self._received: deque[Received] = deque()
        self.heard_s = 0.0
        """When something last arrived, on the monotonic clock."""

    def __enter__(self) -> Self:
        """Return the client; it is closed at the end of the block."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the connection."""
        self.close()

    @property
    def connected(self) -> bool:
        """Whether the connection is open as far as this side knows."""
        return self._web is not None and self._web.state is State.OPEN

    @property
    def registry(self) -> Registry:
        """The message types of this client: `client.registry.struct(name)` makes a typed message."""
        return self.protocol.registry

    @property
    def statuses(self) -> list[Status]:
        """The server's remarks (refusals with their reason), newest last."""
        return self.protocol.statuses

    def connect(self) -> None:
        """Open the connection and repeat everything already advertised and subscribed.

        Raises:
            BridgeError: nobody listens there, the server refused, or it did not answer in time.
        """
        self.close()
        self._received.clear()
        self._texts = MessageAssembler()
        deadline = time.monotonic() + self._connect_timeout_s
        try:
            address = (self._uri.host, self._uri.port)
            self._socket = socket.create_connection(address, timeout=self._connect_timeout_s)
            if self._tls is not None:
                self._socket = self._tls.wrap_socket(self._socket, server_hostname=self._uri.host)
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        except OSError as error:
            self.drop()
            raise BridgeError(f"{self.url}: cannot connect: {error}") from None
        self._web = WebSocketClientProtocol(self._uri, max_size=MAX_MESSAGE_BYTES, logger=_logger)
        request = self._web.connect()
        if self._token is not None:
            request.headers["Authorization"] = f"Bearer {self._token}"
        self._web.send_request(request)
        self._flush()
        while self._web.state is State.CONNECTING and self._web.handshake_exc is None:
            if not self._read(deadline - time.monotonic()):
                self.drop()
                raise BridgeError(f"{self.url}: no answer within {self._connect_timeout_s} s")
        if self._web.handshake_exc is not None:
            reason = self._web.handshake_exc
            self.drop()
            raise BridgeError(f"{self.url}: refused: {reason}")
        for text in self.protocol.wishes():
            self._send(text)

    def close(self) -> None:
        """Say good-bye and close; harmless when not connected."""
        if self._web is not None and self._web.state is State.OPEN:
            try:
                self._web.send_close(1000)
                self._flush()
            except BridgeError:
                pass
        self.drop()

    def advertise(self, topic: str, type_name: str) -> None:
        """Announce that this client publishes `topic`. Errors as `ClientProtocol.advertise`."""
        self._wish(self.protocol.advertise(topic, type_name))

    def unadvertise(self, topic: str) -> None:
        """Withdraw a publisher."""
        self._wish(self.protocol.unadvertise(topic))

    def publish(self, topic: str, message: Any) -> None:
        """Send one message, a dict or an instance of the topic's type.

        Raises:
            BridgeError: not connected, not advertised, or the message does not fit its type.
        """
        self._send(self.protocol.publish(topic, message))

    def subscribe(
        self,
        topic: str,
        type_name: str,
        callback: Callback | None = None,
        throttle_rate: int = 0,
        queue_length: int = 0,
    ) -> None:
        """Ask for a topic; arguments as `ClientProtocol.subscribe`."""
        self._wish(self.protocol.subscribe(topic, type_name, callback, throttle_rate, queue_length))

    def unsubscribe(self, topic: str) -> None:
        """End a subscription."""
        self._wish(self.protocol.unsubscribe(topic))

    def receive(self, timeout_s: float) -> Received | None:
        """Return the next message (topic, message) without a callback, or None after `timeout_s`.

        Callbacks of messages that come before it run inside this call.

        Raises:
            BridgeError: the connection is closed.
        """
        deadline = time.monotonic() + timeout_s
        while not self._received:
            if not self._read(deadline - time.monotonic()):
                return None
        return self._received.popleft()

    def _wish(self, text: bytes) -> None:
        """Send a wish now if connected; otherwise `connect` will."""
        if self.connected:
            self._send(text)

    def _send(self, text: bytes) -> None:
        if self._web is None or self._web.state is not State.OPEN:
            raise BridgeError(f"{self.url}: not connected")
        self._web.send_text(text)
        self._flush()

    def _flush(self) -> None:
        assert self._web is not None
        assert self._socket is not None
        for data in self._web.data_to_send():
            try:
                if data is SEND_EOF and self._tls is not None:
                    continue  # half a TLS connection cannot be closed; the whole one is, in a moment
                if data is SEND_EOF:
                    self._socket.shutdown(socket.SHUT_WR)
                else:
                    self._socket.settimeout(self._connect_timeout_s)
                    self._socket.sendall(data)
            except OSError as error:
                self.drop()
                raise BridgeError(f"{self.url}: connection lost: {error}") from None

    def _read(self, timeout_s: float) -> bool:
        """Wait for data and digest it; False when nothing came in time."""
        if self._web is None or self._socket is None:
            raise BridgeError(f"{self.url}: not connected")
        try:
            self._socket.settimeout(max(timeout_s, 1e-6))
            data = self._socket.recv(RECEIVE_BYTES)
        except TimeoutError:
            return False
        except OSError as error:
            self.drop()
            raise BridgeError(f"{self.url}: connection lost: {error}") from None
        if data:
            self.heard_s = time.monotonic()
            self._web.receive_data(data)
        else:
            self._web.receive_eof()
        web = self._web
        self._digest()
        if self._web is not None:
            self._flush()
        if web.state is State.CLOSED and web.handshake_exc is None:
            self.drop()
            if not self._received:
                raise BridgeError(f"{self.url}: connection closed by the server ({web.close_code})")
        return True

    def _digest(self) -> None:
        assert self._web is not None
        for event in self._web.events_received():
            if isinstance(event, Frame) and is_data(event):
                text = self._texts.add(event)
                received = self.protocol.receive(text) if text is not None else None
                if received is not None:
                    self._received.append(received)

    def ping(self) -> None:
        """Ask the server for a sign of life.

        Raises:
            BridgeError: the connection is lost.
        """
        if self._web is not None and self._web.state is State.OPEN:
            self._web.send_ping(b"")
            self._flush()

    def drop(self) -> None:
        """Close without a word: the other side is gone."""
        if self._socket is not None:
            self._socket.close()
        self._socket = None
        self._web = None
