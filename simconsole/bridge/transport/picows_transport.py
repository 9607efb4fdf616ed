"""Clients' connections by the library picows (extra `picows`): the same clients for a third of the time (shell).

picows reads and masks frames; what may be in them and in the first request is decided where websockets' is.
"""

import asyncio
import logging
import socket
import ssl
from collections.abc import Callable, Sequence
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

from simconsole.bridge.protocol.backoff import Liveness
from simconsole.bridge.protocol.frames import (
    CLOSE,
    PING,
    PROTOCOL_ERROR,
    MessageAssembler,
    check_close,
    frame_head,
)
from simconsole.bridge.protocol.handshake import DRIVE_HEADER, Admission, Opening, Refusal
from simconsole.bridge.transport import sockets
from simconsole.bridge.transport.interface import Client, House
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import FrameError
from simconsole.values.units import NS_PER_S

_VERSION: Final = "13"

# What it logs of each connection is logged here, and a client's mistake is no error of ours.
_library_logger = logging.getLogger("simconsole.bridge.picows")
_library_logger.setLevel(logging.CRITICAL)


class Connection(WSListener):
    """A client's connection (`Transport`)."""

    def __init__(self, door: "PicowsDoor", admission: Admission) -> None:
        super().__init__()
        self._door = door
        self._admission = admission
        self._clock_ns = door.clock_ns
        limits = door.profile.limits
        self._assembler = MessageAssembler(limits.message_bytes, limits.message_fragments)
        self._liveness = Liveness(door.profile.ping_interval_s, door.profile.dead_after_s)
        self._pinged: bytes | None = None
        self._closing_since_ns: int | None = None
        self._paused = False
        self._client: Client | None = None
        self._link: WSTransport
        """From the handshake's end on; nobody knows of this connection before."""

    @property
    def is_open(self) -> bool:
        """Whether messages can pass, as far as this side knows."""
        link = self._link
        return not (link.is_close_frame_sent or link.is_disconnected or self._closing_since_ns is not None)

    @property
    def takes_more(self) -> bool:
        """Whether messages may be given."""
        return not self._paused

    def put(self, messages: Sequence[bytes]) -> None:
        """Send messages, all that are given in one system call."""
        frames = b"".join(part for message in messages for part in (frame_head(message), message))
        self._link.underlying_transport.write(frames)

    def abort(self) -> None:
        """End the connection at once."""
        self._link.disconnect(False)

    def look(self, now_ns: int) -> str | None:
        """Ask a quiet client for a sign of life; return why the connection has to be cut, None while it has not."""
        if not self.is_open:
            self._closing_since_ns = self._closing_since_ns or now_ns
            return "does not close" if now_ns - self._closing_since_ns > sockets.CLOSE_S * NS_PER_S else None
        overdue = self._assembler.overdue(now_ns)
        if overdue is not None:
            return f"sends too slowly: {overdue}"
        now_s = now_ns / NS_PER_S
        # A program that is slow to answer is not a machine that is gone, which acknowledges nothing either.
        if self._liveness.is_dead(now_s) and sockets.is_unacknowledged(self._socket()):
            return f"has been gone for {self._door.profile.dead_after_s:g} s"
        if self._liveness.ping_due(now_s):
            self._link.send_ping()
        return None

    def say_good_bye(self) -> None:
        """Begin to close in the WebSocket's own way; `look` cuts who does not answer."""
        if self.is_open:
            self._link.send_close(WSCloseCode.GOING_AWAY)

    def on_ws_connected(self, transport: WSTransport) -> None:
        """Take the client in."""
        self._link = transport
        self._liveness.begin(self._clock_ns() / NS_PER_S)
        host, port = transport.underlying_transport.get_extra_info("peername")[:2]
        self._door.connections.add(self)
        self._client = self._door.house.welcome(self, f"{host}:{port}", self._admission)

    def on_ws_frame(self, transport: WSTransport, frame: WSFrame) -> None:
        """Take a frame. The library has checked opcode, mask and the length of control frames."""
        now_ns = self._clock_ns()
        self._liveness.heard(now_ns / NS_PER_S)
        kind: int = frame.msg_type.value
        try:
            if frame.rsv1 or frame.rsv2 or frame.rsv3:
                raise FrameError(PROTOCOL_ERROR, "a reserved bit is set: no extension was agreed on")
            if kind < CLOSE:
                if self.is_open and self._client is not None:
                    message = self._assembler.add(kind, frame.get_payload_as_bytes(), bool(frame.fin), now_ns)
                    if message is not None:
                        self._client.receive(message)
            elif kind == CLOSE:
                self._answer_close(frame.get_payload_as_bytes())
            elif kind == PING and self.is_open:
                self._answer_ping(frame.get_payload_as_bytes())
        except FrameError as error:
            self._fail(error)

    def on_ws_disconnected(self, transport: WSTransport) -> None:
        """Tell the client that it is gone."""
        self._door.leave(self)
        if self._client is not None:
            self._client.gone()

    def pause_writing(self) -> None:
        """Note that the system takes no more."""
        self._paused = True

    def resume_writing(self) -> None:
        """Let the client's messages flow again."""
        self._paused = False
        if self._pinged is not None and self.is_open:
            self._link.send_pong(self._pinged)
        self._pinged = None
        if self._client is not None:
            self._client.resume()

    def _fail(self, error: FrameError) -> None:
        """Say why it ends and half-close; what still comes is passed over."""
        if not self.is_open:
            return
        self._link.send_close(WSCloseCode(error.code), str(error))
        link = self._link.underlying_transport
        if link.can_write_eof():  # half a TLS connection cannot be closed
            link.write_eof()

    def _answer_ping(self, data: bytes) -> None:
        """Answer, or while the system takes no more remember the latest: only that needs an answer (5.5.3)."""
        if self._paused:
            self._pinged = data
        else:
            self._link.send_pong(data)

    def _answer_close(self, data: bytes) -> None:
        check_close(data)
        if self.is_open:
            self._link.send(WSMsgType.CLOSE, data[:2])
        self._closing_since_ns = self._clock_ns()
        self._link.disconnect()  # both have said good-bye: the server ends the connection (RFC 6455, 7.1.1)

    def _socket(self) -> socket.socket:
        found: socket.socket = self._link.underlying_transport.get_extra_info("socket")
        return found


