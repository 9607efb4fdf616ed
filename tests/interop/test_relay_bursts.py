"""Nothing is lost in a burst of calls or goals through the relay, and each has its end; against a real rclpy."""

import itertools
from typing import Any

import pytest

from tests.interop.programs import Client
from tests.interop.puppets import Puppet, Served
from tests.interop.ros2 import needs_ros2
from tests.patience import pause, wait_until
from tests.samples import Sample

pytestmark = needs_ros2

FLIP = "std_srvs/srv/SetBool"
FIBONACCI = "test_msgs/action/Fibonacci"
SUCCEEDED = 4
CALLS = 60
CALLS_HZ = 200.0
GOALS = 50
CANCELED = 5
ABORTED = 6


def wait_for(web: Client, service: str, key: str, name: str) -> None:
    """Wait until the console knows a service or action of the graph."""

    def known() -> bool:
        web.say(op="call_service", id="list", service=f"/rosapi/{service}")
        return name in web.hear(lambda heard: heard.get("id") == "list")["values"][key]

    wait_until(known, f"{name} at the console")


def test_calls_of_a_client(web: Client, node: Puppet, sample: Sample) -> None:
    node.do("serve", name="/ros/flip")
    wait_for(web, "services", "services", "/ros/flip")
    for _ in range(sample.of(1, 5)):
        for number in range(CALLS):
            web.say(op="call_service", id=number, service="/ros/flip", args={"data": bool(number % 2)})
            pause(1.0 / CALLS_HZ)
        answers = web.answers(CALLS)
        assert [answers[number]["success"] for number in range(CALLS)] == [number % 2 == 0 for number in range(CALLS)]


def test_calls_of_a_client_all_at_once(web: Client, node: Puppet) -> None:
    node.do("serve", name="/ros/flip")
    wait_for(web, "services", "services", "/ros/flip")
    for number in range(CALLS):
        web.say(op="call_service", id=number, service="/ros/flip", args={"data": bool(number % 2)})
    assert len(web.answers(CALLS)) == CALLS


def test_calls_of_a_node(web: Client, node: Puppet, sample: Sample) -> None:
    web.say(op="advertise_service", service="/web/flip", type=FLIP)
    for _ in range(sample.of(1, 5)):
        node.do("call", name="/web/flip", count=CALLS, hz=CALLS_HZ)
        for _ in range(CALLS):
            call = web.hear(lambda heard: heard["op"] == "call_service")
            values = {"success": call["args"]["data"], "message": "web"}
            web.say(op="service_response", service="/web/flip", id=call["id"], values=values, result=True)
        answers = node.answers("answered", "/web/flip", CALLS)
        assert [answers[number]["success"] for number in range(CALLS)] == [number % 2 == 1 for number in range(CALLS)]


def test_goals_of_a_client(web: Client, node: Puppet, sample: Sample) -> None:
    node.do("act", name="/ros/fibonacci")
    wait_for(web, "action_servers", "action_servers", "/ros/fibonacci")
    goal = {"op": "send_action_goal", "action": "/ros/fibonacci", "action_type": FIBONACCI, "args": {"order": 3}}
    for _ in range(sample.of(1, 3)):
        for number in range(GOALS):
            web.say(**goal, id=number)
            pause(0.001)
        ends: dict[int, Any] = {}
        while len(ends) < GOALS:
            heard = web.hear(lambda heard: heard["op"] == "action_result")
            ends[heard["id"]] = (heard["status"], heard["values"]["sequence"])
        assert {status for status, _ in ends.values()} == {SUCCEEDED}


def test_goals_of_a_node(web: Client, node: Puppet, sample: Sample) -> None:
    web.say(op="advertise_action", action="/web/fibonacci", type=FIBONACCI)
    for _ in range(sample.of(1, 3)):
        node.do("pursue", name="/web/fibonacci", count=GOALS)
        for _ in range(GOALS):
            goal = web.hear(lambda heard: heard["op"] == "send_action_goal")
            told = {"action": "/web/fibonacci", "id": goal["id"], "values": {"sequence": [0, 1]}}
            web.say(op="action_feedback", **told)
            web.say(op="action_result", status=SUCCEEDED, result=True, **told)
        ends = node.answers("ended", "/web/fibonacci", GOALS)
        assert {end["status"] for end in ends.values()} == {SUCCEEDED}


def test_a_service_that_is_just_appearing(web: Client, node: Puppet) -> None:
    for number in range(5):
        name = f"/ros/appearing{number}"
        node.do("serve", name=name)
        node.hear(lambda said: "served" in said)
        web.say(op="call_service", id=number, service=name, args={"data": True})
        assert web.answers(1)[number]["message"] == name


def test_calls_and_goals_whose_node_leaves_end(sides: tuple[Served, Puppet], web: Client, node: Puppet) -> None:
    node.do("serve_mute", name="/ros/mute")
    node.do("act", name="/ros/slow", step_s=1.0)
    wait_for(web, "services", "services", "/ros/mute")
    wait_for(web, "action_servers", "action_servers", "/ros/slow")
    for number in range(20):
        web.say(op="call_service", id=number, service="/ros/mute", args={"data": True})
    goal = {"op": "send_action_goal", "action": "/ros/slow", "action_type": FIBONACCI, "args": {"order": 40}}
    for number in range(20):
        web.say(**goal, id=number, feedback=True)
    node.hear(lambda said: said.get("asked") == "/ros/mute")
    web.hear(lambda heard: heard["op"] == "action_feedback")
    node.do("destroy", kind="service", name="/ros/mute")
    node.do("destroy", kind="action server", name="/ros/slow")
    ended: dict[str, set[int]] = {"service_response": set(), "action_result": set()}
    while len(ended["service_response"]) < 20 or len(ended["action_result"]) < 20:
        heard = web.hear(lambda heard: heard["op"] in ended)
        assert heard["result"] is False
        assert heard["values"], "it says why"
        ended[heard["op"]].add(heard["id"])


