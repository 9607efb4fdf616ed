"""The types of an installed ROS 2: its generated Python classes, and their definitions."""

import importlib
from typing import Any

from simconsole.bridge.messages import Definition
from simconsole.bridge.messages.definition import full_name
from simconsole.bridge.messages.rosidl_types import definition_of

_PARTS = {"msg": ("",), "srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}


def load(type_name: str) -> Any:
    """Return the class of a type such as `std_srvs/srv/SetBool`, None where it is not installed."""
    package, kind, name = type_name.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.{kind}"), name, None)
    except ImportError:
        return None


def describe(type_name: str) -> tuple[Definition, ...] | None:
    """Return the definitions of all messages that a type is made of, None where it is not installed."""
    found = load(type_name)
    if found is None:
        return None
    package, kind, name = type_name.split("/")
    definitions: dict[str, Definition] = {}
    for part in _PARTS[kind]:
        whole = getattr(found, part) if part else found
        _collect(full_name(f"{package}/{name}_{part}" if part else f"{package}/{name}"), whole, definitions)
    return tuple(definitions.values())


def _collect(name: str, found: Any, definitions: dict[str, Definition]) -> None:
    definitions[name] = definition_of(name, found.get_fields_and_field_types())
    for field in definitions[name].fields:
        if field.type.is_message and field.type.base not in definitions:
            _collect(field.type.base, load(field.type.base), definitions)
