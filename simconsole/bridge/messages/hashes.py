"""Type hashes of definitions: ROS 1's md5 of the text, ROS 2's RIHS01 of the description (REP-2016).

Two programs whose hashes of a type are equal read each other's messages of it.
"""

import hashlib
import json
from typing import TYPE_CHECKING, Any, Final

from simconsole.bridge.messages.definition import DURATION, HEADER, TIME, Definition, FieldType, parse
from simconsole.bridge.messages.definition_text import ROS1_HEADER

if TYPE_CHECKING:
    from simconsole.bridge.messages.message_registry import Registry

_ROS1_TIMES: Final = {TIME: "time", DURATION: "duration"}
# type_description_interfaces/FieldType; `char` of a .msg is uint8 in IDL.
_TYPE_IDS: Final = {
    "int8": 2,
    "uint8": 3,
    "char": 3,
    "int16": 4,
    "uint16": 5,
    "int32": 6,
    "uint32": 7,
    "int64": 8,
    "uint64": 9,
    "float32": 10,
    "float64": 11,
    "bool": 15,
    "byte": 16,
    "string": 17,
    "wstring": 18,
}
_NESTED: Final = 1
_BOUNDED: Final = 4
"""From a string's number to the bounded string's."""
_ARRAYS: Final = {"": 0, "fixed": 48, "bounded": 96, "unbounded": 144}
_PLACEHOLDER: Final = FieldType("uint8", "", 0, 0)


def md5(registry: "Registry", name: str) -> str:
    """Return ROS 1's hash of a message (genmsg.gentools.compute_md5). Raises BridgeError for an unknown type."""
    definition = registry.definition(name)
    if definition.name == HEADER:
        definition = parse(HEADER, ROS1_HEADER)
    lines = [f"{kind} {constant}={value}" for kind, constant, value in definition.written]
    for field in definition.fields:
        base = _ROS1_TIMES.get(field.type.base, field.type.base)
        if field.type.is_message and base == field.type.base:
            lines.append(f"{md5(registry, base)} {field.name}")
        else:
            size = {"": "", "fixed": f"[{field.type.size}]"}.get(field.type.array, "[]")
            lines.append(f"{base}{size} {field.name}")
    return hashlib.md5("\n".join(lines).encode(), usedforsecurity=False).hexdigest()


def rihs01(registry: "Registry", name: str) -> str:
    """Return ROS 2's hash of a message (rosidl_generator_type_description). Raises BridgeError for an unknown type."""
    first, *others = registry.with_parts(name)
    described = {
        "type_description": _description(first),
        "referenced_type_descriptions": [_description(other) for other in sorted(others, key=lambda one: one.name)],
    }
    return f"RIHS01_{hashlib.sha256(json.dumps(described).encode()).hexdigest()}"


def _description(definition: Definition) -> dict[str, Any]:
    fields = [(field.name, field.type) for field in definition.fields]
    fields = fields or [("structure_needs_at_least_one_member", _PLACEHOLDER)]
    return {"type_name": definition.name, "fields": [{"name": key, "type": _type(kind)} for key, kind in fields]}


def _type(kind: FieldType) -> dict[str, Any]:
    number = _NESTED if kind.is_message else _TYPE_IDS[kind.base]
    return {
        "type_id": number + _ARRAYS[kind.array] + (_BOUNDED if kind.string_limit else 0),
        "capacity": kind.size,
        "string_capacity": kind.string_limit,
        "nested_type_name": kind.base if kind.is_message else "",
    }
