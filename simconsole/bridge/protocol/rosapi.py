"""rosapi, built in: the services by which clients ask for topics, types, services, nodes, parameters and the time.

The console is the node /simconsole, client number n is /client_n; beside them are the nodes of a ROS 2 graph that it
has joined. Their parameters are theirs; others live as long as the server and mean nothing to the console.
"""

from typing import Any, Final

import orjson

from simconsole.bridge.messages.definition import FieldType
from simconsole.bridge.messages.definition_text import full_text, two_parts
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.client_session import resolve_topic
from simconsole.bridge.protocol.message_encoding import Dialect
from simconsole.bridge.protocol.pending_calls import Forward, Survey
from simconsole.bridge.protocol.rosapi_graph import (
    get_parameter,
    has_parameter,
    is_of_node,
    list_parameters,
    set_parameter,
)
from simconsole.bridge.protocol.server_protocol import Router
from simconsole.bridge.protocol.topic_registry import Topic
from simconsole.values.errors import BridgeError, RemoteProtocolError
from simconsole.values.units import NS_PER_S

NODE: Final = "/simconsole"
UNRELAYED: Final = "/rosapi/unrelayed"
"""Not rosapi's own: what does not cross between the console and the graph that it has joined."""
MAX_PARAMETERS: Final = 256
MAX_PARAMETER: Final = 16_384
_DISTRO: Final = "jazzy"
"""The release whose message definitions the console speaks."""

Fields = dict[str, Any]


