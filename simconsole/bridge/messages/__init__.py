"""Message registry: `.msg` definitions, generated types, values in and out."""

from simconsole.bridge.messages.definition import Definition, FieldType, full_name, parse, parse_all
from simconsole.bridge.messages.message_registry import Registry, is_stamped
from simconsole.bridge.messages.standard_types import standard_registry

__all__ = [
    "Definition",
    "FieldType",
    "Registry",
    "full_name",
    "is_stamped",
    "parse",
    "parse_all",
    "standard_registry",
]
