"""Profile text to plain values and back: a small, strict part of YAML, of which JSON is a subset.

Built on the event stream of PyYAML's safe parser, so nothing is ever constructed from a tag. Refused, each with its
line: anchors and aliases (the YAML bomb), tags, duplicate keys, nesting past MAX_DEPTH, several documents, NaN and
infinities. Plain scalars follow YAML 1.2's core schema: `no`, `1:30` and `2026-11-20` stay strings, `1e-3` is a number.
"""

import math
import re
from collections.abc import Iterator
from typing import Any, Final, TypeAlias

import msgspec
import yaml

from simconsole.values.errors import ProfileError

Plain: TypeAlias = "bool | int | float | str | list[Plain] | dict[str, Plain] | None"
"""What a profile's text can hold."""

MAX_DEPTH: Final = 32
MAX_INTEGER: Final = 2**63 - 1

_CONSTANTS: Final[dict[str, Plain]] = {
    "": None,
    "~": None,
    "null": None,
    "true": True,
    "True": True,
    "false": False,
    "False": False,
}
_INTEGER: Final = re.compile(r"[-+]?(0|[1-9][0-9]*)")
_HEXADECIMAL: Final = re.compile(r"0x[0-9a-fA-F]+")
_FLOAT: Final = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_NOT_FINITE: Final = re.compile(r"[-+]?\.?(inf|infinity|nan)", re.IGNORECASE)
_NOT_IN_YAML: Final = re.compile("[\x7f-\x9f\u2028\u2029\ufeff\ufffe\uffff]")
_LOADER: Final[Any] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def parse(text: str, origin: str) -> Plain:
    """Return the one document in `text` as plain values; `origin` (a file name) opens every message.

    Raises:
        ProfileError: the text is not YAML, or uses a part of it that profiles must not use.
    """
    try:
        return _Reader(yaml.parse(text, Loader=_LOADER), origin).document()
    except UnicodeEncodeError as error:
        raise ProfileError(f"{origin}: text: not YAML: a lone surrogate") from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"line {mark.line + 1}" if mark else "text"
        problem = getattr(error, "problem", None) or getattr(error, "reason", None) or "unreadable"
        raise ProfileError(f"{origin}: {place}: not YAML: {problem}") from error


def to_text(profile: object) -> str:
    """Return a profile as text that `parse` reads back to equal values: JSON, always the same bytes."""
    encoded = msgspec.json.encode(profile, order="deterministic")
    text = msgspec.json.format(encoded, indent=2).decode()
    return _NOT_IN_YAML.sub(lambda match: f"\\u{ord(match[0]):04x}", text) + "\n"


def to_yaml(profile: object) -> str:
    """Return a profile as block YAML that a person can edit, in ASCII."""
    text: str = yaml.safe_dump(msgspec.to_builtins(profile), sort_keys=False, allow_unicode=False, width=120)
    return text


class _Reader:
    """One pass over the events; the depth check comes before any recursion, so 20,000 brackets cost 32 calls."""

    def __init__(self, events: Iterator[Any], origin: str) -> None:
        self._events = events
        self._origin = origin

    def document(self) -> Plain:
        next(self._events)  # StreamStart
        if isinstance(next(self._events), yaml.StreamEndEvent):
            raise ProfileError(f"{self._origin}: file: empty: a mapping of keys and values")
        value = self._node(next(self._events), "file", 0)
        next(self._events)  # DocumentEnd
        event = next(self._events)
        if not isinstance(event, yaml.StreamEndEvent):
            raise self._refused(event, "a second document", "one document per file")
        return value

    def _node(self, event: Any, key: str, depth: int) -> Plain:
        if isinstance(event, yaml.AliasEvent):
            raise self._refused(event, f"alias *{event.anchor}", "write the value out")
        if event.anchor is not None:
            raise self._refused(event, f"anchor &{event.anchor}", "write the value out")
        if event.tag is not None:
            raise self._refused(event, f"tag {event.tag}", "plain values only")
        if depth > MAX_DEPTH:
            raise self._refused(event, f"nesting deeper than {MAX_DEPTH}", f"at most {MAX_DEPTH} levels")
        if isinstance(event, yaml.MappingStartEvent):
            return self._mapping(key, depth)
        if isinstance(event, yaml.SequenceStartEvent):
            return self._sequence(key, depth)
        if not event.implicit[0]:  # quoted or a block of text
            return str(event.value)
        return self._scalar(event, key)

    def _mapping(self, path: str, depth: int) -> Plain:
        values: dict[str, Plain] = {}
        while not isinstance(event := next(self._events), yaml.MappingEndEvent):
            if not isinstance(event, yaml.ScalarEvent) or event.anchor is not None or event.tag is not None:
                raise self._refused(event, "a key that is not plain text", "text as key")
            name = event.value
            if name in values:
                raise self._refused(event, f"key {name!r} a second time", "each key once")
            if name == "<<":
                raise self._refused(event, "merge key <<", "write the values out")
            values[name] = self._node(next(self._events), name if path == "file" else f"{path}.{name}", depth + 1)
        return values

    def _sequence(self, path: str, depth: int) -> Plain:
        values: list[Plain] = []
        while not isinstance(event := next(self._events), yaml.SequenceEndEvent):
            values.append(self._node(event, f"{path}[{len(values)}]", depth + 1))
        return values

    def _scalar(self, event: Any, key: str) -> Plain:
        text: str = event.value
        if text in _CONSTANTS:
            return _CONSTANTS[text]
        if len(text) <= 40 and (_INTEGER.fullmatch(text) or _HEXADECIMAL.fullmatch(text)):
            number = int(text, 16) if text.startswith("0x") else int(text)
            if abs(number) > MAX_INTEGER:
                raise ProfileError(f"{self._origin}: {key}: value {text}: a whole number within 64 bits")
            return number
        if _NOT_FINITE.fullmatch(text):
            raise ProfileError(f"{self._origin}: {key}: value {text}: a finite number")
        if _FLOAT.fullmatch(text):
            value = float(text)
            if not math.isfinite(value):
                raise ProfileError(f"{self._origin}: {key}: value {text[:40]}: a finite number")
            return value
        return text

    def _refused(self, event: Any, what: str, allowed: str) -> ProfileError:
        return ProfileError(f"{self._origin}: line {event.start_mark.line + 1}: {what} is not allowed: {allowed}")
