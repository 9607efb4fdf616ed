"""One WebSocket connection on the owner's own non-blocking socket, by the sans-I/O protocol of websockets."""

import logging
import socket
import ssl
import time
from collections.abc import Callable
from functools import partial
from typing import Final, Protocol

from websockets.frames import CloseCode, Frame
from websockets.http11 import Request
from websockets.protocol import SEND_EOF, State
from websockets.server import ServerProtocol

from simconsole.bridge.protocol.access import Access, Role, message_limit
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.frames import CLOSE, FrameWriter
from simconsole.bridge.protocol.handshake import Admission, Places, Refusal, admit, handshake_request
from simconsole.bridge.transport.connection_checks import ConnectionChecks
from simconsole.bridge.transport.sockets import RECEIVE_BYTES
from simconsole.bridge.transport.whole_frames import take_whole
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import FrameError
from simconsole.values.units import NS_PER_S

UNSENT_BYTES: Final = 262_144
"""Bytes taken out of a session's bounded queues beyond what the system's socket buffer holds."""
_WOULD_BLOCK: Final = (BlockingIOError, InterruptedError, ssl.SSLWantReadError, ssl.SSLWantWriteError)

_logger = logging.getLogger("simconsole.bridge.transport.lockstep_server")


class ConnectionOwner(Protocol):
    """Receives what happens on a connection."""

    @property
    def access(self) -> Access:
        """Who may do what."""

    @property
    def drive(self) -> str | None:
        """The nonce of the drive whose bridge this is."""

    @property
    def places(self) -> Places:
        """What room there is."""

    def connected(self, peer: str, admission: Admission, wake: Callable[[], None]) -> ClientSession:
        """Add a client whose handshake is done; `wake` is called when there is something to send to it."""

    def has_something(self, connection: "LockstepConnection") -> None:
        """Note that there is something to send on a connection."""

    def received(self, session: ClientSession, text: bytes) -> None:
        """Apply a message of a client, `Binary` if it was not text."""


