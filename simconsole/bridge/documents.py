"""One WebSocket message is one JSON document: strict reading, with nothing kept of what was refused."""

import json
import re
from typing import Any, Final, NamedTuple

import orjson

from simconsole.errors import RemoteProtocolError

LENIENT_BYTES: Final = 65_536
_LITERALS: Final = (b"NaN", b"Infinity")
# An unclosed string matches to the end of the text, so that no text makes the search run over itself again.
_STRING_OR_LITERAL: Final = re.compile(rb'"(?:[^"\\]|\\[\s\S])*+"?|-?Infinity\b|\bNaN\b')


class Document(NamedTuple):
    """A decoded message; `literals` tells that it held NaN or Infinity, which JSON does not have."""

    fields: dict[str, Any]
    literals: bool


def read(text: bytes) -> Document:
    """Decode one message.

    NaN and Infinity, which stock clients write, are read as null in texts of at most LENIENT_BYTES and reported.

    Raises:
        RemoteProtocolError: not one JSON object; names the place.
    """
    try:
        value, literals = orjson.loads(text), False
    except orjson.JSONDecodeError as error:
        value, literals = _read_again(text, error), True
    if not isinstance(value, dict):
        raise RemoteProtocolError(f"message is {_kind(value)}, expected a JSON object")
    return Document(value, literals)


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

    Raises:
        RemoteProtocolError: nested too deep to tell; no message is.
    """
    try:
        if b"\\" not in text:
            return text.count(b'"') != orjson.dumps(fields).count(b'"')
        json.loads(text, object_pairs_hook=_refuse_duplicates)
    except _DuplicateKeyError:
        return True
    except (orjson.JSONEncodeError, RecursionError):
        raise RemoteProtocolError("message is nested too deep") from None
    return False


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
