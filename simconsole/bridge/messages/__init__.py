"""Message registry: `.msg` definitions, generated types, values in and out."""

from functools import cache

from simconsole.bridge.messages import (
    autoware_text,
    auv_text,
    geographic_text,
    geometry_text,
    nav_text,
    sensor_text,
    std_text,
    vehicle_text,
    vision_text,
)
from simconsole.bridge.messages.definition import Definition, FieldType, full_name, parse, parse_all
from simconsole.bridge.messages.message_registry import Registry, is_stamped
from simconsole.bridge.messages.rosapi_text import SERVICES as ROSAPI_SERVICES
from simconsole.bridge.messages.rosapi_text import TYPE_DEF
from simconsole.bridge.messages.service_text import ACTIONS, SERVICES

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


_PACKAGES = (
    std_text,
    geometry_text,
    sensor_text,
    nav_text,
    geographic_text,
    auv_text,
    vision_text,
    autoware_text,
    vehicle_text,
)


def standard_registry() -> Registry:
    """Return a new registry with the packages the console speaks; add your own definitions to it."""
    registry = Registry()
    for definition in _standard_definitions():
        registry.add_definition(definition)
    return registry


@cache
def _standard_definitions() -> tuple[Definition, ...]:
    registry = Registry()
    for package in _PACKAGES:
        registry.add_all(package.TEXT)
    registry.add_all(TYPE_DEF)
    for name, text in {**SERVICES, **ROSAPI_SERVICES}.items():
        registry.add_service(name, text)
    for name, text in ACTIONS.items():
        registry.add_action(name, text)
    return tuple(registry.definition(name) for name in registry.names())