class PicowsDoor:
    """A server that listens (`Door`)."""

    def __init__(self, house: House, profile: BridgeProfile, clock_ns: Callable[[], int]) -> None:
        self.house = house
        self.profile = profile
        self.clock_ns = clock_ns
        self.connections: set[Connection] = set()
        self._server: Any = None
        self._empty = asyncio.Event()

    async def listen(self, listener: socket.socket, tls: ssl.SSLContext | None) -> None:
        """Let clients of `listener` in."""
        # The library reads all that waits in one piece, and its buffer grows to that; left to itself the system lets
        # megabytes wait. Connections inherit it.
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, self.profile.limits.message_bytes)
        options: dict[str, Any] = {} if tls is None else {"ssl": tls, "ssl_handshake_timeout": sockets.HANDSHAKE_S}
        self._server = await ws_create_server(
            self._open,
            sock=listener,
            websocket_handshake_timeout=sockets.HANDSHAKE_S,
            enable_auto_pong=False,  # or nobody would stop who sends pings and reads no answer
            max_frame_size=self.profile.limits.message_bytes,
            logger_name=_library_logger,
            **options,
        )

    def close(self) -> None:
        """Let nobody in any more and say good-bye to who is there."""
        self._server.close()
        for connection in list(self.connections):
            connection.say_good_bye()
        self.leave()

    async def wait_closed(self) -> None:
        """Return when everybody has gone."""
        await self._empty.wait()

    def leave(self, connection: Connection | None = None) -> None:
        """Forget a connection that has ended."""
        self.connections.discard(connection)
        if not self.connections and not self._server.is_serving():
            self._empty.set()

    def _open(self, request: WSUpgradeRequest) -> WSUpgradeResponseWithListener:
        headers = request.headers
        decision = self.house.admit(
            Opening(
                request.path.decode("ascii", "surrogateescape"),
                headers.getall("Host", ()),
                headers.getall("Origin", ()),
                headers.getall("Authorization", ()),
                headers.getall(DRIVE_HEADER, ()),
            )
        )
        if isinstance(decision, Refusal):
            return _refused(decision.status, decision.reason)
        if not self._server.is_serving():
            return _refused(503, "this server is closing")
        # The library reads no list here (Firefox sends keep-alive, Upgrade), and takes versions that never were.
        connection = ",".join(headers.getall("Connection", ()))
        if "upgrade" in (word.strip().lower() for word in connection.split(",")):
            headers["Connection"] = "upgrade"
        if headers.get("Sec-WebSocket-Version") != _VERSION:
            return _refused(426, f"this server speaks WebSocket version {_VERSION}")
        return WSUpgradeResponseWithListener(WSUpgradeResponse.create_101_response(), Connection(self, decision))


def _refused(status: int, reason: str) -> WSUpgradeResponseWithListener:
    more = {"Upgrade": "websocket", "Sec-WebSocket-Version": _VERSION} if status == 426 else {}
    return WSUpgradeResponseWithListener(
        WSUpgradeResponse.create_error_response(status, f"{reason}\n".encode(), more), None
    )


async def open_door(
    house: House,
    listener: socket.socket,
    profile: BridgeProfile,
    tls: ssl.SSLContext | None,
    clock_ns: Callable[[], int],
) -> PicowsDoor:
    """Let clients of `listener` into `house`."""
    door = PicowsDoor(house, profile, clock_ns)
    await door.listen(listener, tls)
    return door
