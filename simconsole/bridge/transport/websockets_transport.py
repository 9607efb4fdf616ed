"""Clients' connections by the library websockets, with limits on silence, fragments and floods."""

import logging
import socket
import ssl
from collections.abc import Callable
from functools import partial
from typing import Any

from websockets.asyncio.server import Server, ServerConnection
from websockets.asyncio.server import serve as serve_websockets
from websockets.frames import Frame
from websockets.http11 import Request, Response
from websockets.protocol import State

from simconsole.bridge.protocol.access import Role, message_limit
from simconsole.bridge.protocol.frames import CLOSE, FRAME_BYTES
from simconsole.bridge.protocol.handshake import Admission, Refusal, handshake_request
from simconsole.bridge.transport import sockets
from simconsole.bridge.transport.connection_checks import ConnectionChecks
from simconsole.bridge.transport.interface import Acceptor, ConnectionHandler
from simconsole.bridge.transport.whole_frames import take_whole
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import FrameError

_logger = logging.getLogger("simconsole.bridge.transport.server")


class WebsocketsConnection(ServerConnection):
    """A client's connection that passes messages on as they are read (`Connection`)."""

    def __init__(self, profile: BridgeProfile, clock_ns: Callable[[], int], *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.admission: Admission | None = None
        self.client: ConnectionHandler | None = None
        self._early: list[bytes] = []
        self._has_failed = False
        self._checks = ConnectionChecks(profile, clock_ns())
        self._clock_ns = clock_ns
        # More than the sender, which waits for the socket between two messages, can have put there.
        self._max_unsent_bytes = 2 * (profile.limits.queued_bytes + FRAME_BYTES)

    @property
    def is_open(self) -> bool:
        """Whether messages can pass, as far as this side knows."""
        return self.protocol.state is State.OPEN

    @property
    def takes_more(self) -> bool:
        """Whether messages may be given."""
        return not self.paused

    def write(self, frames: bytes) -> None:
        """Send frames.

        They are written past the library, whose sending costs more than all the rest (decision 8); it still
        writes pings, pongs and close frames, between them.
        """
        self.transport.write(frames)

    def limit_messages(self, max_bytes: int) -> None:
        """Refuse longer messages of the client from now on."""
        self._checks.assembler.max_bytes = self.protocol.max_message_size = max_bytes

    def pause_reading(self) -> None:
        """Read nothing more of the client."""
        self.transport.pause_reading()

    def resume_reading(self) -> None:
        """Read on."""
        self.transport.resume_reading()

    def abort(self) -> None:
        """End the connection at once."""
        self.transport.abort()

    def check(self, now_ns: int) -> str | None:
        """Ping a quiet client; return why the connection has to be aborted, None while it has not."""
        if not self.is_open:
            return self._checks.closing(now_ns)
        return self._checks.check(now_ns, self.transport.get_extra_info("socket"), self._send_ping)

    def _send_ping(self) -> None:
        self.protocol.send_ping(b"")
        self.send_data()

    def begin(self, client: ConnectionHandler) -> None:
        """Hand messages on from now on, those first that came while the handshake was being finished."""
        self.client = client
        for message in self._early:
            client.receive(message)
        self._early.clear()
        self.transport.resume_reading()

    def data_received(self, data: bytes) -> None:
        """Note the time of everything that arrives, pongs too; take what needs the library's parser through it."""
        now_ns = self._clock_ns()
        self._checks.heard(now_ns)
        frames, data = take_whole(self.protocol, data)
        for opcode, content in frames:
            self._take(opcode, content, True, now_ns)
        if frames and not data:
            return
        super().data_received(data)
        if self.protocol.close_rcvd is not None:
            self.transport.close()  # both have sent close frames: the server closes (RFC 6455, 7.1.1)
        if self.transport.get_write_buffer_size() > self._max_unsent_bytes:
            self.transport.abort()  # a client that sends pings without end and reads no answer

    def process_event(self, event: Any) -> None:
        """Join frames here and now: the library's queue and its reader would cost as much as reading them."""
        if not isinstance(event, Frame) or event.opcode >= CLOSE:
            super().process_event(event)
        else:
            self._take(event.opcode, bytes(event.data), event.fin, self._clock_ns())

    def _take(self, opcode: int, data: bytes, fin: bool, now_ns: int) -> None:
        if self._has_failed:
            return
        try:
            message = self._checks.assembler.add(opcode, data, fin, now_ns)
        except FrameError as error:
            self._has_failed = True
            self.protocol.fail(error.code, str(error))
            self.send_data()
            return
        if message is None:
            return
        if self.client is not None:
            self.client.receive(message)
        else:
            self._early.append(message)
            self.transport.pause_reading()  # until the handshake is finished

    def resume_writing(self) -> None:
        """Continue sending: the socket takes more."""
        super().resume_writing()
        if self.client is not None:
            self.client.resume()


async def start_listener(
    acceptor: Acceptor,
    sock: socket.socket,
    profile: BridgeProfile,
    tls: ssl.SSLContext | None,
    clock_ns: Callable[[], int],
) -> Server:
    """Listen on `sock`."""
    make: Any = partial(WebsocketsConnection, profile, clock_ns)  # any function will do; its type says a class

    def admit(connection: ServerConnection, request: Request) -> Response | None:
        """Return the refusal of a handshake, None to let the client in."""
        assert isinstance(connection, WebsocketsConnection)
        decision = acceptor.admit(handshake_request(request.path, request.headers.get_all))
        if isinstance(decision, Refusal):
            response = connection.respond(decision.status, decision.body)
            for name, value in decision.headers.items():
                response.headers.pop(name, None)  # else a second line: the library has given a type itself
                response.headers[name] = value
            return response
        connection.admission = decision
        return None

    async def attend(connection: ServerConnection) -> None:
        """Serve a client until its connection ends."""
        assert isinstance(connection, WebsocketsConnection)
        assert connection.admission is not None
        connection.transport.get_extra_info("socket").setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        host, port = connection.remote_address[:2]
        client = acceptor.accept(connection, f"{host}:{port}", connection.admission)
        try:
            connection.begin(client)
            await connection.wait_closed()
        finally:
            client.closed()

    return await serve_websockets(
        attend,
        sock=sock,
        process_request=admit,
        create_connection=make,
        compression=None,
        max_size=message_limit(Role.NONE, profile.limits),
        ping_interval=None,  # `check` pings, and does not abort clients that are merely slow
        open_timeout=sockets.HANDSHAKE_S,
        close_timeout=sockets.CLOSE_S,
        server_header=None,
        logger=_logger,
        **sockets.tls_options(tls),
    )
