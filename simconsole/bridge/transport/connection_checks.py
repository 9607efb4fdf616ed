"""What every server checks of a client's connection, whatever library carries it: silence, slow messages, closing."""

import socket
from collections.abc import Callable

from simconsole.bridge.protocol.access import Role, message_limit
from simconsole.bridge.protocol.backoff import Liveness
from simconsole.bridge.protocol.frames import MessageAssembler
from simconsole.bridge.transport import sockets
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.units import NS_PER_S


class ConnectionChecks:
    """The checks of one connection. Time is given, in ns of the server's clock."""

    def __init__(self, profile: BridgeProfile, now_ns: int) -> None:
        """Begin with a connection that was heard at `now_ns`."""
        limits = profile.limits
        self.assembler = MessageAssembler(message_limit(Role.NONE, limits), limits.message_fragments)
        """Joins the frames of the connection's messages."""
        self._dead_after_s = profile.dead_after_s
        self._liveness = Liveness(profile.ping_interval_s, profile.dead_after_s)
        self._liveness.begin(now_ns / NS_PER_S)
        self._closing_since_ns: int | None = None

    @property
    def is_closing(self) -> bool:
        """Whether `closing` was called."""
        return self._closing_since_ns is not None

    def heard(self, now_ns: int) -> None:
        """Note that something has arrived."""
        self._liveness.heard(now_ns / NS_PER_S)

    def closing(self, now_ns: int) -> str | None:
        """Note that the closing handshake has begun; return why to abort once it takes too long, None until then."""
        if self._closing_since_ns is None:
            self._closing_since_ns = now_ns
        return "does not close" if now_ns - self._closing_since_ns > sockets.CLOSE_S * NS_PER_S else None

    def check(self, now_ns: int, sock: socket.socket, ping: Callable[[], None]) -> str | None:
        """Ping a quiet client of an open connection; return why to abort, None while there is no reason."""
        overdue = self.assembler.overdue(now_ns)
        if overdue is not None:
            return f"sends too slowly: {overdue}"
        now_s = now_ns / NS_PER_S
        self._liveness.look(now_s)
        # A program that is slow to answer is not a machine that is gone, which acknowledges nothing either.
        if self._liveness.is_dead(now_s) and sockets.is_unacknowledged(sock):
            return f"has been gone for {self._dead_after_s:g} s"
        if self._liveness.ping_due(now_s):
            ping()
        return None
