"""A client's connection as the server keeps it: the library's, with an eye on silence, fragments and floods (shell)."""

from collections.abc import Callable
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.frames import CloseCode, Frame

from simconsole.bridge.backoff import Liveness
from simconsole.bridge.wire import FragmentLimit
from simconsole.profiles.bridge import BridgeProfile
from simconsole.units import NS_PER_S


class Peer(ServerConnection):
    """A connection that knows when it last heard something and counts the frames a message is in."""

    def __init__(self, profile: BridgeProfile, clock_ns: Callable[[], int], *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.limit = FragmentLimit(profile.limits.message_fragments)
        self.liveness = Liveness(profile.ping_interval_s, profile.dead_after_s)
        self.liveness.begin(clock_ns() / NS_PER_S)
        self._clock_ns = clock_ns
        # More than the sender, which waits for the socket between two messages, can have put there.
        self._max_unsent_bytes = 2 * profile.limits.queued_bytes

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
