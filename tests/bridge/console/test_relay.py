"""The relay between a console's bridge and a ROS 2 graph, the graph being played by the tests."""

from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.graph_view import NOTHING, GraphOperation, GraphPublisher
from simconsole.bridge.console.relay import MAX_NODES, Relay
from simconsole.bridge.messages import Definition, standard_registry
from simconsole.bridge.messages.cdr import deserialize, serialize
from simconsole.bridge.messages.rosidl_types import definition_of
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.operations import ABORTED, CANCELED, SUCCEEDED
from simconsole.values.signals import Event, RemoteKind

GRIP = (definition_of("demo/msg/Grip", {"force": "double"}),)
NOT_INSTALLED = {"tf2_msgs/msg/TFMessage"}
PARTS = {"msg": ("",), "srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}
FIBONACCI = "example_interfaces/action/Fibonacci"
ADD = "example_interfaces/srv/AddTwoInts"
MS = 1_000_000


def describe(name: str) -> tuple[Definition, ...] | None:
    registry = standard_registry()
    package, kind, rest = name.split("/")
    if name == "demo/msg/Grip":
        return GRIP
    if name in NOT_INSTALLED or package in ("simconsole_msgs", "nowhere"):
        return None
    if name == "std_msgs/msg/Float64":
        return (definition_of(name, {"data": "float"}),)
    return tuple(registry.definition(f"{package}/msg/{rest}{part}") for part in PARTS[kind])


class Graph:
    """A relay at work and what it ordered."""

    def __init__(self, bridge: ConsoleBridge, role: Role = Role.CONTROL) -> None:
        self.bridge = bridge
        self.woken = 0
        self.now_ns = 0
        self.relay = Relay(bridge, role, describe, self._wake)

    def _wake(self) -> None:
        self.woken += 1

    def observe(self, **view: Any) -> Any:
        return self.relay.observe(NOTHING._replace(**view), self.now_ns)

    def operations(self) -> list[GraphOperation]:
        return [operation for operation in self.relay.operations(self.now_ns) if operation.kind != "remark"]

    def remarks(self) -> list[tuple[str, str]]:
        return [
            (operation.name, operation.text)
            for operation in self.relay.operations(self.now_ns)
            if operation.kind == "remark"
        ]

    def receive(
        self, topic: str, type_name: str, plain: dict[str, Any], node: str = "/driver", latched_by: bytes | None = None
    ) -> None:
        full = self.bridge.router.registry.resolve(type_name)
        self.relay.receive(topic, full, self.cdr(type_name, plain), node, latched_by, self.now_ns)

    def cdr(self, type_name: str, plain: dict[str, Any]) -> bytes:
        registry = self.bridge.router.registry
        return serialize(registry, type_name, registry.from_plain(type_name, plain))

    def plain(self, type_name: str, data: bytes | None) -> dict[str, Any]:
        assert data is not None
        return deserialize(self.bridge.router.registry, type_name, data)


@pytest.fixture
def graph(bridge: ConsoleBridge) -> Graph:
    return Graph(bridge)


def test_what_the_console_wants_in_the_graph(graph: Graph) -> None:
    entities = graph.observe()
    assert entities.publishers["/odom"] == GraphPublisher("nav_msgs/msg/Odometry", False, 10)
    assert entities.subscriptions["/cmd_vel"] == "geometry_msgs/msg/Twist"
    assert "/tf_static" not in entities.publishers
    assert entities.services == entities.actions == {}
    ((_, text),) = graph.remarks()
    assert text.startswith("not relayed: ")
    assert "/tf_static: this ROS 2 has no type tf2_msgs/msg/TFMessage" in text
    assert "std_msgs/msg/Float64 has other fields in this ROS 2" in text
    assert graph.observe() == entities
    assert graph.remarks() == []


def test_outputs_are_sent_while_somebody_listens(graph: Graph, snapshot: Any) -> None:
    graph.observe()
    graph.bridge.publish(snapshot(250), 0)
    assert [operation.name for operation in graph.operations()] == ["/route", "/map/markers", "/console/mode"], (
        "they are latched"
    )
    graph.observe(listened=frozenset({"/odom"}))
    graph.bridge.publish(snapshot(500, x_m=3.0), 0)
    mode, operation = graph.operations()
    assert mode.name == "/console/mode"
    assert (operation.kind, operation.name) == ("send", "/odom")
    assert graph.plain("nav_msgs/Odometry", operation.data)["pose"]["pose"]["position"]["x"] == 3.0
    assert graph.woken
    graph.observe()
    graph.bridge.publish(snapshot(750), 0)
    assert [operation.name for operation in graph.operations()] == ["/console/mode"]


def test_latched_outputs_are_sent_at_once(graph: Graph, snapshot: Any) -> None:
    NOT_INSTALLED.clear()
    try:
        graph.bridge.publish(snapshot(1), 0)
        assert graph.observe().publishers["/tf_static"] == GraphPublisher("tf2_msgs/msg/TFMessage", True, 1)
        assert [operation.name for operation in graph.operations()] == [
            "/console/mode",
            "/map/markers",
            "/route",
            "/tf_static",
        ]
    finally:
        NOT_INSTALLED.add("tf2_msgs/msg/TFMessage")


def test_a_node_commands(graph: Graph) -> None:
    graph.observe()
    graph.receive("/cmd_vel", "geometry_msgs/Twist", {"linear": {"x": 2.0}})
    command = graph.bridge.inputs.command
    assert (command.kind, command.speed_mps, command.sequence) == (RemoteKind.TWIST, 2.0, 1.0)
    graph.receive("/cmd_vel", "geometry_msgs/Twist", {"linear": {"x": 3.0}}, node="/other")
    assert graph.bridge.inputs.command.speed_mps == 2.0
    assert graph.remarks()[-1] == ("/other", "publish /cmd_vel: another client commands the console")


def test_commands_are_checked(graph: Graph) -> None:
    graph.observe()
    graph.receive("/cmd_vel", "geometry_msgs/Twist", {"linear": {"x": float("nan")}})
    graph.receive("/cmd_vel", "geometry_msgs/Twist", {"linear": {"x": 1e6}})
    graph.relay.receive("/cmd_vel", "geometry_msgs/msg/Twist", b"\0\1\0\0\0", "/driver", None, 0)
    graph.relay.receive("/nowhere", "std_msgs/msg/Empty", b"", "/driver", None, 0)
    assert graph.bridge.inputs.command.sequence == 0.0
    assert graph.bridge.inputs.command.refused == 2.0  # what is no message at all is nobody's command
    said = [text for _, text in graph.remarks()]
    assert [text for text in said if "linear.x" in text or "CDR" in text] == said[-3:]


def test_a_commander_that_vanishes(graph: Graph) -> None:
    graph.observe(nodes=frozenset({"/driver"}))
    graph.receive("/cmd_vel", "geometry_msgs/Twist", {"linear": {"x": 2.0}})
    graph.observe(nodes=frozenset({"/driver"}))
    assert graph.bridge.inputs.take(1)[1].events == 0.0
    graph.observe()
    assert graph.bridge.inputs.take(2)[1].events == float(Event.COMMANDER_LOST)


def test_many_nodes_count_as_one(graph: Graph) -> None:
    graph.observe()
    before = len(graph.bridge.router.sessions)
    for number in range(MAX_NODES + 9):
        graph.receive("/console/request", "std_msgs/String", {"data": "mark"}, node=f"/n{number}")
    assert len(graph.bridge.router.sessions) == before + MAX_NODES


def test_a_viewing_graph_does_nothing(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    graph, peer = Graph(bridge, Role.VIEW), join(bridge)
    peer.send(op="subscribe", topic="/chatter", type="std_msgs/String")
    peer.send(op="advertise_service", service="/add", type=ADD)
    entities = graph.observe(topics={"/talk": "std_msgs/msg/String"}, services={"/sum": ADD})
    assert (entities.subscriptions, entities.services) == ({}, {})
    assert bridge.router.topic("/talk") is None
    graph.receive("/cmd_vel", "geometry_msgs/Twist", {})
    assert bridge.inputs.command.sequence == 0.0
    assert "needs the role publish" in graph.remarks()[-1][1]


def test_a_publishing_graph_commands_nothing(bridge: ConsoleBridge) -> None:
    graph = Graph(bridge, Role.PUBLISH)
    assert graph.observe().subscriptions == {}
    graph.receive("/cmd_vel", "geometry_msgs/Twist", {"linear": {"x": 1.0}})
    assert bridge.inputs.command.sequence == 0.0


def test_topics_between_graph_and_clients(graph: Graph, join: Callable[..., Any]) -> None:
    peer = join(graph.bridge)
    view = {"topics": {"/grip": "demo/msg/Grip", "/odom": "nav_msgs/msg/Odometry"}, "listened": frozenset({"/grip"})}
    graph.observe(**view)
    peer.send(op="subscribe", topic="/grip")  # its type is known from the graph
    assert graph.observe(**view).subscriptions["/grip"] == "demo/msg/Grip"
    graph.receive("/grip", "demo/Grip", {"force": 1.5})
    assert [message["msg"] for message in peer.heard()] == [{"force": 1.5}]
    assert graph.operations() == []
    peer.publish("/grip", {"force": 2.5})
    peer.send(op="advertise", topic="/grip", type="demo/Grip")
    assert graph.observe(**view).publishers["/grip"] == GraphPublisher("demo/msg/Grip", False, 100)
    peer.publish("/grip", {"force": 3.5})
    graph.receive("/grip", "demo/Grip", {"force": 4.5})
    peer.publish("/grip", {"force": 5.5})
    sent = [graph.plain("demo/Grip", operation.data)["force"] for operation in graph.operations()]
    assert sent == [3.5, 5.5]  # what came from the graph does not go back
    assert [message["msg"]["force"] for message in peer.heard()] == [2.5, 3.5, 4.5, 5.5]


def test_latched_topics_of_the_graph_reach_every_later_subscriber(graph: Graph, join: Callable[..., Any]) -> None:
    view = {"topics": {"/map": "std_msgs/msg/String"}, "latching": {"/map": frozenset({b"one", b"two"})}}
    graph.observe(**view)
    first, second, third = join(graph.bridge), join(graph.bridge), join(graph.bridge)
    first.send(op="subscribe", topic="/map")
    graph.observe(**view)
    for text, publisher in (("old", b"one"), ("new", b"one"), ("other", b"two")):
        graph.receive("/map", "std_msgs/String", {"data": text}, latched_by=publisher)
    second.send(op="subscribe", topic="/map")
    assert [message["msg"]["data"] for message in first.heard()] == ["old", "new", "other"]
    assert [message["msg"]["data"] for message in second.heard()] == ["new", "other"], "of each publisher the newest"
    second.send(op="advertise", topic="/map", type="std_msgs/String", latch=True)
    graph.observe(**view)
    assert graph.operations() == [], "the graph is not sent its own"
    second.publish("/map", {"data": "here"})
    graph.observe(topics=view["topics"], latching={"/map": frozenset({b"two"})})
    third.send(op="subscribe", topic="/map")
    assert [message["msg"]["data"] for message in third.heard()] == ["other", "here"], "one publisher has left"
    assert [graph.plain("std_msgs/String", operation.data)["data"] for operation in graph.operations()] == ["here"]


def test_what_leaves_the_graph_is_no_longer_advertised(graph: Graph) -> None:
    graph.observe(topics={"/grip": "demo/msg/Grip"}, services={"/sum": ADD}, actions={"/go": FIBONACCI})
    router = graph.bridge.router
    assert router.topic("/grip") is not None
    assert (router.calls.services()["/sum"], router.calls.actions()) == (ADD, {"/go": FIBONACCI})
    graph.observe()
    assert router.topic("/grip") is None
    assert ("/sum" in router.calls.services(), router.calls.actions()) == (False, {})


def test_what_the_graph_would_refuse_is_said_once_to_whose_it_is(graph: Graph, join: Callable[..., Any]) -> None:
    peer, other = join(graph.bridge), join(graph.bridge)
    long = "/" + "n" * 250
    peer.send(op="advertise", topic=long, type="std_msgs/String")
    peer.send(op="advertise_service", service="/bad", type="a/b/c/d")
    for _ in range(2):
        entities = graph.observe()
    assert (long in entities.publishers, entities.services) == (False, {})
    assert [message["msg"].partition("graph: ")[2] for message in peer.heard()] == [
        "its name is longer than 247 characters",
        "'a/b/c/d' is no type such as package/srv/Name",
    ]
    other.send(op="subscribe", topic=long)
    graph.observe()
    assert [message["op"] for message in other.heard()] == ["status"]
    assert peer.heard() == []


def test_what_the_graph_could_not_make_is_said(graph: Graph, join: Callable[..., Any]) -> None:
    peer = join(graph.bridge)
    peer.send(op="advertise", topic="/grip", type="std_msgs/String")
    graph.relay.failed("topic", "/grip", "it broke", 0)
    assert "/grip" in graph.observe().publishers, "it is tried again"
    assert [message["msg"] for message in peer.heard()] == ["/grip is not relayed to the ROS 2 graph: it broke"]
    graph.relay.failed("topic", "/grip", "", 0)
    graph.observe()
    graph.relay.failed("topic", "/grip", "it broke again", 0)
    graph.observe()
    assert [message["msg"][-5:] for message in peer.heard()] == ["again"]


def test_a_message_of_a_type_that_the_topic_had_before(graph: Graph, join: Callable[..., Any]) -> None:
    peer = join(graph.bridge)
    peer.send(op="subscribe", topic="/turns", type="std_msgs/Int32")
    graph.relay.receive("/turns", "std_msgs/msg/String", graph.cdr("std_msgs/String", {"data": "old"}), "/n", None, 0)
    assert peer.heard() == []


def test_what_somebody_has_already_is_left_to_them(graph: Graph, join: Callable[..., Any]) -> None:
    peer = join(graph.bridge)
    peer.send(op="advertise", topic="/chatter", type="std_msgs/Int8")
    peer.send(op="advertise_service", service="/add", type=ADD)
    graph.observe(
        topics={"/chatter": "std_msgs/msg/String", "/odd": "nowhere/msg/Odd"},
        services={"/add": ADD},
    )
    assert graph.bridge.router.calls.providers() == {"/add": peer.session.number}
    topics = graph.bridge.router.topics
    assert ("/odd" in topics, topics["/chatter"].type) == (False, "std_msgs/msg/Int8")


def test_clients_call_services_of_the_graph(graph: Graph, join: Callable[..., Any]) -> None:
    peer = join(graph.bridge)
    graph.observe(services={"/sum": ADD})
    for number in range(3):
        peer.send(op="call_service", service="/sum", id=number, args={"a": 1, "b": number})
    operations = graph.operations()
    assert {(operation.kind, operation.name, operation.type) for operation in operations} == {("call", "/sum", ADD)}
    assert graph.plain("example_interfaces/AddTwoInts_Request", operations[2].data) == {"a": 1, "b": 2}
    answer = graph.cdr("example_interfaces/AddTwoInts_Response", {"sum": 3})
    graph.relay.calls.service_responded(operations[2].key, "/sum", answer, "", 0)
    graph.relay.calls.service_responded(operations[0].key, "/sum", None, "it broke", 0)
    heard = {message["id"]: (message["result"], message["values"]) for message in peer.heard()}
    assert heard == {2: (True, {"sum": 3}), 0: (False, "it broke")}
    graph.observe()  # the third is never answered: the service is gone
    assert peer.heard()[0]["result"] is False


def test_the_graph_calls_services_of_clients(graph: Graph, join: Callable[..., Any]) -> None:
    peer = join(graph.bridge)
    peer.send(op="advertise_service", service="/add", type="example_interfaces/AddTwoInts")
    assert graph.observe().services == {"/add": ADD}
    request = graph.cdr("example_interfaces/AddTwoInts_Request", {"a": 2, "b": 3})
    for key in ("one", "two", "three"):
        graph.relay.calls.call_service(key, "/add", request, 0)
    first, second, third = peer.heard()
    assert first["args"] == {"a": 2, "b": 3}
    peer.send(op="service_response", service="/add", id=first["id"], values={"sum": 5}, result=True)
    peer.send(op="service_response", service="/add", id=second["id"], values="no", result=False)
    peer.send(op="service_response", service="/add", id=third["id"], values={"sum": "x"}, result=True)
    good, bad, wrong = graph.operations()
    assert (good.kind, good.key, graph.plain("example_interfaces/AddTwoInts_Response", good.data)) == (
        "reply", "one", {"sum": 5},
    )  # fmt: skip
    assert (bad.key, bad.data, bad.text) == ("two", None, "no")
    assert (wrong.key, wrong.data) == ("three", None)
    graph.relay.calls.call_service("four", "/add", b"", 0)
    graph.relay.calls.call_service("five", "/none", request, 0)
    assert [(operation.key, operation.data) for operation in graph.operations()] == [("four", None), ("five", None)]


def test_clients_pursue_goals_in_the_graph(graph: Graph, join: Callable[..., Any]) -> None:
    peer = join(graph.bridge)
    graph.observe(actions={"/go": FIBONACCI})
    for name in ("g", "h"):
        peer.send(op="send_action_goal", action="/go", action_type=FIBONACCI, id=name, args={"order": 3}, feedback=True)
    peer.send(op="cancel_action_goal", action="/go", id="h")
    goal, other, cancel = graph.operations()
    assert (goal.kind, goal.name, goal.type, cancel.kind, cancel.key) == ("goal", "/go", FIBONACCI, "cancel", other.key)
    assert graph.plain("example_interfaces/Fibonacci_Goal", goal.data) == {"order": 3}
    sequence = graph.cdr("example_interfaces/Fibonacci_Result", {"sequence": [0, 1, 1]})
    graph.relay.calls.feedback_received(goal.key, "/go", sequence, 0)
    graph.relay.calls.goal_ended(goal.key, "/go", sequence, SUCCEEDED, "", 0)
    graph.relay.calls.goal_ended(other.key, "/go", None, CANCELED, "gone", 0)
    feedback, result, cancelled = peer.heard()
    assert feedback == {"op": "action_feedback", "action": "/go", "id": "g", "values": {"sequence": [0, 1, 1]}}
    assert (result["id"], result["status"], result["values"]) == ("g", SUCCEEDED, {"sequence": [0, 1, 1]})
    assert (cancelled["id"], cancelled["status"], cancelled["result"]) == ("h", CANCELED, False)


def test_the_graph_pursues_goals_of_clients(graph: Graph, join: Callable[..., Any]) -> None:
    peer = join(graph.bridge)
    peer.send(op="advertise_action", action="/go", type=FIBONACCI)
    assert graph.observe().actions == {"/go": FIBONACCI}
    goal = graph.cdr("example_interfaces/Fibonacci_Goal", {"order": 3})
    graph.relay.calls.send_goal("one", "/go", goal, 0)
    graph.relay.calls.send_goal("two", "/go", b"", 0)
    graph.relay.calls.cancel("one", "/go", 0)
    asked, cancel = peer.heard()
    assert (asked["args"], asked["feedback"], cancel["id"]) == ({"order": 3}, True, asked["id"])
    told = {"action": "/go", "id": asked["id"], "values": {"sequence": [0, 1]}}
    peer.send(op="action_feedback", **told)
    peer.send(op="action_result", status=SUCCEEDED, result=True, **told)
    wrong, feedback, end = graph.operations()
    assert (wrong.kind, wrong.key, wrong.data, wrong.status) == ("end", "two", None, ABORTED)
    assert (feedback.kind, feedback.key) == ("feedback", "one")
    assert (end.kind, end.key, end.status) == ("end", "one", SUCCEEDED)
    assert graph.plain("example_interfaces/Fibonacci_Result", end.data) == {"sequence": [0, 1]}


def test_a_service_that_leaves_with_a_call_on_its_way(graph: Graph, join: Callable[..., Any]) -> None:
    peer = join(graph.bridge)
    graph.observe(services={"/sum": ADD})
    peer.send(op="call_service", service="/sum", id=1, args={"a": 1})
    graph.observe()
    (operation,) = graph.operations()
    assert (operation.kind, operation.data, operation.text) == ("call", None, "it has left the graph")
    graph.relay.calls.service_responded(operation.key, "/sum", b"\0\1\0\0", "", 0)  # nobody waits for it any more
    assert [message["result"] for message in peer.heard()] == [False]


def test_leaving(graph: Graph) -> None:
    graph.observe(nodes=frozenset({"/driver"}))
    graph.receive("/cmd_vel", "geometry_msgs/Twist", {"linear": {"x": 2.0}})
    graph.relay.leave(10 * MS)
    assert graph.bridge.router.sessions == ()
    assert graph.bridge.inputs.take(1)[1].events == float(Event.COMMANDER_LOST)


def test_log_of_the_graph_reaches_clients_and_quality_of_service_the_graph(
    graph: Graph, join: Callable[..., Any]
) -> None:
    client = join(graph.bridge)
    qos = {"reliability": "best_effort", "deadline": 0.5, "lifespan": "infinite"}
    client.send(op="advertise", topic="/numbers", type="std_msgs/Int32", qos=qos)
    client.send(op="subscribe", topic="/rosout")
    entities = graph.observe(topics={"/rosout": "rcl_interfaces/msg/Log"})
    assert entities.subscriptions["/rosout"] == "rcl_interfaces/msg/Log"
    offer = entities.publishers["/numbers"]
    assert (offer.best_effort, offer.deadline_ns, offer.lifespan_ns) == (True, 500_000_000, None)
    assert graph.bridge.router.topics["/rosout"].publishers
