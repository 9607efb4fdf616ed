"""rosapi with a graph that the tests play: nodes, their parameters, and what is not relayed."""

from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.protocol.rosapi_graph import LIST_S, NO_GRAPH, GraphNames, NodeNames, Unrelayed

LIST = "list_parameters"
PARAMETER_SERVICES = {
    "get_parameters": "GetParameters",
    "set_parameters": "SetParameters",
    "get_parameter_types": "GetParameterTypes",
}
TALKER = NodeNames(("/chatter",), ("/odom",), ("/talker/set_parameters", "/flip"))


class Graph:
    """A provider that stands for the node /talker."""

    def __init__(self, bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
        self.node, self.peer = join(bridge), join(bridge)
        self.node.session.in_graph = True
        bridge.router.graph = GraphNames(
            {"/simconsole": TALKER, "/talker": TALKER}, {"/tf": Unrelayed("tf2_msgs/msg/TFMessage", "not installed")}
        )
        for name, kind in PARAMETER_SERVICES.items():
            self.node.send(op="advertise_service", service=f"/talker/{name}", type=f"rcl_interfaces/srv/{kind}")

    def ask(self, service: str, /, **args: Any) -> Any:
        self.peer.send(op="call_service", service=f"/rosapi/{service}", args=args)
        heard = self.peer.heard()
        return heard[0] if heard else None

    def forwarded(self, answer: dict[str, Any] | str, service: str, **args: Any) -> tuple[Any, Any, Any]:
        """What the node is asked, and what becomes of its answer."""
        assert self.ask(service, **args) is None
        (asked,) = self.node.heard()
        is_good = isinstance(answer, dict)
        self.node.send(
            op="service_response", service=asked["service"], id=asked["id"], values=answer, result=is_good
        )  # fmt: skip
        (heard,) = self.peer.heard()
        return asked["args"], heard["result"], heard["values"]


@pytest.fixture
def graph(bridge: ConsoleBridge, join: Callable[..., Any]) -> Graph:
    return Graph(bridge, join)


def test_nodes_of_the_graph(graph: Graph) -> None:
    nodes = graph.ask("nodes")["values"]["nodes"]
    assert nodes == ["/simconsole", f"/client_{graph.peer.session.number}", "/talker"]
    graph.node.send(op="advertise", topic="/chatter", type="std_msgs/String")
    graph.node.send(op="advertise_service", service="/flip", type="std_srvs/SetBool")
    assert graph.ask("publishers", topic="/chatter")["values"]["publishers"] == ["/talker"]
    assert graph.ask("subscribers", topic="/odom")["values"]["subscribers"] == ["/talker"]
    assert graph.ask("service_node", service="/flip")["values"]["node"] == "/talker"
    assert graph.ask("service_node", service="/talker/get_parameters")["values"]["node"] == ""  # not known whose
    details = graph.ask("node_details", node="/talker")["values"]
    assert details == {"publishing": ["/chatter"], "subscribing": ["/odom"], "services": list(TALKER.services)[::-1]}


def test_what_is_not_relayed(graph: Graph) -> None:
    types, reasons = ["tf2_msgs/msg/TFMessage"], ["not installed"]
    assert graph.ask("unrelayed")["values"] == {"names": ["/tf"], "types": types, "reasons": reasons}


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ({"type": 1, "bool_value": True}, "true"),
        ({"type": 2, "integer_value": 3}, "3"),
        ({"type": 9, "string_array_value": ["a"]}, '["a"]'),
        ({"type": 0}, "null"),
    ],
)
def test_a_parameter_of_a_node_is_read(graph: Graph, value: dict[str, Any], text: str) -> None:
    asked, result, values = graph.forwarded({"values": [value]}, "get_param", name="/talker:rate")
    assert (asked, result, values) == ({"names": ["rate"]}, True, {"value": text})


def test_a_default_for_a_parameter_that_a_node_does_not_have(graph: Graph) -> None:
    _, _, values = graph.forwarded({"values": []}, "get_param", name="talker:rate", default_value="7")
    assert values == {"value": "7"}


