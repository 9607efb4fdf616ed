"""The interface between the bridge in an event loop and the WebSocket library that carries its clients."""

from collections.abc import Awaitable, Callable
from typing import Protocol

from simconsole.bridge.protocol.handshake import Admission, HandshakeRequest, Refusal


class Connection(Protocol):
    """One client's WebSocket connection."""

    @property
    def is_open(self) -> bool:
        """Whether messages can pass, as far as this side knows."""

    @property
    def takes_more(self) -> bool:
        """Whether messages may be given; false while the system takes nothing, so that what waits here is bounded."""

    def write(self, frames: bytes) -> None:
        """Send whole frames, made by `frames.FrameWriter`."""

    def limit_messages(self, max_bytes: int) -> None:
        """Refuse longer messages of the client from now on."""

    def pause_reading(self) -> None:
        """Read nothing more of the client, so that its system holds back what it sends."""

    def resume_reading(self) -> None:
        """Read on."""

    def abort(self) -> None:
        """End the connection at once, without waiting for the other side."""

    def check(self, now_ns: int) -> str | None:
        """Ping a quiet client; return why the connection has to be aborted, None while it has not."""


class ConnectionHandler(Protocol):
    """Receives what happens on a connection, in the loop's thread."""

    def receive(self, message: bytes) -> None:
        """Take a whole message, `message_decoding.Binary` if it was not text."""

    def resume(self) -> None:
        """Continue sending: the socket takes more."""

    def closed(self) -> None:
        """Note the end of the connection, however it ended; called once."""


class Acceptor(Protocol):
    """Accepts clients."""

    def admit(self, request: HandshakeRequest) -> Admission | Refusal:
        """Decide on a client's opening handshake."""

    def accept(self, transport: Connection, peer: str, admission: Admission) -> ConnectionHandler:
        """Add a client whose handshake is done; `peer` names it in the log."""


class Listener(Protocol):
    """A listening WebSocket server."""

    def close(self) -> None:
        """Stop accepting; close clients."""

    def wait_closed(self) -> Awaitable[object]:
        """Return when all connections have ended."""


StartListener = Callable[..., Awaitable[Listener]]
"""Takes an `Acceptor`, the listening socket, the profile, TLS and the clock in ns."""
