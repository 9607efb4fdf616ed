"""ROS 1's binary form of messages: little-endian, nothing aligned, 32 bits of count before what is counted."""

import struct
from typing import TYPE_CHECKING, Any, Final

from simconsole.bridge.messages.cdr_writer import LETTERS
from simconsole.bridge.messages.definition import DURATION, HEADER, STRINGS, TIME, FieldType

if TYPE_CHECKING:
    from simconsole.bridge.messages.message_registry import Registry

_UINT32: Final = 0xFFFFFFFF


def serialize_ros1(registry: "Registry", name: str, message: Any, sequence: int = 0) -> bytes:
    """Return a typed message as a ROS 1 node would send it; `sequence` is its header's number.

    Raises:
        BridgeError: the type is not known.
    """
    body = bytearray()
    _message(registry, registry.resolve(name), message, sequence, body)
    return bytes(body)


def _message(registry: "Registry", name: str, message: Any, sequence: int, body: bytearray) -> None:
    if name in (TIME, DURATION):
        body += struct.pack("<Ii" if name == DURATION else "<II", message.sec & _UINT32, message.nanosec)
        return
    if name == HEADER:
        body += struct.pack("<I", sequence)
    for field in registry.definition(name).fields:
        value = getattr(message, field.name)
        if not field.type.array:
            _elements(registry, field.type, (value,), sequence, body)
            continue
        if field.type.array != "fixed":
            body += struct.pack("<I", len(value))
        _elements(registry, field.type, value, sequence, body)


def _elements(registry: "Registry", kind: FieldType, values: Any, sequence: int, body: bytearray) -> None:
    if kind.is_message:
        for value in values:
            _message(registry, kind.base, value, sequence, body)
    elif kind.base in STRINGS:
        for value in values:
            text = value.encode()
            body += struct.pack("<I", len(text)) + text
    elif kind.is_octets:
        body += bytes(values)
    else:
        body += struct.pack(f"<{len(values)}{LETTERS[kind.base]}", *values)
