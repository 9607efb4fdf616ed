"""What a bridge in an event loop asks of a client's connection, whatever carries it."""

from collections.abc import AsyncIterator, Sequence
from typing import Protocol


class Transport(Protocol):
    """Whole messages in, whole messages out with a wait, an end without a word; and an eye on it."""

    @property
    def is_open(self) -> bool:
        """Whether messages can pass, as far as this side knows."""

    def messages(self) -> AsyncIterator[bytes]:
        """Yield each message, `documents.Binary` if it was no text; ends with the connection, however that ends."""

    async def put(self, messages: Sequence[bytes]) -> None:
        """Send messages in order; returns when more may be given, so that what waits here stays bounded."""

    def abort(self) -> None:
        """End the connection at once, without waiting for the other side."""

    def look(self, now_ns: int) -> str | None:
        """Ask a quiet client for a sign of life; return why the connection has to be cut, None while it has not."""
