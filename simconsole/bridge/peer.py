"""A client's connection as the server keeps it: the library's, with an eye on silence, fragments and floods (shell)."""

from collections.abc import AsyncIterator, Callable, Sequence
from typing import Any, Final

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode, Frame
from websockets.protocol import State

from simconsole.bridge.backoff import Liveness
from simconsole.bridge.documents import Binary
from simconsole.bridge.wire import FragmentLimit, frame_head, is_unacknowledged
from simconsole.profiles.bridge import BridgeProfile
from simconsole.units import NS_PER_S

CLOSE_S: Final = 1.0
"""How long a client may take to answer a good-bye."""


class Peer(ServerConnection):
    """A connection that knows when it last heard something and counts the frames a message is in (a `Transport`)."""

    def __init__(self, profile: BridgeProfile, clock_ns: Callable[[], int], *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.limit = FragmentLimit(profile.limits.message_fragments)
        self.liveness = Liveness(profile.ping_interval_s, profile.dead_after_s)
        self.liveness.begin(clock_ns() / NS_PER_S)
        self._clock_ns = clock_ns
        self._closing_since_ns: int | None = None
        self._dead_after_s = profile.dead_after_s
        # More than the sender, which waits for the socket between two messages, can have put there.
        self._max_unsent_bytes = 2 * profile.limits.queued_bytes

    @property
    def is_open(self) -> bool:
        """Whether messages can pass, as far as this side knows."""
        return self.state is State.OPEN

    async def messages(self) -> AsyncIterator[bytes]:
        """Yield each message, `Binary` if it was no text; ends with the connection."""
        try:
            async for message in self:
                yield message.encode() if isinstance(message, str) else Binary(message)
        except ConnectionClosed:
            return

    async def put(self, messages: Sequence[bytes]) -> None:
        """Send messages; returns when the system takes more.

        Whole frames are written past the library, whose sending costs more than all the rest (decision 8); it still
        writes pings, pongs and good-byes, between them.
        """
        self.transport.write(b"".join(part for message in messages for part in (frame_head(message), message)))
        await self.drain()

    def abort(self) -> None:
        """End the connection at once."""
        self.transport.abort()

    def look(self, now_ns: int) -> str | None:
        """Ask a quiet client for a sign of life; return why the connection has to be cut, None while it has not."""
        if not self.is_open:
            self._closing_since_ns = self._closing_since_ns or now_ns
            return "does not close" if now_ns - self._closing_since_ns > CLOSE_S * NS_PER_S else None
        overdue = self.limit.overdue(now_ns)
        if overdue is not None:
            return f"sends too slowly: {overdue}"
        now_s = now_ns / NS_PER_S
        # A program that is slow to answer is not a machine that is gone, which acknowledges nothing either.
        if self.liveness.is_dead(now_s) and is_unacknowledged(self.transport.get_extra_info("socket")):
            return f"has been gone for {self._dead_after_s:g} s"
        if self.liveness.ping_due(now_s):
            self.protocol.send_ping(b"")
            self.send_data()
        return None

    def data_received(self, data: bytes) -> None:
        """Note the time of whatever comes, pongs too."""
        self.liveness.heard(self._clock_ns() / NS_PER_S)
        super().data_received(data)
        if self.protocol.close_rcvd is not None:
            self.transport.close()  # both have said good-bye: the server ends the connection (RFC 6455, 7.1.1)
        if self.transport.get_write_buffer_size() > self._max_unsent_bytes:
            self.transport.abort()  # it sends pings without end and reads no answer

    def process_event(self, event: Any) -> None:
        """Pass a frame on, unless its message is in too many, or too long on its way (N13)."""
        if isinstance(event, Frame):
            reason = self.limit.add(event, self._clock_ns())
            if reason is not None:
                self.protocol.fail(CloseCode.POLICY_VIOLATION, reason)
                self.send_data()
                return
        super().process_event(event)
