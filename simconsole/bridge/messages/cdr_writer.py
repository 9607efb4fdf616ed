"""Writers of CDR, one for each message type: worked out once, then a message costs a few calls for each run of numbers.

A run is what follows each other in the layout, through messages inside messages, up to the next text or array. Where
its numbers lie depends on where it begins only by the remainder of eight, the widest alignment there is.
"""

import struct
from collections.abc import Callable
from operator import attrgetter
from typing import Any, Final, TypeAlias

from simconsole.bridge.messages.definition import STRINGS, Definition, FieldType

Writer: TypeAlias = Callable[[Any, bytearray], None]
"""Appends a typed message, or a part of it, to the body: all that stands behind the encapsulation header."""

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
"""The letter of `struct` for each numeric type."""
_WIDEST: Final = 8

_Definitions: TypeAlias = Callable[[str], Definition]


def message_writer(definition: _Definitions, name: str) -> Writer:
    """Return what writes messages of a type; `definition` gives that of a name, and raises where it knows none."""
    steps = _Steps(definition)
    steps.add_message(name, "")
    return _in_order(steps.finish())


class _Steps:
    """The steps of a writer, in the making."""

    def __init__(self, definition: _Definitions) -> None:
        self._definition = definition
        self._steps: list[Writer] = []
        self._run: list[tuple[str, str]] = []
        """Path and letter of each number of the run that has not ended."""

    def add_message(self, name: str, prefix: str) -> None:
        """Add all fields of a message that is found at `prefix`."""
        fields = self._definition(name).fields
        if not fields:
            self._add(_write_placeholder)
        for field in fields:
            path, kind = prefix + field.name, field.type
            if kind.array:
                self._add(_array_writer(self._definition, kind, attrgetter(path)))
            elif kind.is_message:
                self.add_message(kind.base, f"{path}.")
            elif kind.base in STRINGS:
                self._add(_text_writer(kind.base, attrgetter(path)))
            else:
                self._run.append((path, LETTERS[kind.base]))

    def finish(self) -> list[Writer]:
        """Return the steps."""
        self._end_run()
        return self._steps

    def _add(self, step: Writer) -> None:
        self._end_run()
        self._steps.append(step)

    def _end_run(self) -> None:
        if self._run:
            self._steps.append(_run_writer(self._run))
            self._run = []


def _in_order(steps: list[Writer]) -> Writer:
    if len(steps) == 1:
        return steps[0]

    def write(message: Any, body: bytearray) -> None:
        for step in steps:
            step(message, body)

    return write


def _write_placeholder(_message: Any, body: bytearray) -> None:
    body.append(0)  # ROS 2 gives a message without fields one octet


def _run_writer(run: list[tuple[str, str]]) -> Writer:
    paths, letters = zip(*run, strict=True)
    packs = tuple(struct.Struct(_aligned(letters, start)).pack for start in range(_WIDEST))
    get = attrgetter(*paths)
    if len(paths) == 1:

        def write_one(message: Any, body: bytearray) -> None:
            body += packs[len(body) % _WIDEST](get(message))

        return write_one

    def write(message: Any, body: bytearray) -> None:
        body += packs[len(body) % _WIDEST](*get(message))

    return write


def _aligned(letters: tuple[str, ...], start: int) -> str:
    """Return the format of numbers whose first byte would stand at `start`, with the padding that each needs."""
    written, at = "<", start
    for letter in letters:
        width = struct.calcsize(f"<{letter}")
        padding = -at % width
        written += "x" * padding + letter
        at += padding + width
    return written


def _text_writer(base: str, get: Callable[[Any], Any]) -> Writer:
    encode = _encoded_wide if base == "wstring" else _encoded

    def write(message: Any, body: bytearray) -> None:
        body += _padding(body, 4) + encode(get(message))

    return write


def _encoded(text: str) -> bytes:
    encoded = text.encode()
    return struct.pack("<I", len(encoded) + 1) + encoded + b"\0"


def _encoded_wide(text: str) -> bytes:
    encoded = text.encode("utf-16-le")
    return struct.pack("<I", len(encoded) // 2) + encoded


def _array_writer(definition: _Definitions, kind: FieldType, get: Callable[[Any], Any]) -> Writer:
    write_elements = _elements_writer(definition, kind)
    if kind.array == "fixed":
        return lambda message, body: write_elements(get(message), body)

    def write(message: Any, body: bytearray) -> None:
        values = get(message)
        body += _padding(body, 4) + struct.pack("<I", len(values))
        write_elements(values, body)

    return write


def _elements_writer(definition: _Definitions, kind: FieldType) -> Writer:
    if kind.is_message:
        element = message_writer(definition, kind.base)
    elif kind.base in STRINGS:
        element = _text_writer(kind.base, _itself)
    elif kind.is_octets:
        return _write_octets
    else:
        return _numbers_writer(LETTERS[kind.base])

    def write(values: Any, body: bytearray) -> None:
        for value in values:
            element(value, body)

    return write


def _numbers_writer(letter: str) -> Writer:
    width = struct.calcsize(f"<{letter}")

    def write(values: Any, body: bytearray) -> None:
        if values:
            body += _padding(body, width) + struct.pack(f"<{len(values)}{letter}", *values)

    return write


def _write_octets(values: Any, body: bytearray) -> None:
    body += values


def _itself(value: Any) -> Any:
    return value


def _padding(body: bytearray, width: int) -> bytes:
    return bytes(-len(body) % width)
