"""One client of a server in an event loop: its messages in fair turns, and what waits for it while it takes more.

A client that reads nothing holds up nobody: its queues are bounded, and the loop serves the others.
"""

import asyncio
import logging
from collections.abc import Callable
from functools import partial
from typing import Final, Protocol

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.protocol.access import message_limit
from simconsole.bridge.protocol.frames import FrameWriter
from simconsole.bridge.protocol.handshake import Admission
from simconsole.bridge.protocol.rate_limiter import ByteMeter
from simconsole.bridge.protocol.turns import Inbox, Turns
from simconsole.bridge.transport.client_log import log_outcome
from simconsole.bridge.transport.interface import Connection
from simconsole.values.units import NS_PER_S

_WRITE_BYTES: Final = 32_768
_BATCH_PER_CLIENT: Final = 3
"""Messages for each client there is that one may have waiting before they are sent: with few clients soon, so that the
reader works while we do; with many in larger batches, for the processor is busy in any case, and system calls cost."""
_NOT_LOGGED: Final = ("done", "command")
"""What becomes of most messages, and is not logged."""

_logger = logging.getLogger("simconsole.bridge.transport.server")


class ClientTurns:
    """The turns of a server's clients, in its event loop."""

    def __init__(self, clock_ns: Callable[[], int]) -> None:
        self.clock_ns = clock_ns
        self.batch_messages = 0
        """As many may wait for one client before they are sent."""
        self._turns = Turns()
        self._paused: set[ClientHandler] = set()
        self._due: asyncio.Handle | None = None
        self._is_soon = False

    def receive(self, client: "ClientHandler", message: bytes) -> None:
        """Handle a message now or in a later turn; read no more of a client of whom much waits."""
        if self._turns.receive(client.inbox, message, self.clock_ns()):
            return
        if not self._is_soon:
            self._schedule(0)
        if client.inbox.is_full and client not in self._paused:
            self._paused.add(client)
            client.connection.pause_reading()

    def join(self) -> None:
        """Count a client more."""
        self.batch_messages += _BATCH_PER_CLIENT

    def leave(self, client: "ClientHandler") -> None:
        """Forget a client."""
        self.batch_messages -= _BATCH_PER_CLIENT
        self._paused.discard(client)
        self._turns.leave(client.inbox, self.clock_ns())

    def _schedule(self, due_ns: int) -> None:
        if self._due is not None:
            self._due.cancel()
        self._is_soon = due_ns == 0
        loop = asyncio.get_running_loop()
        if self._is_soon:
            self._due = loop.call_soon(self._run)
        else:
            self._due = loop.call_later(max(0, due_ns - self.clock_ns()) / NS_PER_S, self._run)

    def _run(self) -> None:
        self._due, self._is_soon = None, False
        due_ns = self._turns.run(self.clock_ns())
        for client in [client for client in self._paused if not client.inbox.messages]:
            self._paused.discard(client)
            client.connection.resume_reading()
        if due_ns is not None:
            self._schedule(due_ns)


class Server(Protocol):
    """What a client needs of its server."""

    console: ConsoleBridge
    turns: ClientTurns

    def remove(self, client: "ClientHandler") -> None:
        """Forget a client whose connection has ended."""


class ClientHandler:
    """One client (`ConnectionHandler`)."""

    def __init__(self, server: Server, connection: Connection, peer: str, admission: Admission) -> None:
        self.connection = connection
        self.stalled_since_ns: int | None = None
        self._server = server
        self._turns = server.turns
        self._turns.join()
        router = server.console.router
        self._receive = router.receive
        self._limits = server.console.profile.limits
        self._clock_ns = server.turns.clock_ns
        self._loop = asyncio.get_running_loop()
        self._is_woken = False
        self._queued = 0
        self._timer: asyncio.TimerHandle | None = None
        self._writer = FrameWriter()
        self.session = router.connect(peer, self._wake, admission.dialect, admission.role)
        self.session.has_token = admission.has_token
        self.since_ns = self._clock_ns()
        self.inbox = Inbox(self._apply, ByteMeter(self._limits.answered_bytes_per_s))
        self._role = admission.role
        connection.limit_messages(message_limit(self._role, self._limits))

    def receive(self, message: bytes) -> None:
        """Take a message."""
        self._turns.receive(self, message)

    def resume(self) -> None:
        """Continue sending."""
        self.stalled_since_ns = None
        self._wake()

    def closed(self) -> None:
        """Remove the client from the server."""
        self._turns.leave(self)
        if self._timer is not None:
            self._timer.cancel()
        self._server.remove(self)

    def _apply(self, message: bytes, now_ns: int) -> int:
        session = self.session
        before = session.send_queue.answered_bytes
        outcome = self._receive(session, message, now_ns)
        if outcome.kind not in _NOT_LOGGED:
            log_outcome(_logger, session, outcome)
        if session.role is not self._role:
            self._role = session.role
            self.connection.limit_messages(message_limit(self._role, self._limits))
        return session.send_queue.answered_bytes - before

    def _wake(self) -> None:
        """Send what is queued by the loop's next turn in one piece; many messages are sent at once."""
        self._queued += 1
        if self._queued >= self._turns.batch_messages:
            self._send()
        elif not self._is_woken:
            self._is_woken = True
            self._loop.call_soon(self._send_rest)

    def _send_rest(self) -> None:
        self._is_woken = False
        self._send()

    def _send(self) -> None:
        """Send one batch; what is left has to wait for the loop's next turn, behind the other clients."""
        self._queued = 0
        connection, now_ns = self.connection, self._clock_ns()
        if not connection.is_open or not connection.takes_more:
            return
        frames = self._writer.batch(partial(self.session.next_text, now_ns), _WRITE_BYTES)
        if frames:
            connection.write(frames)
        if not connection.takes_more:
            self.stalled_since_ns = now_ns
        elif len(frames) < _WRITE_BYTES:
            due_ns = self.session.due_ns()
            if due_ns is not None:
                self._set_timer(due_ns, now_ns)
        elif not self._is_woken:
            self._is_woken = True
            self._loop.call_soon(self._send_rest)

    def _set_timer(self, due_ns: int, now_ns: int) -> None:
        """Wake up when the first throttled message is due, whether or not more is published until then."""
        if self._timer is not None:
            self._timer.cancel()
        self._timer = self._loop.call_later(max(0, due_ns - now_ns) / NS_PER_S, self._wake)