@pytest.mark.parametrize(("types", "exists"), [([3], True), ([0], False), ([], False)])
def test_whether_a_node_has_a_parameter(graph: Graph, types: list[int], exists: bool) -> None:
    _, _, values = graph.forwarded({"types": types}, "has_param", name="/talker:rate")
    assert values == {"exists": exists}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("true", {"type": 1, "bool_value": True}),
        ("3", {"type": 2, "integer_value": 3}),
        ("2.5", {"type": 3, "double_value": 2.5}),
        ('"a"', {"type": 4, "string_value": "a"}),
        ("[true]", {"type": 6, "bool_array_value": [True]}),
        ("[1, 2]", {"type": 7, "integer_array_value": [1, 2]}),
        ("[1, 2.5]", {"type": 8, "double_array_value": [1, 2.5]}),
        ('["a"]', {"type": 9, "string_array_value": ["a"]}),
    ],
)
def test_a_parameter_of_a_node_is_set(graph: Graph, text: str, value: dict[str, Any]) -> None:
    answer = {"results": [{"successful": True, "reason": ""}]}
    asked, result, _ = graph.forwarded(answer, "set_param", name="/talker:rate", value=text)
    assert (asked, result) == ({"parameters": [{"name": "rate", "value": value}]}, True)


def test_a_parameter_of_a_node_is_unset(graph: Graph) -> None:
    answer = {"results": [{"successful": True, "reason": ""}]}
    asked, result, _ = graph.forwarded(answer, "delete_param", name="/talker:rate")
    assert (asked["parameters"][0]["value"], result) == ({"type": 0}, True)


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        ({"results": [{"successful": False, "reason": "read-only"}]}, "read-only"),
        ({"results": [{"successful": False, "reason": ""}]}, "the node has refused it"),
        ("it has gone", "it has gone"),
    ],
)
def test_a_parameter_that_a_node_refuses_fails(graph: Graph, answer: Any, why: str) -> None:
    _, result, values = graph.forwarded(answer, "set_param", name="/talker:rate", value="3")
    assert result is False
    assert values.endswith(why)


@pytest.mark.parametrize("text", ["{", "{}", "null", "[]", '[1, "a"]', "[[1]]", "[null]"])
def test_a_value_that_no_parameter_can_have(graph: Graph, text: str) -> None:
    assert graph.ask("set_param", name="/talker:rate", value=text)["result"] is False
    assert graph.node.heard() == []


def test_a_node_that_has_no_parameters(graph: Graph) -> None:
    answer = graph.ask("set_param", name="/nobody:rate", value="3")
    assert (answer["result"], "nobody provides it" in answer["values"]) == (False, True)


def test_without_a_graph_a_parameter_is_the_servers(graph: Graph, bridge: ConsoleBridge) -> None:
    bridge.router.graph = NO_GRAPH
    assert graph.ask("set_param", name="/talker:rate", value="3")["result"] is True
    assert graph.ask("get_param", name="/talker:rate")["values"] == {"value": "3"}


def test_the_services_of_a_graph_leave_those_of_clients_their_places(graph: Graph, bridge: ConsoleBridge) -> None:
    most = bridge.profile.limits.topics
    for number in range(most + 10):
        graph.node.send(op="advertise_service", service=f"/many/n{number}", type="std_srvs/SetBool")
    graph.peer.send(op="advertise_service", service="/mine", type="std_srvs/SetBool")
    assert bridge.router.calls.providers()["/mine"] == graph.peer.session.number
    assert len(bridge.router.calls.providers()) > most


