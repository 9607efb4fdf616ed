"""Long texts in pieces: splitting with integer totals and unique ids, and putting together within bounds."""

import math
from collections.abc import Iterator
from typing import Final

import orjson

from simconsole.bridge.protocol.operations import Fragment, Id
from simconsole.values.errors import RemoteProtocolError
from simconsole.values.units import NS_PER_S

MAX_OPEN: Final = 8
TIMEOUT_NS: Final = 5 * NS_PER_S
"""Longest silence between two pieces; a slow sender whose pieces keep coming is waited for (N14)."""


def split(text: bytes, size: int, identifier: str) -> Iterator[bytes]:
    """Yield `text` as fragment operations that each carry at most `size` characters of it."""
    characters = text.decode()
    total = math.ceil(len(characters) / size)
    for number in range(total):
        data = characters[number * size : (number + 1) * size]
        yield orjson.dumps({"op": "fragment", "id": identifier, "data": data, "num": number, "total": total})


class _Message:
    def __init__(self, total: int, now_ns: int) -> None:
        self.total = total
        self.heard_ns = now_ns
        self.pieces: dict[int, str] = {}


class FragmentAssembler:
    """Puts the fragments of one peer together: any order, several messages at once, never more than its bounds."""

    def __init__(self, max_bytes: int, max_pieces: int) -> None:
        """Allow messages of `max_bytes`, all unfinished ones together, in at most `max_pieces` each."""
        self.max_bytes = max_bytes
        self._max_pieces = max_pieces
        self._messages: dict[Id, _Message] = {}
        self._held = 0

    @property
    def held(self) -> int:
        """Characters kept of unfinished messages."""
        return self._held

    def add(self, fragment: Fragment, now_ns: int) -> bytes | None:
        """Take one piece; return the whole text with its last one.

        Raises:
            RemoteProtocolError: the piece does not belong, or there is too much; what was kept of it is forgotten.
        """
        for identifier, message in list(self._messages.items()):
            if now_ns - message.heard_ns > TIMEOUT_NS:
                self._forget(identifier)
        total, number = math.ceil(fragment.total), int(fragment.num)
        message = self._messages.get(fragment.id) or self._begin(fragment.id, total, now_ns)
        try:
            if total != message.total:
                raise RemoteProtocolError(f"total is {total}, was {message.total} in an earlier piece")
            if not 0 <= number < total or number != fragment.num:
                raise RemoteProtocolError(f"num is {fragment.num:g}, expected a whole number below {total}")
            if number in message.pieces:
                raise RemoteProtocolError(f"piece {number} is given twice")
            if self._held + len(fragment.data) > self.max_bytes:
                raise RemoteProtocolError(f"unfinished messages are longer than {self.max_bytes} bytes")
        except RemoteProtocolError:
            self._forget(fragment.id)
            raise
        message.heard_ns = now_ns
        message.pieces[number] = fragment.data
        self._held += len(fragment.data)
        if len(message.pieces) < total:
            return None
        self._forget(fragment.id)
        return "".join(message.pieces[place] for place in range(total)).encode("utf-8", "surrogatepass")

    def _begin(self, identifier: Id, total: int, now_ns: int) -> _Message:
        if total > self._max_pieces:
            raise RemoteProtocolError(f"message is in more than {self._max_pieces} fragments")
        if len(self._messages) >= MAX_OPEN:
            raise RemoteProtocolError(f"more than {MAX_OPEN} messages are unfinished")
        message = self._messages[identifier] = _Message(total, now_ns)
        return message

    def _forget(self, identifier: Id) -> None:
        message = self._messages.pop(identifier)
        self._held -= sum(map(len, message.pieces.values()))
