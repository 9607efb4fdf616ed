"""CDR, the binary form of ROS 2 messages (OMG XTypes 1.3, 7.4.3: plain CDR, version 1). Little-endian is written."""

import struct
from typing import TYPE_CHECKING, Any, Final

from simconsole.bridge.messages.definition import STRINGS, FieldType
from simconsole.values.errors import RemoteProtocolError

if TYPE_CHECKING:
    from simconsole.bridge.messages.message_registry import Registry

_HEADER: Final = b"\x00\x01\x00\x00"
_ORDERS: Final = {b"\x00\x00": ">", b"\x00\x01": "<"}
LETTERS: Final = {
    "bool": "?",
    "byte": "B",
    "char": "B",
    "int8": "b",
    "uint8": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}


def serialize(registry: "Registry", name: str, message: Any) -> bytes:
    """Return a typed message in CDR with its encapsulation header.

    Raises:
        BridgeError: the type is not known.
    """
    body = bytearray()
    _message(registry, name, message, body)
    return _HEADER + bytes(body)


def _message(registry: "Registry", name: str, message: Any, body: bytearray) -> None:
    fields = registry.definition(name).fields
    if not fields:
        body.append(0)  # ROS 2 gives a message without fields one octet
    for field in fields:
        value = getattr(message, field.name)
        if not field.type.array:
            _elements(registry, field.type, (value,), body)
            continue
        if field.type.array != "fixed":
            _numbers("I", (len(value),), body)
        _elements(registry, field.type, value, body)


def _elements(registry: "Registry", kind: FieldType, values: Any, body: bytearray) -> None:
    if kind.is_message:
        for value in values:
            _message(registry, kind.base, value, body)
    elif kind.base == "wstring":
        for value in values:
            text = value.encode("utf-16-le")
            _numbers("I", (len(text) // 2,), body)
            body += text
    elif kind.base in STRINGS:
        for value in values:
            text = value.encode() + b"\0"
            _numbers("I", (len(text),), body)
            body += text
    elif kind.is_octets and kind.array:
        body += values
    else:
        _numbers(LETTERS[kind.base], values, body)


def _numbers(letter: str, values: Any, body: bytearray) -> None:
    if values:
        body += bytes(-len(body) % struct.calcsize(f"<{letter}"))
        body += struct.pack(f"<{len(values)}{letter}", *values)


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
