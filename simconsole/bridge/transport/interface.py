"""What the bridge in an event loop and a client's connection ask of each other, whatever library carries it."""

import importlib.util
from collections.abc import Awaitable, Callable, Sequence
from typing import Protocol

from simconsole.bridge.protocol.handshake import Admission, Opening, Refusal
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import ProfileError


class Transport(Protocol):
    """A client's connection: whole messages out, an end without a word, and an eye on it."""

    @property
    def is_open(self) -> bool:
        """Whether messages can pass, as far as this side knows."""

    @property
    def takes_more(self) -> bool:
        """Whether messages may be given; false while the system takes nothing, so that what waits here is bounded."""

    def put(self, messages: Sequence[bytes]) -> None:
        """Send messages in order, text or `documents.Binary`."""

    def abort(self) -> None:
        """End the connection at once, without waiting for the other side."""

    def look(self, now_ns: int) -> str | None:
        """Ask a quiet client for a sign of life; return why the connection has to be cut, None while it has not."""


class Client(Protocol):
    """Who is told what happens on a connection, in the loop's thread."""

    def receive(self, message: bytes) -> None:
        """Take a whole message, `documents.Binary` if it was no text."""

    def resume(self) -> None:
        """Give messages again: the system takes more."""

    def gone(self) -> None:
        """Forget the connection, however it ended; called once."""


class House(Protocol):
    """Who lets clients in."""

    def admit(self, opening: Opening) -> Admission | Refusal:
        """Decide on a first request."""

    def welcome(self, transport: Transport, peer: str, admission: Admission) -> Client:
        """Take in a client whose handshake is done; `peer` names it in the log."""


class Door(Protocol):
    """A server that listens."""

    def close(self) -> None:
        """Let nobody in any more and say good-bye to who is there."""

    def wait_closed(self) -> Awaitable[object]:
        """Return when everybody has gone."""


OpenDoor = Callable[..., Awaitable[Door]]
"""Takes a `House`, the listening socket, the profile, TLS and the clock in ns."""


def load_transport(profile: BridgeProfile) -> OpenDoor:
    """Return how clients come in with the library that the profile names.

    Raises:
        ProfileError: that library is not installed.
    """
    if profile.transport == "websockets":
        from simconsole.bridge.transport import websockets_transport

        return websockets_transport.open_door
    if importlib.util.find_spec("picows") is None:
        raise ProfileError("outputs.bridge.transport: picows is not installed: pip install 'simconsole[picows]'")
    from simconsole.bridge.transport import picows_transport

    return picows_transport.open_door
