"""CDR, the binary form of ROS 2 messages (OMG XTypes 1.3, 7.4.3: plain CDR, version 1). Little-endian is written."""

import struct
from typing import TYPE_CHECKING, Any, Final

from simconsole.bridge.messages.cdr_writer import LETTERS
from simconsole.bridge.messages.definition import STRINGS, FieldType
from simconsole.values.errors import RemoteProtocolError

if TYPE_CHECKING:
    from simconsole.bridge.messages.message_registry import Registry

_HEADER: Final = b"\x00\x01\x00\x00"
_ORDERS: Final = {b"\x00\x00": ">", b"\x00\x01": "<"}


def serialize(registry: "Registry", name: str, message: Any) -> bytes:
    """Return a typed message in CDR with its encapsulation header.

    Raises:
        BridgeError: the type is not known.
    """
    body = bytearray()
    registry.cdr_writer(name)(message, body)
    return bytes(_HEADER + body)


def deserialize(registry: "Registry", name: str, data: bytes) -> dict[str, Any]:
    """Return a message in CDR, of either byte order, as plain values: arrays of bytes as bytes, else as in JSON.

    Raises:
        BridgeError: the type is not known.
        RemoteProtocolError: the data are none of that type; bytes after its end are padding.
    """
    order = _ORDERS.get(data[:2])
    if order is None or len(data) < len(_HEADER):
        raise RemoteProtocolError(f"{name}: not plain CDR")
    try:
        return _Reader(registry, data, order).message(registry.resolve(name))
    except (struct.error, UnicodeDecodeError, OverflowError):
        raise RemoteProtocolError(f"{name}: {len(data)} bytes of CDR that do not fit the type") from None


class _Reader:
    """A place in CDR data; alignment counts from behind the encapsulation header."""

    def __init__(self, registry: "Registry", data: bytes, order: str) -> None:
        self._registry = registry
        self._data = data
        self._order = order
        self._at = len(_HEADER)

    def message(self, name: str) -> dict[str, Any]:
        """Read one message of a type; returns its fields as plain values."""
        fields = self._registry.definition(name).fields
        if not fields:
            self._bytes(1)
        return {field.name: self._field(field.type) for field in fields}

    def _field(self, kind: FieldType) -> Any:
        if not kind.array:
            return self._elements(kind, 1)[0]
        return self._elements(kind, kind.size if kind.array == "fixed" else self._count())

    def _count(self) -> int:
        (count,) = self._numbers("I", 1)
        # No element is shorter than a byte: what claims more is refused before anything is made for it.
        if count > len(self._data):
            raise struct.error
        return int(count)

    def _elements(self, kind: FieldType, count: int) -> Any:
        if kind.is_message:
            return [self.message(kind.base) for _ in range(count)]
        if kind.base in STRINGS:
            return [self._text(kind.base) for _ in range(count)]
        if kind.is_octets:
            return self._bytes(count)
        return list(self._numbers(LETTERS[kind.base], count))

    def _text(self, base: str) -> str:
        length = self._count()
        if base == "wstring":
            return self._bytes(2 * length).decode("utf-16-le" if self._order == "<" else "utf-16-be")
        return self._bytes(length).rstrip(b"\0").decode()

    def _bytes(self, count: int) -> bytes:
        found = self._data[self._at : self._at + count]
        if len(found) < count:
            raise struct.error
        self._at += count
        return found

    def _numbers(self, letter: str, count: int) -> tuple[Any, ...]:
        if not count:
            return ()
        self._at += (len(_HEADER) - self._at) % struct.calcsize(f"<{letter}")
        found = struct.unpack_from(f"{self._order}{count}{letter}", self._data, self._at)
        self._at += struct.calcsize(f"<{letter}") * count
        return found
