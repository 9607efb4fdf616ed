"""Clients' connections by the library picows (extra `picows`), at a third of websockets' processor time.

picows reads and masks frames; admission and the limits on frames are those of every transport.
"""

import asyncio
import logging
import socket
import ssl
from collections.abc import Callable
from http import HTTPStatus
from typing import Any, Final

from picows import (
    WSCloseCode,
    WSFrame,
    WSListener,
    WSMsgType,
    WSTransport,
    WSUpgradeRequest,
    WSUpgradeResponse,
    WSUpgradeResponseWithListener,
    ws_create_server,
)

from simconsole.bridge.protocol.frames import (
    CLOSE,
    PING,
    PROTOCOL_ERROR,
    check_close,
)
from simconsole.bridge.protocol.handshake import WEBSOCKET_VERSION, Admission, Refusal, handshake_request
from simconsole.bridge.transport import sockets
from simconsole.bridge.transport.connection_checks import ConnectionChecks
from simconsole.bridge.transport.interface import Acceptor, ConnectionHandler
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import FrameError

RECEIVE_BUFFER_BYTES: Final = 262_144

# The library logs each connection's errors; the bridge logs them itself, and a client's mistake is no error of ours.
_library_logger = logging.getLogger("simconsole.bridge.picows")
_library_logger.setLevel(logging.CRITICAL)


class PicowsConnection(WSListener):
    """A client's connection (`Connection`)."""

    def __init__(self, listener: "PicowsListener", admission: Admission) -> None:
        super().__init__()
        self._listener = listener
        self._admission = admission
        self._clock_ns = listener.clock_ns
        self._pinged: bytes | None = None
        self._paused = False
        self._client: ConnectionHandler | None = None
        self._transport: WSTransport
        """Set when the handshake has ended."""

    @property
    def is_open(self) -> bool:
        """Whether messages can pass, as far as this side knows."""
        transport = self._transport
        return not (transport.is_close_frame_sent or transport.is_disconnected or self._checks.is_closing)

    @property
    def takes_more(self) -> bool:
        """Whether messages may be given."""
        return not self._paused

    def write(self, frames: bytes) -> None:
        """Send frames, all that are given in one system call."""
        self._transport.underlying_transport.write(frames)

    def limit_messages(self, max_bytes: int) -> None:
        """Refuse longer messages of the client from now on; the library has one limit for the frames of all clients."""
        self._checks.assembler.max_bytes = max_bytes

    def pause_reading(self) -> None:
        """Read nothing more of the client."""
        self._transport.underlying_transport.pause_reading()

    def resume_reading(self) -> None:
        """Read on."""
        self._transport.underlying_transport.resume_reading()

    def abort(self) -> None:
        """End the connection at once."""
        self._transport.disconnect(False)

    def check(self, now_ns: int) -> str | None:
        """Ping a quiet client; return why the connection has to be aborted, None while it has not."""
        if not self.is_open:
            return self._checks.closing(now_ns)
        sock: socket.socket = self._transport.underlying_transport.get_extra_info("socket")
        return self._checks.check(now_ns, sock, self._transport.send_ping)

    def start_closing(self) -> None:
        """Start the closing handshake; `check` aborts a client that does not answer."""
        if self.is_open:
            self._transport.send_close(WSCloseCode.GOING_AWAY)

    def on_ws_connected(self, transport: WSTransport) -> None:
        """Add the client."""
        self._transport = transport
        self._checks = ConnectionChecks(self._listener.profile, self._clock_ns())
        host, port = transport.underlying_transport.get_extra_info("peername")[:2]
        self._listener.connections.add(self)
        self._client = self._listener.acceptor.accept(self, f"{host}:{port}", self._admission)

    def on_ws_frame(self, transport: WSTransport, frame: WSFrame) -> None:
        """Take a frame. The library has checked opcode, mask and the length of control frames."""
        now_ns = self._clock_ns()
        self._checks.heard(now_ns)
        kind: int = frame.msg_type.value
        try:
            if frame.rsv1 or frame.rsv2 or frame.rsv3:
                raise FrameError(PROTOCOL_ERROR, "a reserved bit is set: no extension was agreed on")
            if kind < CLOSE:
                if self.is_open and self._client is not None:
                    message = self._checks.assembler.add(kind, frame.get_payload_as_bytes(), bool(frame.fin), now_ns)
                    if message is not None:
                        self._client.receive(message)
            elif kind == CLOSE:
                self._answer_close(frame.get_payload_as_bytes())
            elif kind == PING and self.is_open:
                self._answer_ping(frame.get_payload_as_bytes())
        except FrameError as error:
            self._fail(error)

    def on_ws_disconnected(self, transport: WSTransport) -> None:
        """Note the end of the connection."""
        self._listener.remove(self)
        if self._client is not None:
            self._client.closed()

    def pause_writing(self) -> None:
        """Note that the socket takes no more."""
        self._paused = True

    def resume_writing(self) -> None:
        """Continue sending: the socket takes more."""
        self._paused = False
        if self._pinged is not None and self.is_open:
            self._transport.send_pong(self._pinged)
        self._pinged = None
        if self._client is not None:
            self._client.resume()

    def _fail(self, error: FrameError) -> None:
        """Send a close frame with the reason and half-close; what still comes is ignored."""
        if not self.is_open:
            return
        self._transport.send_close(WSCloseCode(error.code), str(error))
        transport = self._transport.underlying_transport
        if transport.can_write_eof():  # half a TLS connection cannot be closed
            transport.write_eof()

    def _answer_ping(self, data: bytes) -> None:
        """Answer with a pong; while the socket takes no more, only remember the latest ping (5.5.3)."""
        if self._paused:
            self._pinged = data
        else:
            self._transport.send_pong(data)

    def _answer_close(self, data: bytes) -> None:
        check_close(data)
        if self.is_open:
            self._transport.send(WSMsgType.CLOSE, data[:2])
        self._checks.closing(self._clock_ns())
        self._transport.disconnect()  # both have sent close frames: the server closes (RFC 6455, 7.1.1)


