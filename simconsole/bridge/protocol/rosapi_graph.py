"""What rosapi says about a ROS 2 graph that the server has joined: its nodes, and their parameters.

A parameter of a node is named as rosapi for ROS 2 names it, `/node:parameter`; it is read and set by the node's own
services, so that what rosapi says of it is what the node has done.
"""

from collections.abc import Iterable, Mapping
from typing import Any, Final, NamedTuple

import orjson

from simconsole.bridge.protocol.pending_calls import Forward, NodeRequest, Survey
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

LIST_S: Final = 2.0
"""How long nodes may take to name their parameters; a node that does not say them by then is left out."""
_SERVICES: Final = {
    "GetParameters": "get_parameters",
    "GetParameterTypes": "get_parameter_types",
    "SetParameters": "set_parameters",
    "ListParameters": "list_parameters",
}
"""A node's services for its parameters by their types of rcl_interfaces."""
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
        """Return the value as JSON text."""
        found = next(iter(values["values"]), {"type": _NOT_SET})
        field = _VALUES.get(found["type"])
        return {"value": default or "null" if field is None else orjson.dumps(found[field]).decode()}

    return Forward(_request(node, "GetParameters", names=[parameter]), read)


def has_parameter(name: str) -> Forward:
    """Ask a node whether it has a parameter."""
    node, parameter = _split(name)

    def read(values: dict[str, Any]) -> dict[str, Any]:
        """Return whether any type is that of a set parameter."""
        return {"exists": any(kind != _NOT_SET for kind in values["types"])}

    return Forward(_request(node, "GetParameterTypes", names=[parameter]), read)


def set_parameter(name: str, value: str | None) -> Forward:
    """Have a node set a parameter to a JSON text, None to unset it; what the node refuses fails with its reason.

    Raises:
        RemoteProtocolError: `value` is no JSON, or none that a parameter can have.
    """
    node, parameter = _split(name)

    def read(values: dict[str, Any]) -> dict[str, Any]:
        """Raise RemoteProtocolError with the reason of the node that has refused."""
        for result in values["results"]:
            if not result["successful"]:
                raise RemoteProtocolError(result["reason"] or "the node has refused it")
        return {}

    typed = {"type": _NOT_SET} if value is None else _typed(value)
    return Forward(_request(node, "SetParameters", parameters=[{"name": parameter, "value": typed}]), read)


def list_parameters(nodes: Iterable[str], known: Iterable[str]) -> Survey:
    """Ask all nodes for the names of their parameters; those that are `known` here come first."""
    requests = {node: _request(node, "ListParameters") for node in nodes}
    services = {request.service: node for node, request in requests.items()}

    def read(answers: dict[str, Any]) -> dict[str, Any]:
        """Return the names, those of a node behind the node's own."""
        found = [
            f"{services[service]}:{name}"
            for service, values in sorted(answers.items())
            for name in sorted(values["result"]["names"])
        ]
        return {"names": [*sorted(known), *found]}

    return Survey(list(requests.values()), read, LIST_S)


def _request(node: str, kind: str, **args: Any) -> NodeRequest:
    return NodeRequest(f"{node}/{_SERVICES[kind]}", f"rcl_interfaces/srv/{kind}", args)


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
