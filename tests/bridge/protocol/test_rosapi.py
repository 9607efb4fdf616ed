from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.messages import parse, parse_all
from simconsole.bridge.messages.standard_types import DEFINITIONS
from simconsole.bridge.protocol.access import Access, Role
from simconsole.bridge.protocol.rosapi import MAX_PARAMETER, MAX_PARAMETERS

CHATTER = {"topic": "/chatter", "type": "std_msgs/String"}
ADD = {"service": "/add", "type": "example_interfaces/srv/AddTwoInts"}


def ask(peer: Any, service: str, /, **args: Any) -> Any:
    peer.heard()
    peer.send(op="call_service", service=f"/rosapi/{service}", args=args)
    (answer,) = peer.heard()
    assert answer["op"] == "service_response"
    return answer["values"]


def test_every_service_has_its_type(peer: Any) -> None:
    services = peer.bridge.router.calls.services()
    defined = [f"rosapi/{path.stem}" for path in (DEFINITIONS / "rosapi" / "srv").iterdir()]
    assert sorted(services.values()) == sorted([*defined, "simconsole_msgs/Operate", "simconsole_msgs/Unrelayed"])
    assert ask(peer, "services") == {"services": list(services)}
    for name, kind in services.items():
        assert ask(peer, "service_type", service=name) == {"type": kind}


def test_topics_and_types(peer: Any) -> None:
    peer.send(op="advertise", **CHATTER)
    found = ask(peer, "topics")
    types = dict(zip(found["topics"], found["types"], strict=True))
    assert types["/odom"] == "nav_msgs/msg/Odometry"
    assert types["/chatter"] == "std_msgs/msg/String"
    assert ask(peer, "topic_type", topic="chatter") == {"type": "std_msgs/msg/String"}
    assert ask(peer, "topic_type", topic="/none") == {"type": ""}
    assert ask(peer, "topics_for_type", type="nav_msgs/Odometry") == {"topics": ["/ground_truth/odom", "/odom"]}
    assert ask(peer, "topics_for_type", type="demo/None") == {"topics": []}
    peer.session.dialect = "ros1"
    assert ask(peer, "topic_type", topic="/odom") == {"type": "nav_msgs/Odometry"}


def test_raw_types_can_be_read_back(peer: Any) -> None:
    found = ask(peer, "topics_and_raw_types")
    texts = dict(zip(found["topics"], found["typedefs_full_text"], strict=True))
    first, _, others = texts["/odom"].partition("=" * 80 + "\n")
    registry = peer.bridge.router.registry
    assert parse("nav_msgs/Odometry", first) == registry.definition("nav_msgs/Odometry")
    read = {definition.name: definition for definition in parse_all(others)}
    assert read["std_msgs/msg/Header"] == registry.definition("std_msgs/Header")
    assert "uint8 DRIVE=2\n" in texts["/vehicle/status/gear_status"]


