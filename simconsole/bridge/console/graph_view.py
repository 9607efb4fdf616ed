"""What passes between the relay and a ROS 2 graph, and the graph's rules for names and types. No rclpy here."""

import re
from collections.abc import Mapping
from typing import Final, Literal, NamedTuple

from simconsole.bridge.protocol.rosapi_graph import NodeNames

Kind = Literal["topic", "service", "action"]

ANYONE: Final = "graph"
"""The publishing node where ROS does not name it: all unnamed publishers count as one node."""

_MAX_DDS_NAME: Final = 253
"""The longest that other processes find with Fast DDS (of Kilted); of a longer one it cuts the end off."""
LONGEST: Final[Mapping[Kind, int]] = {
    "topic": 247,
    "service": _MAX_DDS_NAME - len("rq" + "Request"),
    "action": _MAX_DDS_NAME - len("rq" + "/_action/cancel_goal" + "Request"),
}
"""Characters of a name: of a topic rmw takes 255, less the eight of its prefix."""
_TYPE: Final = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Z][A-Za-z0-9]*")
_INTERFACES: Final = {"topic": "msg", "service": "srv", "action": "action"}


class GraphView(NamedTuple):
    """What others have in the graph: topics, services, actions with their types, topics listened to, nodes."""

    topics: Mapping[str, str]
    listened: frozenset[str]
    services: Mapping[str, str]
    actions: Mapping[str, str]
    nodes: frozenset[str]
    details: Mapping[str, NodeNames]
    """What each node had about a second ago."""
    latching: Mapping[str, frozenset[bytes]]
    """Identities of the publishers of each topic that is subscribed to as latched."""


NOTHING: Final = GraphView(
    topics={}, listened=frozenset(), services={}, actions={}, nodes=frozenset(), details={}, latching={}
)


class GraphPublisher(NamedTuple):
    """One topic that the relay publishes in the graph."""

    type: str
    latched: bool
    depth: int
    best_effort: bool = False
    deadline_ns: int | None = None
    lifespan_ns: int | None = None


class GraphEntities(NamedTuple):
    """What the relay needs to have in the graph, by name: publishers, and types of topics, services and actions."""

    publishers: dict[str, GraphPublisher]
    subscriptions: dict[str, str]
    services: dict[str, str]
    actions: dict[str, str]


class GraphOperation(NamedTuple):
    """One thing to do in the graph; `data` is CDR, None where something failed and `text` says why.

    send a message; call a service or pursue a goal of the graph; cancel such a goal; reply to a call of the graph;
    tell feedback and the end of a goal of the graph; remark something about a node.
    """

    kind: Literal["send", "call", "goal", "cancel", "reply", "feedback", "end", "remark"]
    name: str
    key: str = ""
    type: str = ""
    data: bytes | None = None
    text: str = ""
    status: int = 0
    timeout_s: float | None = None


def full_type(name: str, kind: Kind) -> str:
    """Return a type in three parts, `std_srvs/SetBool` of a service as `std_srvs/srv/SetBool`."""
    parts = name.split("/")
    return f"{parts[0]}/{_INTERFACES[kind]}/{parts[1]}" if len(parts) == 2 else name


def why_unfit(kind: Kind, name: str, type_name: str) -> str:
    """Return why ROS 2 would refuse a name or a type in three parts, empty if it would not."""
    if len(name) > LONGEST[kind]:
        return f"its name is longer than {LONGEST[kind]} characters"
    found = _TYPE.fullmatch(type_name)
    if found is None or found[1] != _INTERFACES[kind]:
        return f"{type_name[:80]!r} is no type such as package/{_INTERFACES[kind]}/Name"
    return ""
