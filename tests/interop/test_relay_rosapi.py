"""rosapi says what there is in a real graph, and does to it what it says."""

import os
import signal
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import pytest

from tests.interop.programs import Client, client
from tests.interop.puppets import Puppet, Served, puppet, served
from tests.interop.ros2 import domain, needs_ros2
from tests.patience import wait_until

pytestmark = needs_ros2


def ask(web: Client, service: str, /, **args: Any) -> Any:
    web.say(op="call_service", id=service, service=service, args=args)
    return web.hear(lambda heard: heard.get("id") == service)


class Graph(NamedTuple):
    """A console in a graph with one node."""

    around: Mapping[str, str]
    console: Served
    talker: Puppet


@pytest.fixture(scope="module")
def graph() -> Iterator[Graph]:
    """The graph of these tests; the first one finds nobody else in it."""
    around = domain()
    with served(around) as console, puppet(around, "talker") as talker:
        yield Graph(around, console, talker)


def test_nodes_topics_and_parameters_of_the_graph(graph: Graph) -> None:
    node = graph.talker
    with client(graph.console.url) as web:
        node.do("declare", name="rate", value=3)
        node.do("publish", name="/chatter", data="hello")
        node.do("serve", name="/flip")
        wait_until(lambda: "/talker" in ask(web, "/rosapi/nodes")["values"]["nodes"], "the node")
        nodes = ask(web, "/rosapi/nodes")["values"]["nodes"]
        assert [name for name in nodes if "client" not in name] == ["/simconsole", "/talker"]
        assert len(nodes) == 3

        def details() -> Any:
            answer = ask(web, "/rosapi/node_details", node="/talker")["values"]
            return answer if "/flip" in answer["services"] else None

        found = wait_until(details, "what the node has")
        assert "/chatter" in found["publishing"]
        assert "/talker/set_parameters" in found["services"]
        wait_until(lambda: "/chatter" in ask(web, "/rosapi/topics")["values"]["topics"], "its topic")
        assert ask(web, "/rosapi/publishers", topic="/chatter")["values"]["publishers"] == ["/talker"]
        assert ask(web, "/rosapi/service_node", service="/flip")["values"]["node"] == "/talker"

        assert ask(web, "/rosapi/get_param", name="/talker:rate")["values"]["value"] == "3"
        assert ask(web, "/rosapi/has_param", name="/talker:rate")["values"]["exists"] is True
        assert ask(web, "/rosapi/has_param", name="/talker:none")["values"]["exists"] is False
        names = ask(web, "/rosapi/get_param_names")["values"]["names"]
        assert "/talker:rate" in names
        assert "/talker:use_sim_time" in names
        assert ask(web, "/rosapi/set_param", name="/talker:rate", value="5")["result"] is True
        node.do("parameter", name="rate")
        assert node.hear(lambda said: said.get("parameter") == "rate")["value"] == 5
        refused = ask(web, "/rosapi/set_param", name="/talker:rate", value='"fast"')
        assert refused["result"] is False
        assert "type" in refused["values"]
        assert ask(web, "/rosapi/set_param", name="/nobody:rate", value="5")["result"] is False
        values = ask(web, "/talker/get_parameters", names=["rate"])["values"]["values"]
        assert values[0]["integer_value"] == 5


def test_what_is_not_relayed_is_named(graph: Graph) -> None:
    console, node = graph.console, graph.talker
    with client(console.url) as web:
        unrelayed = wait_until(lambda: ask(web, "/rosapi/unrelayed")["values"]["names"], "what is not relayed")
        assert "/tf" in unrelayed
        assert "/odom" not in unrelayed
        wait_until(lambda: "/tf: this ROS 2 has no type tf2_msgs/msg/TFMessage" in console.text, "the same in the log")
        node.do("subscribe", name="/console/mode")
        assert node.hear(lambda said: said.get("heard") == "/console/mode")["data"] == "PARKED"


def test_a_node_that_does_not_answer_costs_the_names_of_its_own_parameters_only(graph: Graph) -> None:
    with puppet(graph.around, "stopped") as stopped, client(graph.console.url) as web:

        def names() -> set[str]:
            found = ask(web, "/rosapi/get_param_names")["values"]["names"]
            return {name.partition(":")[0] for name in found}

        wait_until(lambda: names() == {"/talker", "/stopped"}, "both nodes")
        stopped.process.send_signal(signal.SIGSTOP)
        os.waitid(os.P_PID, stopped.process.pid, os.WSTOPPED | os.WNOWAIT)  # until each of its threads has stopped
        try:
            assert names() == {"/talker"}
        finally:
            stopped.process.send_signal(signal.SIGCONT)