def test_services_and_actions(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    peer, provider = join(bridge), join(bridge)
    provider.send(op="advertise_service", **ADD)
    provider.send(op="advertise_action", action="/go", type="demo/Go")
    node = f"/client_{provider.session.number}"
    assert "/add" in ask(peer, "services")["services"]
    assert ask(peer, "services_for_type", type="example_interfaces/AddTwoInts") == {"services": ["/add"]}
    assert ask(peer, "service_node", service="/add") == {"node": node}
    assert ask(peer, "service_node", service="/rosapi/nodes") == {"node": "/simconsole"}
    assert ask(peer, "service_node", service="/none") == {"node": ""}
    for wanted in (ADD["type"], "/add"):
        assert ask(peer, "service_providers", service=wanted) == {"providers": [node]}
    assert ask(peer, "action_servers") == {"action_servers": ["/go"]}
    assert ask(peer, "action_type", action="/go") == {"type": "demo/Go"}
    assert ask(peer, "action_type", action="/none") == {"type": ""}
    assert ask(peer, "service_host", service="/add") == {"host": "localhost"}
    assert ask(peer, "service_host", service="/none") == {"host": ""}


def test_nodes(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    peer, talker = join(bridge), join(bridge)
    talker.send(op="advertise", **CHATTER)
    talker.send(op="subscribe", topic="/odom")
    talker.send(op="advertise_service", **ADD)
    node = f"/client_{talker.session.number}"
    assert node in ask(peer, "nodes")["nodes"]
    assert ask(peer, "node_details", node=node) == {
        "subscribing": ["/odom"], "publishing": ["/chatter"], "services": ["/add"],
    }  # fmt: skip
    console = ask(peer, "node_details", node="/simconsole")
    assert "/odom" in console["publishing"]
    assert "/cmd_vel" in console["subscribing"]
    assert ask(peer, "publishers", topic="/odom") == {"publishers": ["/simconsole"]}
    assert ask(peer, "subscribers", topic="/odom") == {"subscribers": [node]}
    assert "there is no topic" in ask(peer, "publishers", topic="/none")
    assert "there is no node" in ask(peer, "node_details", node="/none")


def test_details_of_types(peer: Any) -> None:
    first, *others = ask(peer, "message_details", type="geometry_msgs/TwistWithCovariance")["typedefs"]
    assert first["fieldnames"] == ["twist", "covariance"]
    assert first["fieldtypes"] == ["geometry_msgs/Twist", "float64"]
    assert first["fieldarraylen"] == [-1, 36]
    assert [other["type"] for other in others] == ["geometry_msgs/Twist", "geometry_msgs/Vector3"]
    (gear,) = (
        found
        for found in ask(peer, "message_details", type="autoware_vehicle_msgs/GearReport")["typedefs"]
        if found["constnames"]
    )
    assert gear["constvalues"][gear["constnames"].index("DRIVE")] == "2"
    request = ask(peer, "service_request_details", type="std_srvs/srv/SetBool")["typedefs"]
    assert (request[0]["fieldnames"], request[0]["examples"]) == (["data"], ["False"])
    response = ask(peer, "service_response_details", type="std_srvs/SetBool")["typedefs"]
    assert response[0]["fieldnames"] == ["success", "message"]
    goal = ask(peer, "action_goal_details", type="example_interfaces/action/Fibonacci")["typedefs"]
    assert (goal[0]["fieldnames"], goal[0]["fieldtypes"]) == (["order"], ["int32"])
    for part in ("result", "feedback"):
        found = ask(peer, f"action_{part}_details", type="example_interfaces/Fibonacci")["typedefs"]
        assert (found[0]["fieldnames"], found[0]["fieldarraylen"]) == (["sequence"], [0])
    assert "nav_msgs/msg/Odometry" in ask(peer, "interfaces")["interfaces"]
    assert "not known" in ask(peer, "action_goal_details", type="demo/None")
    assert "not known" in ask(peer, "message_details", type="demo/None")
    assert "not known" in ask(peer, "service_request_details", type="demo/None")


def test_parameters(peer: Any) -> None:
    assert ask(peer, "get_param", name="a") == {"value": "null"}
    assert ask(peer, "get_param", name="a", default_value="7") == {"value": "7"}
    assert ask(peer, "set_param", name="a", value="[1]") == {}
    assert ask(peer, "get_param", name="a") == {"value": "[1]"}
    assert ask(peer, "has_param", name="a") == {"exists": True}
    assert ask(peer, "get_param_names") == {"names": ["a"]}
    assert ask(peer, "search_param", name="a") == {"global_name": "a"}
    assert ask(peer, "search_param", name="b") == {"global_name": ""}
    assert ask(peer, "delete_param", name="a") == {}
    assert ask(peer, "delete_param", name="a") == {}
    assert ask(peer, "has_param", name="a") == {"exists": False}


def test_parameters_are_bounded(peer: Any) -> None:
    assert "not JSON" in ask(peer, "set_param", name="a", value="{")
    assert "at most" in ask(peer, "set_param", name="", value="1")
    assert "at most" in ask(peer, "set_param", name="a", value='"' + "x" * MAX_PARAMETER + '"')
    answers = [ask(peer, "set_param", name=f"p{number}", value="1") for number in range(MAX_PARAMETERS + 1)]
    assert answers[:-1] == [{}] * MAX_PARAMETERS
    assert "the most allowed" in answers[-1]


def test_viewer_changes_no_parameter(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    bridge.router.access = Access({}, Role.VIEW)
    viewer = join(bridge)
    assert "needs the role publish" in ask(viewer, "set_param", name="a", value="1")
    assert ask(viewer, "get_param", name="a") == {"value": "null"}


@pytest.mark.parametrize(
    ("dialect", "time", "version"),
    [
        ("ros2", {"sec": 3, "nanosec": 5}, {"version": 2, "distro": "jazzy"}),
        ("ros1", {"secs": 3, "nsecs": 5}, {"version": 1, "distro": "noetic"}),
    ],
)
def test_time_and_version(peer: Any, dialect: str, time: dict[str, int], version: dict[str, Any]) -> None:
    peer.session.dialect = dialect
    peer.bridge.router.ros_time_ns = 3_000_000_005
    assert ask(peer, "get_time") == {"time": time}
    assert ask(peer, "get_ros_version") == version
