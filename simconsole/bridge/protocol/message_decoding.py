"""Decoding of incoming WebSocket messages, JSON or CBOR: strict, and nothing of a refused message is kept."""

import io
import json
import re
import struct
from typing import Any, Final, NamedTuple, NoReturn

import cbor2
import msgspec
import orjson

from simconsole.values.errors import RemoteProtocolError
from simconsole.values.kernels import is_finite

LENIENT_BYTES: Final = 65_536
MAX_DEPTH: Final = 32
"""Objects and arrays within one another; no message of ROS comes near it."""
TYPED_ARRAYS: Final[dict[int, str]] = {
    64: "B", 69: "H", 70: "I", 71: "Q", 72: "b", 77: "h", 78: "i", 79: "q", 85: "f", 86: "d",
}  # fmt: skip
"""RFC 8746's little-endian arrays by tag, with their letter of `struct`: all that rosbridge_suite writes."""
# Every tag that cbor2 6 gives a meaning of its own: dates, bignums, fractions, patterns, shared values, sets, ...
_FOREIGN_TAGS: Final = (
    0, 1, 2, 3, 4, 5, 25, 28, 29, 30, 35, 36, 37, 52, 54, 100, 256, 258, 260, 261, 1004, 43000, 55799,
)  # fmt: skip
_LITERALS: Final = (b"NaN", b"Infinity")
# An unclosed string matches to the end of the text, so that no text makes the search run over itself again.
_STRING_OR_LITERAL: Final = re.compile(rb'"(?:[^"\\]|\\[\s\S])*+"?|-?Infinity\b|\bNaN\b')


class Binary(bytes):
    """What comes or goes in a binary WebSocket message: CBOR; plain bytes are text: JSON."""


class DecodedMessage(NamedTuple):
    """A decoded message; `literals` is whether it held NaN or Infinity, which JSON does not have."""

    fields: dict[str, Any]
    literals: bool


def decode(text: bytes) -> DecodedMessage:
    """Decode one message: CBOR if it is `Binary`, JSON otherwise.

    NaN and Infinity, which stock clients write, are read as null in texts of at most LENIENT_BYTES and reported.

    Raises:
        RemoteProtocolError: not one object, or nested deeper than MAX_DEPTH; names the place.
    """
    if isinstance(text, Binary):
        value, literals = _read_binary(text), False
    else:
        try:
            value, literals = orjson.loads(text), False
        except orjson.JSONDecodeError as error:
            value, literals = _read_again(text, error), True
    if not isinstance(value, dict):
        raise RemoteProtocolError(f"message is {_kind(value)}, expected an object")
    if not isinstance(text, Binary) and text.count(b"{") + text.count(b"[") > MAX_DEPTH and _is_deep(value):
        raise RemoteProtocolError(f"message is nested deeper than {MAX_DEPTH}")
    return DecodedMessage(value, literals)


def _read_binary(data: Binary) -> Any:
    """Decode CBOR without indefinite lengths, foreign tags, repeated keys, and values that JSON cannot express."""
    stream = io.BytesIO(data)
    try:
        value = cbor2.load(
            stream,
            tag_hook=_typed_array,
            semantic_decoders=_REFUSED_TAGS,
            max_depth=MAX_DEPTH,
            allow_indefinite=False,
            allow_duplicate_keys=False,
            strict_hashable_types=True,
        )
        # Refuses keys that are no text, integers beyond 64 bits, undefined and simple values.
        orjson.dumps(value, default=_octets)
    except (cbor2.CBORDecodeError, orjson.JSONEncodeError) as error:
        raise RemoteProtocolError(f"message is not one CBOR document: {error.__cause__ or error}"[:300]) from None
    if stream.tell() != len(data):
        raise RemoteProtocolError("message is not one CBOR document: more follows it")
    return value


def _typed_array(tag: Any, immutable: bool) -> Any:
    letter = TYPED_ARRAYS.get(tag.tag)
    if letter is None or not isinstance(tag.value, bytes) or len(tag.value) % struct.calcsize(letter):
        _refuse_tag(tag.tag)
    if letter == "B":
        return tag.value
    return list(struct.unpack(f"<{len(tag.value) // struct.calcsize(letter)}{letter}", tag.value))


def _refuse_tag(*which: Any) -> NoReturn:
    raise ValueError("a tag other than RFC 8746's little-endian arrays")


_REFUSED_TAGS: Final = dict.fromkeys(_FOREIGN_TAGS, _refuse_tag)


def _octets(value: Any) -> None:
    if not isinstance(value, bytes):
        raise TypeError("a value that JSON has no word for")


def _is_deep(value: Any) -> bool:
    level = [value]
    for _ in range(MAX_DEPTH):
        level = [
            part
            for holder in level
            for part in (holder.values() if isinstance(holder, dict) else holder)
            if isinstance(part, dict | list)
        ]
        if not level:
            return False
    return True


def _read_again(text: bytes, error: orjson.JSONDecodeError) -> Any:
    if len(text) <= LENIENT_BYTES and any(literal in text for literal in _LITERALS):
        plain = _STRING_OR_LITERAL.sub(lambda match: match[0] if match[0].startswith(b'"') else b"null", text)
        try:
            return orjson.loads(plain)
        except orjson.JSONDecodeError:
            pass
    raise RemoteProtocolError(f"message is not one JSON document: {error}") from None


def has_duplicate_keys(text: bytes, fields: dict[str, Any]) -> bool:
    """Return whether an object in `text`, which decoded to `fields`, gives one key twice.

    A document without escapes that lost a key lost its quotation marks with it, so counting them is enough; only a
    text with escapes is decoded once more.

    CBOR that gives a key twice is not even read.
    """
    if isinstance(text, Binary):
        return False
    if b"\\" not in text:
        return text.count(b'"') != orjson.dumps(fields).count(b'"')
    try:
        json.loads(text, object_pairs_hook=_refuse_duplicates)
    except _DuplicateKeyError:
        return True
    return False


def read_complete(text: bytes, reader: msgspec.json.Decoder[Any]) -> Any:
    """Return the message that encodes to just this text, None where there is none.

    Such a text gives every field once and no number that JSON does not have: only what it means is left to be checked.
    """
    try:
        message = reader.decode(text)
    except msgspec.DecodeError:
        return None
    return message if msgspec.json.encode(message) == text else None


def all_finite(value: Any) -> bool:
    """Return whether no number in decoded CBOR is NaN or infinite; JSON cannot express them."""
    if isinstance(value, dict):
        return all(map(all_finite, value.values()))
    if isinstance(value, list):
        return all(map(all_finite, value))
    return not isinstance(value, float) or is_finite(value)


class _DuplicateKeyError(Exception):
    pass


def _refuse_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    fields = dict(pairs)
    if len(fields) != len(pairs):
        raise _DuplicateKeyError
    return fields


def _kind(value: object) -> str:
    if value is None:
        return "null"
    return {list: "an array", str: "a string", bool: "a boolean"}.get(type(value), "a number")