class RosApi:
    """Answers for one router."""

    def __init__(self, router: Router) -> None:
        """Add the services to `router`."""
        self._router = router
        self._registry = router.registry
        self._parameters: dict[str, str] = {}
        self._texts: dict[tuple[str, Dialect], str] = {}
        """Full definitions of types that topics have had: a type never changes."""
        for name, type_name, handler, role in (
            ("topics", "Topics", self._topics, Role.VIEW),
            ("topics_for_type", "TopicsForType", self._topics_for_type, Role.VIEW),
            ("topics_and_raw_types", "TopicsAndRawTypes", self._topics_and_raw_types, Role.VIEW),
            ("topic_type", "TopicType", self._topic_type, Role.VIEW),
            ("publishers", "Publishers", self._publishers, Role.VIEW),
            ("subscribers", "Subscribers", self._subscribers, Role.VIEW),
            ("services", "Services", self._services, Role.VIEW),
            ("services_for_type", "ServicesForType", self._services_for_type, Role.VIEW),
            ("service_type", "ServiceType", self._service_type, Role.VIEW),
            ("service_providers", "ServiceProviders", self._service_providers, Role.VIEW),
            ("service_node", "ServiceNode", self._service_node, Role.VIEW),
            ("action_servers", "GetActionServers", self._action_servers, Role.VIEW),
            ("service_host", "ServiceHost", self._service_host, Role.VIEW),
            ("action_type", "ActionType", self._action_type, Role.VIEW),
            ("action_goal_details", "ActionGoalDetails", self._goal_details, Role.VIEW),
            ("action_result_details", "ActionResultDetails", self._result_details, Role.VIEW),
            ("action_feedback_details", "ActionFeedbackDetails", self._feedback_details, Role.VIEW),
            ("interfaces", "Interfaces", self._interfaces, Role.VIEW),
            ("nodes", "Nodes", self._nodes, Role.VIEW),
            ("node_details", "NodeDetails", self._node_details, Role.VIEW),
            ("message_details", "MessageDetails", self._message_details, Role.VIEW),
            ("service_request_details", "ServiceRequestDetails", self._request_details, Role.VIEW),
            ("service_response_details", "ServiceResponseDetails", self._response_details, Role.VIEW),
            ("get_param", "GetParam", self._get_param, Role.VIEW),
            ("has_param", "HasParam", self._has_param, Role.VIEW),
            ("get_param_names", "GetParamNames", self._get_param_names, Role.VIEW),
            ("search_param", "SearchParam", self._search_param, Role.VIEW),
            ("set_param", "SetParam", self._set_param, Role.PUBLISH),
            ("delete_param", "DeleteParam", self._delete_param, Role.PUBLISH),
            ("get_time", "GetTime", self._get_time, Role.VIEW),
            ("get_ros_version", "GetROSVersion", self._get_ros_version, Role.VIEW),
        ):
            router.calls.add_builtin(f"/rosapi/{name}", f"rosapi/{type_name}", handler, role)
        router.calls.add_builtin(UNRELAYED, "simconsole_msgs/Unrelayed", self._unrelayed)

    def _topics(self, args: Fields, dialect: Dialect) -> Fields:
        topics = self._router.topics
        return {"topics": list(topics), "types": [_type_name(topic.type, dialect) for topic in topics.values()]}

    def _topics_for_type(self, args: Fields, dialect: Dialect) -> Fields:
        try:
            wanted = self._registry.resolve(args["type"])
        except BridgeError:
            return {"topics": []}
        return {"topics": [name for name, topic in self._router.topics.items() if topic.type == wanted]}

    def _topics_and_raw_types(self, args: Fields, dialect: Dialect) -> Fields:
        texts = [self._full_text(topic.type, dialect) for topic in self._router.topics.values()]
        return {**self._topics(args, dialect), "typedefs_full_text": texts}

    def _full_text(self, type_name: str, dialect: Dialect) -> str:
        key = (type_name, dialect)
        if key not in self._texts:
            self._texts[key] = full_text(self._registry.with_parts(type_name), dialect == "ros1")
        return self._texts[key]

    def _topic_type(self, args: Fields, dialect: Dialect) -> Fields:
        topic = self._router.topics.get(resolve_topic(args["topic"]))
        return {"type": "" if topic is None else _type_name(topic.type, dialect)}

    def _publishers(self, args: Fields, dialect: Dialect) -> Fields:
        topic = self._topic(args)
        return {"publishers": [node for node in self._node_names() if self._publishes(node, topic)]}

    def _subscribers(self, args: Fields, dialect: Dialect) -> Fields:
        topic = self._topic(args)
        return {"subscribers": [node for node in self._node_names() if self._subscribes(node, topic)]}

    def _topic(self, args: Fields) -> Topic:
        name = resolve_topic(args["topic"])
        topic = self._router.topics.get(name)
        if topic is None:
            raise RemoteProtocolError(f"there is no topic {name}")
        return topic

    def _services(self, args: Fields, dialect: Dialect) -> Fields:
        return {"services": list(self._router.calls.services())}

    def _services_for_type(self, args: Fields, dialect: Dialect) -> Fields:
        wanted = _short(args["type"])
        return {"services": [name for name, kind in self._router.calls.services().items() if _short(kind) == wanted]}

    def _service_type(self, args: Fields, dialect: Dialect) -> Fields:
        return {"type": self._router.calls.services().get(resolve_topic(args["service"]), "")}

    def _service_providers(self, args: Fields, dialect: Dialect) -> Fields:
        # As in rosapi: by type, and by name too since that is what its clients send.
        wanted = args["service"]
        names = [name for name, kind in self._router.calls.services().items() if _short(kind) == _short(wanted)]
        providers = [self._provider(name) for name in names] or [self._provider(resolve_topic(wanted))]
        return {"providers": sorted({provider for provider in providers if provider})}

    def _service_node(self, args: Fields, dialect: Dialect) -> Fields:
        return {"node": self._provider(resolve_topic(args["service"]))}

    def _provider(self, service: str) -> str:
        if service not in self._router.calls.services():
            return ""
        number = self._router.calls.providers().get(service)
        for session in self._router.sessions:
            if session.number == number:
                return self._graph_provider(service) if session.in_graph else f"/client_{number}"
        return NODE

    def _graph_provider(self, service: str) -> str:
        nodes = self._router.graph.nodes.items()
        return next((name for name, node in nodes if service in node.services and name != NODE), "")

    def _action_servers(self, args: Fields, dialect: Dialect) -> Fields:
        return {"action_servers": list(self._router.calls.actions())}

    def _service_host(self, args: Fields, dialect: Dialect) -> Fields:
        known = resolve_topic(args["service"]) in self._router.calls.services()
        return {"host": "localhost" if known else ""}

    def _action_type(self, args: Fields, dialect: Dialect) -> Fields:
        return {"type": self._router.calls.actions().get(resolve_topic(args["action"]), "")}

    def _goal_details(self, args: Fields, dialect: Dialect) -> Fields:
        return {"typedefs": self._part(args["type"], "Goal")}

    def _result_details(self, args: Fields, dialect: Dialect) -> Fields:
        return {"typedefs": self._part(args["type"], "Result")}

    def _feedback_details(self, args: Fields, dialect: Dialect) -> Fields:
        return {"typedefs": self._part(args["type"], "Feedback")}

    def _interfaces(self, args: Fields, dialect: Dialect) -> Fields:
        return {"interfaces": [_type_name(name, dialect) for name in self._registry.names()]}

    def _node_names(self) -> list[str]:
        clients = [f"/client_{session.number}" for session in self._router.sessions if not session.in_graph]
        return [NODE, *clients, *(name for name in self._router.graph.nodes if name != NODE)]

    def _nodes(self, args: Fields, dialect: Dialect) -> Fields:
        return {"nodes": self._node_names()}

    def _node_details(self, args: Fields, dialect: Dialect) -> Fields:
        node = args["node"]
        if node not in self._node_names():
            raise RemoteProtocolError(f"there is no node {node[:80]}")
        topics = self._router.topics.items()
        return {
            "subscribing": [name for name, topic in topics if self._subscribes(node, topic)],
            "publishing": [name for name, topic in topics if self._publishes(node, topic)],
            "services": [name for name in self._router.calls.services() if self._provider(name) == node],
        }

    def _publishes(self, node: str, topic: Topic) -> bool:
        if node == NODE:
            return topic.owned and topic.command is None
        known = self._router.graph.nodes.get(node)
        return topic.name in known.publishing if known else int(node.rpartition("_")[2]) in topic.publishers

    def _subscribes(self, node: str, topic: Topic) -> bool:
        if node == NODE:
            return topic.command is not None
        known = self._router.graph.nodes.get(node)
        return topic.name in known.subscribing if known else int(node.rpartition("_")[2]) in topic.subscribers

    def _unrelayed(self, args: Fields, dialect: Dialect) -> Fields:
        found = self._router.graph.unrelayed
        return {
            "names": list(found),
            "types": [_type_name(each.type, dialect) for each in found.values()],
            "reasons": [each.reason for each in found.values()],
        }

    def _message_details(self, args: Fields, dialect: Dialect) -> Fields:
        return {"typedefs": self._typedefs(self._registry.resolve(args["type"]))}

    def _request_details(self, args: Fields, dialect: Dialect) -> Fields:
        return {"typedefs": self._part(args["type"], "Request")}

    def _response_details(self, args: Fields, dialect: Dialect) -> Fields:
        return {"typedefs": self._part(args["type"], "Response")}

    def _part(self, type_name: str, part: str) -> list[Fields]:
        full = self._registry.part(type_name, part)
        if full is None:
            raise RemoteProtocolError(f"type {type_name[:80]} is not known here")
        return self._typedefs(full)

    def _typedefs(self, name: str) -> list[Fields]:
        return [
            {
                "type": _type_name(definition.name, "ros1"),
                "fieldnames": [field.name for field in definition.fields],
                "fieldtypes": [_type_name(field.type.base, "ros1") for field in definition.fields],
                "fieldarraylen": [_array_length(field.type) for field in definition.fields],
                "examples": [_example(field.type) for field in definition.fields],
                "constnames": list(definition.constants),
                "constvalues": [str(value) for value in definition.constants.values()],
            }
            for definition in self._registry.with_parts(name)
        ]

    def _is_of_node(self, name: str) -> bool:
        return bool(self._router.graph.nodes) and is_of_node(name)

    def _get_param(self, args: Fields, dialect: Dialect) -> Fields | Forward:
        if self._is_of_node(args["name"]):
            return get_parameter(args["name"], args["default_value"] or args["default"])
        return {"value": self._parameters.get(args["name"]) or args["default_value"] or args["default"] or "null"}

    def _has_param(self, args: Fields, dialect: Dialect) -> Fields | Forward:
        if self._is_of_node(args["name"]):
            return has_parameter(args["name"])
        return {"exists": args["name"] in self._parameters}

    def _get_param_names(self, args: Fields, dialect: Dialect) -> Survey:
        return list_parameters(self._router.graph.nodes, self._parameters)

    def _search_param(self, args: Fields, dialect: Dialect) -> Fields:
        # ROS 1 searches upwards through the namespaces of the calling node; all nodes here are at the root.
        name = args["name"]
        found = next((known for known in (name, f"/{name}") if known in self._parameters), "")
        return {"global_name": found}

    def _set_param(self, args: Fields, dialect: Dialect) -> Fields | Forward:
        name, value = args["name"], args["value"]
        if self._is_of_node(name):
            return set_parameter(name, value)
        if not name or len(name) + len(value) > MAX_PARAMETER:
            raise RemoteProtocolError(f"a parameter has a name and at most {MAX_PARAMETER} characters")
        if name not in self._parameters and len(self._parameters) >= MAX_PARAMETERS:
            raise RemoteProtocolError(f"there are {MAX_PARAMETERS} parameters already, the most allowed")
        try:
            orjson.loads(value)
        except orjson.JSONDecodeError as error:
            raise RemoteProtocolError(f"value is not JSON: {error}") from None
        self._parameters[name] = value
        return {}

    def _delete_param(self, args: Fields, dialect: Dialect) -> Fields | Forward:
        if self._is_of_node(args["name"]):
            return set_parameter(args["name"], None)
        self._parameters.pop(args["name"], None)
        return {}

    def _get_time(self, args: Fields, dialect: Dialect) -> Fields:
        seconds, nanoseconds = divmod(self._router.ros_time_ns, NS_PER_S)
        return {"time": {"sec": seconds, "nanosec": nanoseconds}}

    def _get_ros_version(self, args: Fields, dialect: Dialect) -> Fields:
        return {"version": 1, "distro": "noetic"} if dialect == "ros1" else {"version": 2, "distro": _DISTRO}


def _type_name(name: str, dialect: Dialect) -> str:
    return two_parts(name) if dialect == "ros1" else name


def _short(name: str) -> str:
    return name.replace("/srv/", "/")


def _array_length(kind: FieldType) -> int:
    """Return rosapi's number for an array: -1 none, 0 any length."""
    return kind.size if kind.array == "fixed" else 0 if kind.array else -1


def _example(kind: FieldType) -> str:
    if kind.array:
        return "[]"
    if kind.is_message:
        return "{}"
    return {"bool": "False", "string": "", "wstring": "", "float32": "0.0", "float64": "0.0"}.get(kind.base, "0")