def test_goals_end_whose_server_is_replaced_at_once(web: Client, node: Puppet) -> None:
    """Under its name there is always a server, but none that knows these goals."""
    node.do("act", name="/ros/changing", step_s=1.0)
    wait_for(web, "action_servers", "action_servers", "/ros/changing")
    goal = {"op": "send_action_goal", "action": "/ros/changing", "action_type": FIBONACCI, "args": {"order": 600}}
    for number in range(5):
        web.say(**goal, id=number, feedback=True)
    under_way: set[int] = set()
    while len(under_way) < 5:
        under_way.add(web.hear(lambda heard: heard["op"] == "action_feedback")["id"])
    node.do("destroy", kind="action server", name="/ros/changing")
    node.do("act", name="/ros/changing")
    ended: set[int] = set()
    while ended != under_way:
        heard = web.hear(lambda heard: heard["op"] == "action_result")
        assert (heard["result"], heard["status"]) == (False, ABORTED)
        ended.add(heard["id"])
    web.say(**{**goal, "args": {"order": 3}}, id=9)
    assert web.hear(lambda heard: heard["op"] == "action_result")["status"] == SUCCEEDED


@pytest.mark.parametrize("leaves", ["the first", "the second"])
def test_a_goal_of_two_servers_ends_when_one_leaves(web: Client, node: Puppet, other_node: Puppet, leaves: str) -> None:
    """Both know it, and nobody knows which one's acceptance was heard."""
    name = f"/ros/twice_{leaves[4:]}"
    for each in (node, other_node):
        each.do("act", name=name, step_s=1.0, tells=True)
    wait_for(web, "action_servers", "action_servers", name)
    orders = itertools.count(0, -1)  # of no steps

    def both_are_heard() -> bool:
        """Send a short goal; whether both servers have it: all ends have found each other then."""
        order = next(orders)
        web.say(**twice(name, order), id=order)
        web.hear(lambda heard: heard["op"] == "action_result" and heard["id"] == order)
        return all(each.hears(lambda said: said.get("pursues") == order, 0.3) for each in (node, other_node))

    wait_until(both_are_heard, "a goal that both servers have")
    web.say(**twice(name, 600), id=600)
    for each in (node, other_node):
        each.hear(lambda said: said.get("pursues") == 600)
    web.hear(lambda heard: heard["op"] == "action_feedback" and heard["id"] == 600)
    (node if leaves == "the first" else other_node).do("destroy", kind="action server", name=name)
    heard = web.hear(lambda heard: heard["op"] == "action_result" and heard["id"] == 600)
    assert (heard["result"], heard["status"]) == (False, ABORTED)
    assert "has left the graph" in heard["values"]


def twice(name: str, order: int) -> dict[str, Any]:
    return {
        "op": "send_action_goal",
        "action": name,
        "action_type": FIBONACCI,
        "args": {"order": order},
        "feedback": True,
    }


@pytest.mark.parametrize("all_at_once", [False, True])
def test_a_burst_of_goals_that_are_cancelled(web: Client, node: Puppet, all_at_once: bool) -> None:
    node.do("act", name="/ros/patient", step_s=0.5)
    wait_for(web, "action_servers", "action_servers", "/ros/patient")
    goal = {"op": "send_action_goal", "action": "/ros/patient", "action_type": FIBONACCI, "args": {"order": 20}}
    for number in range(GOALS):
        web.say(**goal, id=number)
    if all_at_once:  # as roslibjs' cancelAllGoals
        web.say(op="cancel_action_goal", action="/ros/patient")
    for number in range(0 if all_at_once else GOALS):
        web.say(op="cancel_action_goal", action="/ros/patient", id=number)
    ends: dict[int, int] = {}
    while len(ends) < GOALS:
        heard = web.hear(lambda heard: heard["op"] == "action_result")
        ends[heard["id"]] = heard["status"]
    assert set(ends.values()) == {CANCELED}


def test_messages_of_a_node(web: Client, node: Puppet, sample: Sample) -> None:
    node.do("burst", name="/ros/burst", count=1)
    web.say(op="subscribe", topic="/ros/burst", type="std_msgs/String", queue_length=1000)

    def arrives() -> bool:
        node.do("burst", name="/ros/burst", count=1)
        try:
            return "/ros/burst" in str(web.web.recv(timeout=0.2))
        except TimeoutError:
            return False

    wait_until(arrives, "a message")
    for count in range(
        100 - sample.of(2, 10), 100
    ):  # each another number: what comes late of the attempts before is passed over
        node.do("burst", name="/ros/burst", count=count)
        seen: list[str] = []
        while seen[-count:] != [str(number) for number in range(count)]:
            seen.append(web.message("/ros/burst")["data"])
        assert set(seen[:-count]) <= {"0"}
