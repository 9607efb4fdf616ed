"""Normalises spellings of other rosbridge dialects to the one that the generated classes read.

Called only for a value that did not fit. It looks at nothing but the fields its definition names, so that a hostile
depth or width costs no more than the definition allows.
"""

from collections.abc import Callable
from typing import Any, Final

from simconsole.bridge.messages.definition import DURATION, FLOATS, HEADER, TIME, Definition, Field
from simconsole.values.units import NS_PER_S

_NAN: Final = float("nan")
_OTHER_TIMES: Final = {"secs": "sec", "nsecs": "nanosec", "nsec": "nanosec"}
"""ROS 1's names, and what viewers (Foxglove, Lichtblick) send."""

Definitions = Callable[[str], Definition]
"""Gives the definition of a type by its full name."""


def normalise(definitions: Definitions, name: str, value: Any, gaps: bool, now_ns: int) -> Any:
    """Return a copy of `value` in which known other spellings are replaced; what is simply wrong stays wrong.

    Replaced: secs, nsecs, nsec of a time, "now" as a time, a header's seq (ROS 1 has it, ROS 2 not), null as NaN for a
    float if `gaps`, a list of integers for an array of bytes.
    """
    if name in (TIME, DURATION):
        return _normalise_time(value, now_ns)
    if not isinstance(value, dict):
        return value
    normalised = dict(value)
    if name == HEADER:
        normalised.pop("seq", None)
    for field in definitions(name).fields:
        if field.name in normalised:
            normalised[field.name] = _normalise_field(definitions, field, normalised[field.name], gaps, now_ns)
    return normalised


def _normalise_field(definitions: Definitions, field: Field, value: Any, gaps: bool, now_ns: int) -> Any:
    kind = field.type
    if kind.is_message:
        if kind.array and isinstance(value, list):
            return [normalise(definitions, kind.base, item, gaps, now_ns) for item in value]
        return normalise(definitions, kind.base, value, gaps, now_ns)
    if kind.is_octets:
        return _normalise_octets(value)
    if gaps and kind.base in FLOATS:
        if value is None and not kind.array:
            return _NAN
        if kind.array and isinstance(value, list):
            return [_NAN if item is None else item for item in value]
    return value


def _normalise_octets(value: Any) -> Any:
    if not isinstance(value, list) or bool in set(map(type, value)):
        return value
    try:
        return bytes(value)
    except (TypeError, ValueError):
        return value


def _normalise_time(value: Any, now_ns: int) -> Any:
    if value == "now":
        return {"sec": now_ns // NS_PER_S, "nanosec": now_ns % NS_PER_S}
    if isinstance(value, dict):
        return {_OTHER_TIMES.get(key, key): part for key, part in value.items()}
    return value
