"""The types of an installed ROS 2: its generated Python classes, and their definitions."""

import importlib
import importlib.util
import re
import sys
from pathlib import Path
from typing import Any, Final

from simconsole.bridge.messages import Definition
from simconsole.bridge.messages.definition import full_name
from simconsole.bridge.messages.rosidl_types import definition_of

_NAME: Final = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Z][A-Za-z0-9]*")
_PARTS: Final = {"msg": ("",), "srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}


def load(type_name: str) -> Any:
    """Return the class of a type such as `std_srvs/srv/SetBool`, None where it is not installed.

    The name may come from a client: nothing is imported but the package of an interface.
    """
    if _NAME.fullmatch(type_name) is None:
        return None
    package, kind, name = type_name.split("/")
    if f"{package}.{kind}" not in sys.modules and not _has_interfaces(package, kind):
        return None
    try:
        found = getattr(importlib.import_module(f"{package}.{kind}"), name, None)
    except ImportError:
        return None
    return found if all(hasattr(_part(found, part), "get_fields_and_field_types") for part in _PARTS[kind]) else None


def _has_interfaces(package: str, kind: str) -> bool:
    spec = importlib.util.find_spec(package)
    folders = (spec.submodule_search_locations if spec is not None else None) or ()
    return any((Path(folder) / kind / "__init__.py").is_file() for folder in folders)


def _part(found: Any, part: str) -> Any:
    return getattr(found, part, None) if part else found


def describe(type_name: str) -> tuple[Definition, ...] | None:
    """Return the definitions of all messages that a type is made of, None where it is not installed."""
    found = load(type_name)
    if found is None:
        return None
    package, kind, name = type_name.split("/")
    definitions: dict[str, Definition] = {}
    for part in _PARTS[kind]:
        whole = _part(found, part)
        _collect(full_name(f"{package}/{name}_{part}" if part else f"{package}/{name}"), whole, definitions)
    return tuple(definitions.values())


def _collect(name: str, found: Any, definitions: dict[str, Definition]) -> None:
    definitions[name] = definition_of(name, found.get_fields_and_field_types())
    for field in definitions[name].fields:
        if field.type.is_message and field.type.base not in definitions:
            _collect(field.type.base, load(field.type.base), definitions)
