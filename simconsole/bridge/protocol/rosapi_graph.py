"""What rosapi says about a ROS 2 graph that the server has joined: its nodes, and their parameters.

A parameter of a node is named as rosapi for ROS 2 names it, `/node:parameter`; it is read and set by the node's own
services, so that what rosapi says of it is what the node has done.
"""

from collections.abc import Mapping
from typing import Any, Final, NamedTuple

import orjson

from simconsole.bridge.protocol.pending_calls import Forward
from simconsole.values.errors import RemoteProtocolError


class NodeNames(NamedTuple):
    """What one node has."""

    publishing: tuple[str, ...]
    subscribing: tuple[str, ...]
    services: tuple[str, ...]


class Unrelayed(NamedTuple):
    """A topic, service or action that is not passed on, and why."""

    type: str
    reason: str


class GraphNames(NamedTuple):
    """The nodes of the graph, and what is not relayed, by name."""

    nodes: Mapping[str, NodeNames]
    unrelayed: Mapping[str, Unrelayed]


NO_GRAPH: Final = GraphNames({}, {})

_NOT_SET, _BOOL, _INTEGER, _DOUBLE, _STRING = 0, 1, 2, 3, 4
_VALUES: Final = {
    1: "bool_value",
    2: "integer_value",
    3: "double_value",
    4: "string_value",
    5: "byte_array_value",
    6: "bool_array_value",
    7: "integer_array_value",
    8: "double_array_value",
    9: "string_array_value",
}
"""Fields of rcl_interfaces/ParameterValue by its type."""
_ARRAY: Final = 5
"""What is added to the type of a value for that of an array of them."""


def is_of_node(name: str) -> bool:
    """Return whether a parameter is one of a node."""
    return ":" in name


def get_parameter(name: str, default: str) -> Forward:
    """Ask a node for a parameter; a `default` stands for one that it does not have."""
    node, parameter = _split(name)

    def read(values: dict[str, Any]) -> dict[str, Any]:
        found = next(iter(values["values"]), {"type": _NOT_SET})
        field = _VALUES.get(found["type"])
        return {"value": default or "null" if field is None else orjson.dumps(found[field]).decode()}

    return Forward(f"{node}/get_parameters", {"names": [parameter]}, read)


def has_parameter(name: str) -> Forward:
    """Ask a node whether it has a parameter."""
    node, parameter = _split(name)

    def read(values: dict[str, Any]) -> dict[str, Any]:
        return {"exists": any(kind != _NOT_SET for kind in values["types"])}

    return Forward(f"{node}/get_parameter_types", {"names": [parameter]}, read)


def set_parameter(name: str, value: str | None) -> Forward:
    """Have a node set a parameter to a JSON text, None to unset it; what the node refuses fails with its reason.

    Raises:
        RemoteProtocolError: `value` is no JSON, or none that a parameter can have.
    """
    node, parameter = _split(name)

    def read(values: dict[str, Any]) -> dict[str, Any]:
        for result in values["results"]:
            if not result["successful"]:
                raise RemoteProtocolError(result["reason"] or "the node has refused it")
        return {}

    typed = {"type": _NOT_SET} if value is None else _typed(value)
    return Forward(f"{node}/set_parameters", {"parameters": [{"name": parameter, "value": typed}]}, read)


def _split(name: str) -> tuple[str, str]:
    node, _, parameter = name.partition(":")
    return "/" + node.strip("/"), parameter


def _typed(text: str) -> dict[str, Any]:
    try:
        value = orjson.loads(text)
    except orjson.JSONDecodeError as error:
        raise RemoteProtocolError(f"value is not JSON: {error}") from None
    kind = _type_of(value)
    if kind is None and isinstance(value, list):
        kinds = {_type_of(item) for item in value}
        kinds = {_DOUBLE} if kinds == {_INTEGER, _DOUBLE} else kinds
        only = kinds.pop() if len(kinds) == 1 else None
        kind = None if only is None else only + _ARRAY
    if kind is None:
        raise RemoteProtocolError("a parameter is a boolean, a number, a text, or an array of one of these")
    return {"type": kind, _VALUES[kind]: value}


def _type_of(value: Any) -> int | None:
    for python, kind in ((bool, _BOOL), (int, _INTEGER), (float, _DOUBLE), (str, _STRING)):
        if isinstance(value, python):
            return kind
    return None
