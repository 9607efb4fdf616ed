"""CDR, the binary form of ROS 2 messages (OMG XTypes 1.3, 7.4.3: plain CDR, version 1, little-endian)."""

import struct
from typing import TYPE_CHECKING, Any, Final

from simconsole.bridge.messages.definition import STRINGS, FieldType

if TYPE_CHECKING:
    from simconsole.bridge.messages.registry import Registry

_HEADER: Final = b"\x00\x01\x00\x00"
_LETTERS: Final = {
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
    else:
        _numbers(_LETTERS[kind.base], values, body)


def _numbers(letter: str, values: Any, body: bytearray) -> None:
    if values:
        body += bytes(-len(body) % struct.calcsize(f"<{letter}"))
        body += struct.pack(f"<{len(values)}{letter}", *values)
