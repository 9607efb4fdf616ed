"""The relay outlives whatever clients and nodes do to each other; against a real rclpy."""

from collections.abc import Iterator

import pytest

from simconsole.bridge.console.graph_view import LONGEST, Kind
from tests.interop.programs import Client, client
from tests.interop.puppets import Puppet, Served
from tests.interop.ros2 import needs_ros2
from tests.patience import wait_until

pytestmark = needs_ros2

FLIP = "std_srvs/srv/SetBool"
FIBONACCI = "test_msgs/action/Fibonacci"
ABORTED = 6


@pytest.fixture(autouse=True)
def _still_relays(sides: tuple[Served, Puppet]) -> Iterator[None]:
    """After each test the same bridge passes messages on, both ways, without a break."""
    with client(sides[0].url) as witness:
        yield
        node = sides[1]
        node.do("subscribe", name="/alive")
        witness.say(op="advertise", topic="/alive", type="std_msgs/String")

        def arrives() -> bool:
            witness.say(op="publish", topic="/alive", msg={"data": "out"})
            return node.heard() == {"heard": "/alive", "data": "out"}

        wait_until(arrives, "a message from client to node")
        node.do("publish", name="/alive/back", data="in", latched=True)
        witness.say(op="subscribe", topic="/alive/back", type="std_msgs/String")
        assert witness.message("/alive/back") == {"data": "in"}
        node.do("destroy", kind="publisher", name="/alive/back")
        node.do("destroy", kind="subscription", name="/alive")


@pytest.mark.parametrize("how", ["closes", "unadvertises"])
def test_a_provider_leaves_a_call_of_a_node(how: str, sides: tuple[Served, Puppet], node: Puppet) -> None:
    with client(sides[0].url) as provider:
        name = f"/web/{how}"
        provider.say(op="advertise_service", service=name, type=FLIP)
        node.do("call", name=name, count=3)
        for _ in range(3):
            provider.hear(lambda heard: heard["op"] == "call_service")
        if how == "unadvertises":
            provider.say(op="unadvertise_service", service=name)
            answers = node.answers("answered", name, 3)
    if how == "closes":
        answers = node.answers("answered", name, 3)
    assert [answer["success"] for answer in answers.values()] == [False] * 3  # ROS cannot say more


@pytest.mark.parametrize("how", ["closes", "unadvertises"])
def test_a_provider_leaves_a_goal_of_a_node(how: str, sides: tuple[Served, Puppet], node: Puppet) -> None:
    with client(sides[0].url) as provider:
        name = f"/web/goal_{how}"
        provider.say(op="advertise_action", action=name, type=FIBONACCI)
        node.do("pursue", name=name, count=3)
        for _ in range(3):
            provider.hear(lambda heard: heard["op"] == "send_action_goal")
        if how == "unadvertises":
            provider.say(op="unadvertise_action", action=name)
            ends = node.answers("ended", name, 3)
    if how == "closes":
        ends = node.answers("ended", name, 3)
    assert [end["status"] for end in ends.values()] == [ABORTED] * 3


def test_a_provider_answers_after_it_has_left(web: Client, node: Puppet) -> None:
    web.say(op="advertise_service", service="/web/late", type=FLIP)
    node.do("call", name="/web/late")
    call = web.hear(lambda heard: heard["op"] == "call_service")
    web.say(op="unadvertise_service", service="/web/late")
    web.say(op="advertise_service", service="/web/late", type=FLIP)
    web.say(op="set_level", level="none")  # it is told that nobody waits
    values = {"success": True, "message": "late"}
    web.say(op="service_response", service="/web/late", id=call["id"], values=values, result=True)
    assert node.answers("answered", "/web/late", 1)[0]["success"] is False
    node.do("call", name="/web/late")  # the new one
    call = web.hear(lambda heard: heard["op"] == "call_service")
    web.say(op="service_response", service="/web/late", id=call["id"], values=values, result=True)
    assert node.answers("answered", "/web/late", 1)[0]["message"] == "late"


def test_a_topic_changes_its_type(web: Client, node: Puppet) -> None:
    for number in range(5):
        name = f"/turns/n{number}"
        web.say(op="subscribe", topic=name, type="std_msgs/String")
        wait_for_subscribers(node, name, 1)
        web.say(op="unsubscribe", topic=name)
        web.say(op="advertise", topic=name, type="std_msgs/Int32")
        node.do("subscribe", name=name, kind="Int32")
        heard = {"heard": name, "data": 3}

        def arrives(name: str = name, heard: dict[str, object] = heard) -> bool:
            web.say(op="publish", topic=name, msg={"data": 3})
            return node.heard() == heard

        wait_until(arrives, "a message of the new type")


def wait_for_subscribers(node: Puppet, name: str, count: int) -> None:
    def seen() -> bool:
        node.do("count", name=name)
        return bool(node.hear(lambda said: said.get("count") == name)["subscribers"] == count)

    wait_until(seen, f"{count} subscribers of {name}")


@pytest.mark.parametrize(
    ("operation", "length"),
    [("advertise", 248), ("subscribe", 251), ("advertise_service", 245), ("advertise_action", 225)],
)
def test_a_name_too_long_for_a_graph_is_refused(web: Client, operation: str, length: int) -> None:
    name = "/" + "n" * (length - 1)
    kinds = {
        "advertise": ("topic", "std_msgs/String"),
        "subscribe": ("topic", "std_msgs/String"),
        "advertise_service": ("service", FLIP),
        "advertise_action": ("action", FIBONACCI),
    }
    key, type_name = kinds[operation]
    web.say(op=operation, type=type_name, **{key: name})
    status = web.status()
    assert status["level"] == "error"
    assert "is not relayed to the ROS 2 graph: its name is longer than" in status["msg"]


@pytest.mark.parametrize(
    ("operation", "kind", "type_name", "inside", "counted"),
    [
        ("advertise", "topic", "std_msgs/String", "", "publishers"),
        ("subscribe", "topic", "std_msgs/String", "", "subscribers"),
        ("advertise_service", "service", FLIP, "", "services"),
        ("advertise_action", "action", FIBONACCI, "/_action/cancel_goal", "services"),
    ],
)
def test_the_longest_name_that_is_not_refused_is_found_in_the_graph(
    web: Client, node: Puppet, operation: str, kind: Kind, type_name: str, inside: str, counted: str
) -> None:
    name = "/".ljust(LONGEST[kind], operation[-1])
    web.say(op=operation, type=type_name, **{kind: name})

    def is_found() -> bool:
        node.do("count", name=name + inside)
        return bool(node.hear(lambda said: said.get("count") == name + inside)[counted])

    wait_until(is_found, f"{kind} of {len(name)} characters in the graph")


@pytest.mark.parametrize(("operation", "key"), [("advertise_service", "service"), ("advertise_action", "action")])
@pytest.mark.parametrize("type_name", ["a/b/c/d", "a", "std_srvs/msg/SetBool", "std_srvs/srv/__name__"])
def test_a_type_that_is_none_is_refused(web: Client, operation: str, key: str, type_name: str) -> None:
    web.say(op=operation, type=type_name, **{key: "/typeless"})
    status = web.status()
    assert status["level"] == "error"
    assert status["msg"].startswith("/typeless is not relayed to the ROS 2 graph: ")