class TwoNodes:
    """/one and /two, who are asked for the names of their parameters."""

    def __init__(self, bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
        self.bridge, self.node, self.peer = bridge, join(bridge), join(bridge)
        bridge.router.registry.add("rcl_interfaces/ListParametersResult", "string[] names\nstring[] prefixes\n")
        bridge.router.registry.add("rcl_interfaces/ListParameters_Response", "ListParametersResult result\n")
        self.node.session.in_graph = True
        for name in ("/one", "/two"):
            self.node.send(op="advertise_service", service=f"{name}/{LIST}", type="rcl_interfaces/srv/ListParameters")
        mute = NodeNames((), (), ())
        bridge.router.graph = GraphNames(dict.fromkeys(("/simconsole", "/one", "/two", "/mute"), mute), {})
        self.peer.send(op="call_service", service="/rosapi/set_param", args={"name": "own", "value": "1"})
        self.peer.heard()

    def ask(self) -> dict[str, Any]:
        """Ask for all names; the calls to the nodes by service."""
        self.peer.send(op="call_service", service="/rosapi/get_param_names")
        return {call["service"]: call for call in self.node.heard()}

    def answer(self, call: dict[str, Any], values: Any, result: bool = True) -> None:
        told = {"service": call["service"], "id": call["id"], "values": values, "result": result}
        self.node.send(op="service_response", **told)

    def names(self) -> list[list[str]]:
        return [heard["values"]["names"] for heard in self.peer.heard()]


@pytest.fixture
def two(bridge: ConsoleBridge, join: Callable[..., Any]) -> TwoNodes:
    return TwoNodes(bridge, join)


def listed(*names: str) -> dict[str, Any]:
    return {"result": {"names": list(names), "prefixes": []}}


def test_names_of_all_parameters(two: TwoNodes) -> None:
    calls = two.ask()
    assert set(calls) == {f"/one/{LIST}", f"/two/{LIST}"}
    two.answer(calls[f"/two/{LIST}"], listed("gain"))
    assert two.names() == []  # /one has not said any yet
    two.answer(calls[f"/one/{LIST}"], listed("rate", "mode"))
    assert two.names() == [["own", "/one:mode", "/one:rate", "/two:gain"]]


def test_a_node_that_does_not_name_its_parameters_is_left_out(two: TwoNodes) -> None:
    calls = two.ask()
    two.answer(calls[f"/one/{LIST}"], listed("rate"))
    two.bridge.router.calls.expire(int((LIST_S - 0.01) * 1e9))
    assert two.names() == []
    two.bridge.router.calls.expire(int((LIST_S + 0.01) * 1e9))
    assert two.names() == [["own", "/one:rate"]]


@pytest.mark.parametrize("answer", [("it has failed", False), ({"result": 7}, True)])
def test_a_node_that_answers_wrongly_is_left_out(two: TwoNodes, answer: tuple[Any, bool]) -> None:
    calls = two.ask()
    two.answer(calls[f"/one/{LIST}"], *answer)
    two.answer(calls[f"/two/{LIST}"], listed("gain"))
    assert two.names() == [["own", "/two:gain"]]


def test_nodes_that_leave_are_left_out(two: TwoNodes) -> None:
    two.ask()
    two.bridge.disconnect(two.node.session, 0)
    assert two.names() == [["own"]]


def test_a_client_that_leaves_hears_no_names(two: TwoNodes) -> None:
    two.ask()
    two.bridge.disconnect(two.peer.session, 0)
    assert two.bridge.router.calls.open == 0


def test_asking_all_nodes_is_one_call_of_the_client(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    two = TwoNodes(bridge, join)
    two.peer.session.max_calls = 1
    calls = two.ask()
    assert len(calls) == 2
    assert two.ask() == {}
    (refused,) = two.peer.heard()
    assert "1 calls at a time are the most allowed" in refused["values"]


@pytest.mark.parametrize("kind", ["GetParameters", "SetBool"])
def test_a_client_cannot_stand_for_a_node(kind: str, bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    squatter, peer = join(bridge), join(bridge)
    bridge.router.graph = GraphNames({"/talker": TALKER}, {})
    squatter.send(op="advertise_service", service="/talker/get_parameters", type=f"rcl_interfaces/srv/{kind}")
    peer.send(op="call_service", service="/rosapi/get_param", args={"name": "/talker:rate"})
    assert squatter.heard() == []
    assert peer.heard()[0]["values"] == "/rosapi/get_param: /talker/get_parameters: nobody provides it"


def test_a_service_of_another_type_is_not_asked(graph: Graph) -> None:
    graph.node.send(op="unadvertise_service", service="/talker/get_parameters")
    graph.node.send(op="advertise_service", service="/talker/get_parameters", type="std_srvs/srv/SetBool")
    assert graph.ask("get_param", name="/talker:rate")["result"] is False
    assert graph.node.heard() == []
