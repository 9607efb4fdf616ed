"""Encodings of outgoing messages: JSON, PNG, CBOR and CDR, with ROS 1's or ROS 2's times.

A topic's message is encoded once per encoding in use, however many clients subscribe.
"""

import base64
import math
import struct
import zlib
from typing import Any, Final, Literal, NamedTuple

import cbor2
import msgspec
import orjson

from simconsole.bridge.messages import Registry
from simconsole.bridge.messages.cdr import serialize
from simconsole.bridge.messages.definition import DURATION, HEADER, TIME, FieldType
from simconsole.bridge.messages.ros1 import serialize_ros1
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.protocol.operations import Compression
from simconsole.values.units import NS_PER_S

Dialect = Literal["ros1", "ros2"]

# RFC 8746: typed arrays, little-endian. As rosbridge_suite has them; octets are a byte string.
_TYPED: Final[dict[str, tuple[int, str]]] = {
    "uint16": (69, "H"),
    "uint32": (70, "I"),
    "uint64": (71, "Q"),
    "int8": (72, "b"),
    "int16": (77, "h"),
    "int32": (78, "i"),
    "int64": (79, "q"),
    "float32": (85, "f"),
    "float64": (86, "d"),
}
_PNG: Final = b"\x89PNG\r\n\x1a\n"


class Encoding(NamedTuple):
    """How a subscriber wants its messages encoded."""

    dialect: Dialect = "ros2"
    compression: Compression = "none"


PLAIN_JSON: Final = Encoding()


class Encoder:
    """One message for many subscribers: each encoding is made at most once."""

    __slots__ = ("_json", "_made", "_message", "_now_ns", "_registry", "_sequence", "_type")

    def __init__(self, registry: Registry, type_name: str, message: Any, sequence: int, now_ns: int) -> None:
        """Take a typed message; `sequence` is ROS 1's header number, `now_ns` when cbor-raw says it was received."""
        self._registry = registry
        self._type = type_name
        self._message = message
        self._sequence = sequence
        self._now_ns = now_ns
        self._json: dict[Dialect, bytes] = {}
        self._made: dict[tuple[Encoding, bytes], bytes] = {}

    def text(self, encoding: Encoding, head: bytes, topic: str) -> bytes:
        """Return the publish operation in `encoding`; `head` is that of JSON, `topic` the client's spelling."""
        if encoding.compression == "none":
            return head + self._body(encoding.dialect)
        key = (encoding, head)
        if key not in self._made:
            self._made[key] = self._compressed(encoding, head, topic)
        return self._made[key]

    def _body(self, dialect: Dialect) -> bytes:
        body = self._json.get(dialect)
        if body is None:
            message = self._message if dialect == "ros2" else self._plain(dialect, False)
            body = self._json[dialect] = msgspec.json.encode(message) + b"}"
        return body

    def _plain(self, dialect: Dialect, typed: bool) -> Any:
        return to_plain(self._registry, self._type, self._message, dialect, typed, self._sequence)

    def _compressed(self, encoding: Encoding, head: bytes, topic: str) -> bytes:
        if encoding.compression == "png":
            return orjson.dumps({"op": "png", "data": png(head + self._body(encoding.dialect))})
        if encoding.compression == "cbor":
            message = self._plain(encoding.dialect, True)
        else:
            seconds, nanoseconds = divmod(self._now_ns, NS_PER_S)
            if encoding.dialect == "ros1":
                raw = serialize_ros1(self._registry, self._type, self._message, self._sequence)
            else:
                raw = serialize(self._registry, self._type, self._message)
            message = {"secs": seconds, "nsecs": nanoseconds, "bytes": raw}
        return Binary(cbor2.dumps({"op": "publish", "topic": topic, "msg": message}))


def to_plain(
    registry: Registry, name: str, message: Any, dialect: Dialect, typed: bool = False, sequence: int = 0
) -> Any:
    """Return a typed message as plain values in a dialect's spelling; `typed` makes numeric arrays CBOR's."""
    if name in (TIME, DURATION) and dialect == "ros1":
        return {"secs": message.sec, "nsecs": message.nanosec}
    plain: dict[str, Any] = {}
    if name == HEADER and dialect == "ros1":
        plain["seq"] = sequence
    for field in registry.definition(name).fields:
        plain[field.name] = _field_to_plain(
            registry, field.type, getattr(message, field.name), dialect, typed, sequence
        )
    return plain


def _field_to_plain(
    registry: Registry, kind: FieldType, value: Any, dialect: Dialect, typed: bool, sequence: int
) -> Any:
    if kind.is_message:
        if kind.array:
            return [to_plain(registry, kind.base, item, dialect, typed, sequence) for item in value]
        return to_plain(registry, kind.base, value, dialect, typed, sequence)
    if typed and kind.array and kind.base in _TYPED:
        tag, letter = _TYPED[kind.base]
        return cbor2.CBORTag(tag, struct.pack(f"<{len(value)}{letter}", *value))
    return value


def png(text: bytes) -> str:
    """Return a text as the base64 of a PNG whose RGB bytes it is, padded with newlines (rosbridge_suite's way)."""
    width = max(1, math.isqrt(len(text) // 3))
    height = max(1, math.ceil(len(text) / (3 * width)))
    padded = text.ljust(3 * width * height, b"\n")
    lines = b"".join(b"\0" + padded[at : at + 3 * width] for at in range(0, len(padded), 3 * width))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    parts = (_chunk(b"IHDR", header), _chunk(b"IDAT", zlib.compress(lines, 1)), _chunk(b"IEND", b""))
    return base64.b64encode(_PNG + b"".join(parts)).decode()


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