class LockstepConnection:
    """A client of the lockstep bridge, from its first byte to its last."""

    def __init__(self, owner: ConnectionOwner, sock: socket.socket, peer: str, profile: BridgeProfile) -> None:
        """Take over an accepted socket."""
        sock.setblocking(False)
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.socket = sock
        self.peer = peer
        self.session: ClientSession | None = None
        self.closed = False
        self.selected = 0
        """For which of the selector's events its owner waits."""
        self._owner = owner
        self._profile = profile
        self._web = ServerProtocol(max_size=message_limit(Role.NONE, profile.limits), logger=_logger)
        self._writer = FrameWriter()
        self._since_ns = time.monotonic_ns()
        self._checks = ConnectionChecks(profile, self._since_ns)
        self._unsent = bytearray()
        self._ending = False

    @property
    def is_open(self) -> bool:
        """Whether messages can pass."""
        return not self.closed and self._web.state is State.OPEN

    @property
    def waits_to_send(self) -> bool:
        """Whether there is anything to send, now or when its time comes."""
        return bool(self._unsent) or (self.session is not None and self.session.due_ns() is not None)

    @property
    def waits_to_write(self) -> bool:
        """Whether the system took less than it was given."""
        return bool(self._unsent)

    def read(self) -> bool:
        """Read once and process what arrived: the handshake, then messages.

        Returns:
            Whether the protocol itself may have something to send, or the connection has ended.
        """
        try:
            data = self.socket.recv(RECEIVE_BYTES)
            while isinstance(self.socket, ssl.SSLSocket) and self.socket.pending():
                data += self.socket.recv(RECEIVE_BYTES)  # a selector does not see what TLS has read already
        except _WOULD_BLOCK:
            return False
        except OSError:
            self.close()
            return True
        has_ended = not data
        if data:
            self._checks.heard(time.monotonic_ns())
            frames, rest = take_whole(self._web, data)
            for opcode, content in frames:
                if self.session is not None and self._web.state is State.OPEN:
                    self._take(opcode, content, True, self.session)
            if not rest and self._web.state is State.OPEN:
                return False
            if rest:
                self._web.receive_data(rest)
        else:
            self._web.receive_eof()
        self._collect()
        if len(self._unsent) > UNSENT_BYTES + 2 * self._profile.limits.queued_bytes:
            self.close()  # a client that sends pings without end and reads no answer
            return True
        for event in self._web.events_received():
            if isinstance(event, Request):
                self._answer(event)
            elif isinstance(event, Frame) and event.opcode < CLOSE and self.session is not None:
                self._take(event.opcode, bytes(event.data), event.fin, self.session)
        if has_ended or self._web.state is State.CLOSED:
            self.close()
        return True

    def flush(self, now_ns: int) -> None:
        """Frame what waits in the session and send what the socket takes: all of it, or until it takes no more."""
        if self.closed:
            return
        session = self.session
        self._collect()
        if session is None or self._web.state is not State.OPEN:
            self._send()
            return
        while True:
            if self._writer.is_inside or session.due_ns() is not None:
                self._unsent += self._writer.batch(partial(session.next_text, now_ns), UNSENT_BYTES - len(self._unsent))
            if not self._unsent:
                return
            self._send()
            if self.closed or self._unsent:
                return

    def check(self) -> None:
        """Ping a quiet client; close one whose machine is gone."""
        now_ns = time.monotonic_ns()
        if self._web.close_sent is not None:
            reason = self._checks.closing(now_ns)
        else:
            reason = self._checks.check(now_ns, self.socket, self._send_ping)
            tokenless_ns = int(self._profile.limits.tokenless_s * NS_PER_S)
            if self.session is not None and self.session.role is Role.NONE and now_ns - self._since_ns > tokenless_ns:
                reason = "has shown no token"
        if reason is not None:
            self.close()

    def start_closing(self) -> None:
        """Start the closing handshake; a connection that is not open yet is closed at once."""
        if self.is_open:
            self._web.send_close(CloseCode.GOING_AWAY)
            self.flush(0)
        else:
            self.close()

    def close(self) -> None:
        """Close the socket."""
        self.closed = True
        self.socket.close()

    def _send_ping(self) -> None:
        if self.is_open:
            self._web.send_ping(b"")

    def _answer(self, request: Request) -> None:
        asked = handshake_request(request.path, request.headers.get_all)
        decision = admit(asked, self._profile, self._owner.access, self._owner.places, self._owner.drive)
        if isinstance(decision, Refusal):
            response = self._web.reject(decision.status, decision.body)
            for name, value in decision.headers.items():
                response.headers.pop(name, None)
                response.headers[name] = value
            self._web.send_response(response)
            return
        self._web.send_response(self._web.accept(request))
        if self._web.state is State.OPEN:
            self.session = self._owner.connected(self.peer, decision, partial(self._owner.has_something, self))
            self._limit_messages(self.session)

    def _take(self, opcode: int, data: bytes, fin: bool, session: ClientSession) -> None:
        try:
            message = self._checks.assembler.add(opcode, data, fin, time.monotonic_ns())
        except FrameError as error:
            self._web.fail(error.code, str(error))
            return
        if message is not None:
            role = session.role
            self._owner.received(session, message)
            if session.role is not role:
                self._limit_messages(session)

    def _limit_messages(self, session: ClientSession) -> None:
        max_bytes = message_limit(session.role, self._profile.limits)
        self._checks.assembler.max_bytes = self._web.max_message_size = max_bytes

    def _collect(self) -> None:
        for data in self._web.data_to_send():
            if data is SEND_EOF:
                self._ending = True
            else:
                self._unsent += data

    def _send(self) -> None:
        try:
            if self._unsent:
                del self._unsent[: self.socket.send(self._unsent)]
            if self._ending and not self._unsent:
                self._ending = False
                if not isinstance(self.socket, ssl.SSLSocket):  # half a TLS connection cannot be closed
                    self.socket.shutdown(socket.SHUT_WR)
            if self._web.close_rcvd is not None and not self._unsent:
                self.close()  # both have sent close frames: the server closes (RFC 6455, 7.1.1)
        except _WOULD_BLOCK:
            return
        except OSError:
            self.close()
