"""Definitions from the field types of rosidl's generated Python classes, such as `sequence<double, 3>`."""

import re
from collections.abc import Mapping
from typing import Final, Literal

from simconsole.bridge.messages.definition import OCTETS, Definition, Field, FieldType, full_name
from simconsole.values.errors import BridgeError

_NAMES: Final = {"boolean": "bool", "octet": "byte", "float": "float32", "double": "float64"}
_TYPE: Final = re.compile(
    r"(?:(?P<sequence>sequence)<)?(?P<base>[a-z]\w*(?:/[A-Za-z]\w*)?)(?:<(?P<limit>\d+)>)?"
    r"(?:(?:, (?P<bound>\d+))?>|\[(?P<size>\d+)\])?"
)


def definition_of(name: str, fields: Mapping[str, str]) -> Definition:
    """Return the definition of a message from its fields' spelled types, such as `sequence<double, 3>`.

    Raises:
        BridgeError: a type that no rosidl class has.
    """
    return Definition(name, tuple(Field(key, field_type(text), None) for key, text in fields.items()), {})


def field_type(text: str) -> FieldType:
    """Return one spelled type. Raises BridgeError as `definition_of`."""
    match = _TYPE.fullmatch(text)
    if match is None:
        raise BridgeError(f"{text[:80]!r} is not a type as rosidl spells it")
    array: Literal["", "fixed", "bounded", "unbounded"] = ""
    if match["sequence"]:
        array = "bounded" if match["bound"] else "unbounded"
    elif match["size"]:
        array = "fixed"
    base = match["base"]
    resolved = full_name(base) if "/" in base else _NAMES.get(base, base)
    return FieldType(resolved, array, int(match["bound"] or match["size"] or 0), int(match["limit"] or 0))


def is_same_layout(one: Definition, other: Definition) -> bool:
    """Return whether two definitions have the same fields in CDR: the three names of an octet are one type there."""
    return _layout(one) == _layout(other)


def _layout(definition: Definition) -> list[tuple[str, FieldType]]:
    return [
        (field.name, field.type._replace(base="uint8") if field.type.base in OCTETS else field.type)
        for field in definition.fields
    ]
