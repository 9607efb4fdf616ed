"""Message registry: `.msg` definitions, generated types, values in and out."""

from functools import cache

from simconsole.bridge.messages.definition import Definition, FieldType, full_name, parse, parse_all
from simconsole.bridge.messages.registry import Registry, is_stamped
from simconsole.bridge.messages.ros_text import TEXT as ROS_TEXT
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
    for name, text in SERVICES.items():
        registry.add_service(name, text)
    for name, text in ACTIONS.items():
        registry.add_action(name, text)
    return registry


@cache
def _standard_definitions() -> tuple[Definition, ...]:
    return (*parse_all(ROS_TEXT), *parse_all(VEHICLE_TEXT))
