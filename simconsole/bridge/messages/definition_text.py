"""Definitions as `.msg` text, in either dialect."""

from collections.abc import Sequence
from typing import Any, Final

import orjson

from simconsole.bridge.messages.definition import DURATION, HEADER, STRINGS, TIME, Definition, Field

RULE: Final = "=" * 80
ROS1_HEADER: Final = "uint32 seq\ntime stamp\nstring frame_id\n"
_ROS1_NAMES: Final = {TIME: "time", DURATION: "duration"}


def text_of(definition: Definition, ros1: bool = False) -> str:
    """Return a definition as text that reads back as the same; ROS 1 knows neither bounds nor defaults."""
    if ros1 and definition.name == HEADER:
        return ROS1_HEADER
    lines = [f"{kind} {name}={value}" for kind, name, value in definition.written]
    lines += [_line(field, ros1) for field in definition.fields]
    return "".join(f"{line}\n" for line in lines)


def full_text(definitions: Sequence[Definition], ros1: bool = False) -> str:
    """Return the first definition's text, then those it uses, each under its name: the form of rosbag and MCAP."""
    first, *others = definitions
    if ros1:
        others = [other for other in others if other.name not in _ROS1_NAMES]
    parts = [f"{RULE}\nMSG: {two_parts(other.name)}\n{text_of(other, ros1)}" for other in others]
    return "".join([text_of(first, ros1), *parts])


def two_parts(name: str) -> str:
    """Return `package/Name`."""
    return name.replace("/msg/", "/")


def _line(field: Field, ros1: bool) -> str:
    kind = field.type
    base = _ROS1_NAMES.get(kind.base, two_parts(kind.base)) if ros1 else two_parts(kind.base)
    if ros1:
        size = {"": "", "fixed": f"[{kind.size}]"}.get(kind.array, "[]")
        return f"{base}{size} {field.name}"
    limit = f"<={kind.string_limit}" if kind.string_limit else ""
    size = {"": "", "fixed": f"[{kind.size}]", "bounded": f"[<={kind.size}]", "unbounded": "[]"}[kind.array]
    default = "" if field.default is None else f" {_default(kind.base, kind.array, field.default)}"
    return f"{base}{limit}{size} {field.name}{default}"


def _default(base: str, array: str, value: Any) -> str:
    if array:
        return orjson.dumps(value).decode()
    if base in STRINGS:
        return f'"{value}"'
    return str(value).lower() if isinstance(value, bool) else str(value)