class PicowsListener:
    """A server that listens (`Listener`)."""

    def __init__(self, acceptor: Acceptor, profile: BridgeProfile, clock_ns: Callable[[], int]) -> None:
        self.acceptor = acceptor
        self.profile = profile
        self.clock_ns = clock_ns
        self.connections: set[PicowsConnection] = set()
        self._server: Any = None
        self._empty = asyncio.Event()

    async def listen(self, sock: socket.socket, tls: ssl.SSLContext | None) -> None:
        """Listen on `sock`."""
        # The library reads all that waits in one piece, and its buffer grows to that; left to itself the system lets
        # megabytes wait. Connections inherit it.
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, RECEIVE_BUFFER_BYTES)
        self._server = await ws_create_server(
            self._open,
            sock=sock,
            websocket_handshake_timeout=sockets.HANDSHAKE_S,
            enable_auto_pong=False,  # or a client that sends pings and reads no answer could not be stopped
            max_frame_size=self.profile.limits.message_bytes,
            logger_name=_library_logger,
            **sockets.tls_options(tls),
        )

    def close(self) -> None:
        """Stop accepting; close clients."""
        self._server.close()
        for connection in list(self.connections):
            connection.start_closing()
        self.remove()

    async def wait_closed(self) -> None:
        """Return when all connections have ended."""
        await self._empty.wait()

    def remove(self, connection: PicowsConnection | None = None) -> None:
        """Remove a connection that has ended."""
        self.connections.discard(connection)
        if not self.connections and not self._server.is_serving():
            self._empty.set()

    def _open(self, request: WSUpgradeRequest) -> WSUpgradeResponseWithListener:
        headers = request.headers
        path = request.path.decode("ascii", "surrogateescape")
        decision = self.acceptor.admit(handshake_request(path, lambda name: headers.getall(name, ())))
        if isinstance(decision, Refusal):
            return _refused(decision)
        if not self._server.is_serving():
            return _refused(Refusal(HTTPStatus.SERVICE_UNAVAILABLE, "this server is closing"))
        # The library reads no list here (Firefox sends keep-alive, Upgrade), and takes versions that never were.
        connection = ",".join(headers.getall("Connection", ()))
        if "upgrade" in (word.strip().lower() for word in connection.split(",")):
            headers["Connection"] = "upgrade"
        if headers.get("Sec-WebSocket-Version") != WEBSOCKET_VERSION:
            reason = f"this server speaks WebSocket version {WEBSOCKET_VERSION}"
            return _refused(Refusal(HTTPStatus.UPGRADE_REQUIRED, reason))
        return WSUpgradeResponseWithListener(WSUpgradeResponse.create_101_response(), PicowsConnection(self, decision))


def _refused(refusal: Refusal) -> WSUpgradeResponseWithListener:
    error = max(refusal.status, HTTPStatus.BAD_REQUEST)  # the library makes no other answer than an error
    response = WSUpgradeResponse.create_error_response(error, refusal.body.encode(), refusal.headers)
    response.status = refusal.status
    return WSUpgradeResponseWithListener(response, None)


async def start_listener(
    acceptor: Acceptor,
    sock: socket.socket,
    profile: BridgeProfile,
    tls: ssl.SSLContext | None,
    clock_ns: Callable[[], int],
) -> PicowsListener:
    """Listen on `sock`."""
    listener = PicowsListener(acceptor, profile, clock_ns)
    await listener.listen(sock, tls)
    return listener
