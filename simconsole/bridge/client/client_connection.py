"""One WebSocket connection of a client: a socket, no thread, no event loop."""

import logging
import socket
import ssl
import time
from contextlib import suppress
from http import HTTPStatus
from typing import Final

from websockets.client import ClientProtocol as WebSocketClientProtocol
from websockets.exceptions import InvalidStatus, InvalidURI
from websockets.frames import Frame
from websockets.protocol import SEND_EOF, State
from websockets.uri import parse_uri

from simconsole.bridge.protocol.frames import CLOSE, MessageAssembler
from simconsole.bridge.protocol.handshake import DRIVE_HEADER
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.transport import sockets
from simconsole.bridge.transport.whole_frames import masked_frame, take_whole
from simconsole.values.errors import BridgeError, OtherDriveError

MAX_MESSAGE_BYTES: Final = 16_777_216
ABNORMAL: Final = 1006
"""WebSocket's close code of a connection that ended without one."""

_logger = logging.getLogger("simconsole.bridge.client.bridge_client")


class ClientConnection:
    """A connection that can be opened again and again. Nothing is sent, received or noticed but within a call."""

    def __init__(
        self, url: str, timeout_s: float, token: str | None, certificate: str | None, drive: str | None = None
    ) -> None:
        """Remember where to connect.

        Args:
            url: ws://HOST:PORT or wss://HOST:PORT.
            timeout_s: how long opening, and one sending, may take.
            token: shown to the server at once.
            certificate: a PEM file that a wss:// server is checked against, in place of the system's authorities.
            drive: the nonce of the drive that has started this program, shown to the server.

        Raises:
            BridgeError: `url` is not such an address, or the certificate cannot be read.
        """
        try:
            self._uri = parse_uri(url)
        except InvalidURI as error:
            raise BridgeError(f"url: {error}") from None
        self._tls: ssl.SSLContext | None = None
        if self._uri.secure:
            try:
                self._tls = ssl.create_default_context(cafile=certificate)
            except OSError as error:
                raise BridgeError(f"certificate: {certificate}: {error}") from None
        self.url = url
        self._timeout_s = timeout_s
        self._token = token
        self._drive = drive
        self._socket: socket.socket | None = None
        self._web: WebSocketClientProtocol | None = None
        self._messages = MessageAssembler(MAX_MESSAGE_BYTES)
        self._early: list[bytes] = []  # what came together with the answer to the handshake
        self.heard_s = 0.0
        """When something last arrived, on the monotonic clock."""
        self.close_code: int | None = None
        """The server's last close code; None without one."""

    @property
    def is_open(self) -> bool:
        """Whether messages can pass, as far as this side knows."""
        return self._web is not None and self._web.state is State.OPEN

    @property
    def is_unacknowledged(self) -> bool:
        """Whether not even the server's system answers, as `sockets.is_unacknowledged`; True when not connected."""
        return self._socket is None or sockets.is_unacknowledged(self._socket)

    def open(self) -> None:
        """Connect.

        Raises:
            BridgeError: nobody listens there, the server refused, or it did not answer in time.
            OtherDriveError: the server belongs to another drive.
        """
        self._messages = MessageAssembler(MAX_MESSAGE_BYTES)
        self._early.clear()
        self.close_code = None
        deadline_s = time.monotonic() + self._timeout_s
        try:
            address = (self._uri.host, self._uri.port)
            self._socket = socket.create_connection(address, timeout=self._timeout_s)
            if self._tls is not None:
                self._socket = self._tls.wrap_socket(self._socket, server_hostname=self._uri.host)
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        except OSError as error:
            self.abort()
            raise BridgeError(f"{self.url}: cannot connect: {error}") from None
        self._web = WebSocketClientProtocol(self._uri, max_size=MAX_MESSAGE_BYTES, logger=_logger)
        request = self._web.connect()
        if self._token is not None:
            request.headers["Authorization"] = f"Bearer {self._token}"
        if self._drive is not None:
            request.headers[DRIVE_HEADER] = self._drive
        self._web.send_request(request)
        self._flush()
        web = self._web
        while web.state is State.CONNECTING and web.handshake_exc is None:
            early = self.read(deadline_s - time.monotonic())
            if early is None:
                self.abort()
                raise BridgeError(f"{self.url}: no answer within {self._timeout_s} s")
            self._early += early
        if web.handshake_exc is not None:
            self.abort()
            raise self._refusal(web.handshake_exc)

    def _refusal(self, why: Exception) -> BridgeError:
        """Return what to raise where the server turned this client away."""
        if not isinstance(why, InvalidStatus):
            return BridgeError(f"{self.url}: refused: {why}")
        response = why.response
        said = (response.body or b"").decode("utf-8", "replace").strip()
        text = f"{self.url}: refused: {why}{f', {said}' if said else ''}"
        of_drive = self._drive is not None and response.status_code == HTTPStatus.FORBIDDEN
        return OtherDriveError(text) if of_drive else BridgeError(text)

    def send(self, *messages: bytes) -> None:
        """Send messages, each `Binary` or text, all at once.

        Raises:
            BridgeError: not connected, or the connection is lost.
        """
        if self._web is None or self._web.state is not State.OPEN:
            raise BridgeError(f"{self.url}: not connected")
        frames = b""
        for message in messages:
            frames += masked_frame(message) or self._framed(message)
        self._send(frames)

    def _framed(self, message: bytes) -> bytes:
        """Return the frame of a long message."""
        assert self._web is not None
        if isinstance(message, Binary):
            self._web.send_binary(message)
        else:
            self._web.send_text(message)
        return b"".join(self._web.data_to_send())

    def ping(self) -> None:
        """Ping the server. Raises BridgeError: the connection is lost."""
        if self._web is not None and self._web.state is State.OPEN:
            self._web.send_ping(b"")
            self._flush()

    def read(self, timeout_s: float) -> list[bytes] | None:
        """Wait for data; return the messages that it completes, None when no data came in time.

        Raises:
            BridgeError: not connected, or the connection is lost; messages that came before were returned.
        """
        if self._web is None or self._socket is None:
            raise BridgeError(f"{self.url}: not connected")
        if self._early:
            early, self._early = self._early, []
            return early
        web = self._web
        try:
            self._socket.settimeout(max(timeout_s, 1e-6))
            data = self._socket.recv(sockets.RECEIVE_BYTES)
        except TimeoutError:
            return None
        except OSError as error:
            self.abort()
            raise BridgeError(f"{self.url}: connection lost: {error}") from None
        messages: list[bytes] = []
        if data:
            self.heard_s = time.monotonic()
            frames, data = take_whole(web, data)
            for opcode, content in frames:
                self._add(opcode, content, True, messages)
            if not data:
                return messages
            web.receive_data(data)
        else:
            web.receive_eof()
        for event in web.events_received():
            if isinstance(event, Frame) and event.opcode < CLOSE:
                self._add(event.opcode, bytes(event.data), event.fin, messages)
        if web.close_rcvd is not None:
            self.close_code = web.close_rcvd.code
        self._flush()
        if web.state is State.CLOSED and web.handshake_exc is None:
            self.abort()
            if not messages:
                raise BridgeError(f"{self.url}: connection closed by the server ({self.close_code or ABNORMAL})")
        return messages

    def _add(self, opcode: int, data: bytes, fin: bool, messages: list[bytes]) -> None:
        whole = self._messages.add(opcode, data, fin, 0)
        if whole is not None:
            messages.append(whole)

    def close(self) -> None:
        """Send a close frame and close; harmless when not connected."""
        if self._web is not None and self._web.state is State.OPEN:
            try:
                self._web.send_close(1000)
                self._flush()
            except BridgeError:
                pass
        self.abort()

    def abort(self) -> None:
        """Close the socket without a close frame: the other side is gone."""
        if self._socket is not None:
            self._socket.close()
        self._socket = None
        self._web = None

    def _flush(self) -> None:
        assert self._web is not None
        for data in self._web.data_to_send():
            if data is SEND_EOF and self._tls is not None:
                continue  # half a TLS connection cannot be closed; the whole one is, in a moment
            self._send(data)

    def _send(self, data: bytes) -> None:
        assert self._socket is not None
        try:
            if data is SEND_EOF:
                self._socket.shutdown(socket.SHUT_WR)
            else:
                self._socket.settimeout(self._timeout_s)
                self._socket.sendall(data)
        except OSError as error:
            self._hear_the_end()
            self.abort()
            raise BridgeError(f"{self.url}: connection lost: {error}") from None

    def _hear_the_end(self) -> None:
        """Read what came before a connection was lost: a server that has said good-bye waits half a second only."""
        assert self._socket is not None
        assert self._web is not None
        with suppress(OSError):
            self._socket.setblocking(False)
            while data := self._socket.recv(sockets.RECEIVE_BYTES):
                self._web.receive_data(data)
        if self._web.close_rcvd is not None:
            self.close_code = self._web.close_rcvd.code
