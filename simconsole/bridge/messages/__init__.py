"""Message registry: `.msg` definitions, generated types, values in and out."""

from functools import cache

from simconsole.bridge.messages.definition import Definition, FieldType, full_name, parse, parse_all
from simconsole.bridge.messages.registry import Registry, is_stamped
from simconsole.bridge.messages.ros_text import TEXT as ROS_TEXT
from simconsole.bridge.messages.rosapi_text import SERVICES as ROSAPI_SERVICES
from simconsole.bridge.messages.rosapi_text import TYPE_DEF
from simconsole.bridge.messages.service_text import ACTIONS, SERVICES
from simconsole.bridge.messages.vehicle_text import TEXT as VEHICLE_TEXT

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


def standard_registry() -> Registry:
    """Return a new registry with the packages the console speaks; add your own definitions to it."""
    registry = Registry()
    for definition in _standard_definitions():
        registry.add_definition(definition)
    return registry


@cache
def _standard_definitions() -> tuple[Definition, ...]:
    registry = Registry()
    for text in (ROS_TEXT, VEHICLE_TEXT, TYPE_DEF):
        registry.add_all(text)
    for name, text in {**SERVICES, **ROSAPI_SERVICES}.items():
        registry.add_service(name, text)
    for name, text in ACTIONS.items():
        registry.add_action(name, text)
    return tuple(registry.definition(name) for name in registry.names())
