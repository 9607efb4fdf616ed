import json
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.upstream import Upstream
from simconsole.profiles.bridge import BridgeProfile, UpstreamProfile
from simconsole.values.signals import Event

CONTROL = "/control/command/control_cmd"


def upstream(bridge: ConsoleBridge, **profile: Any) -> Upstream:
    return Upstream(bridge, UpstreamProfile(url="ws://ros:9090", **profile), lambda: None)


def publish(topic: str, msg: Any) -> bytes:
    return json.dumps({"op": "publish", "topic": topic, "msg": msg}).encode()


def heard(link: Upstream) -> list[dict[str, Any]]:
    texts = []
    assert link.session is not None
    while (text := link.session.next_text(10**12)) is not None:
        texts.append(json.loads(text))
    return texts


def test_outputs_are_advertised_and_commands_asked_for_under_the_console_s_names() -> None:
    profile = BridgeProfile(namespace="/ego", rename={"/odom": "/localization"}, rates_hz={"/tf": 0.0})
    texts = [json.loads(text) for text in upstream(ConsoleBridge(profile)).connected(0)]
    registrations = [text for text in texts if text["op"] != "call_service"]
    advertised = {
        registration["topic"]: registration for registration in registrations if registration["op"] == "advertise"
    }
    subscribed = {
        registration["topic"]: registration for registration in registrations if registration["op"] == "subscribe"
    }
    assert len(registrations) == len(advertised) + len(subscribed)
    assert advertised["/localization"] == {
        "op": "advertise", "topic": "/localization", "type": "nav_msgs/Odometry", "latch": False,
    }  # fmt: skip
    assert advertised["/tf_static"]["latch"]
    assert "/tf" not in advertised
    assert subscribed[f"/ego{CONTROL}"]["type"] == "autoware_control_msgs/Control"
    assert not [topic for topic in advertised if topic in subscribed]


def test_topics_between_clients_stay_here(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    join(bridge).send(op="advertise", topic="/own", type="std_msgs/String")
    assert not [text for text in upstream(bridge).connected(0) if json.loads(text).get("topic") == "/own"]


@pytest.mark.parametrize(("dialect", "stamp"), [("ros2", {"sec": 1, "nanosec": 0}), ("ros1", {"secs": 1, "nsecs": 0})])
def test_what_the_console_publishes_goes_there(
    bridge: ConsoleBridge, snapshot: Callable[..., Any], dialect: Any, stamp: dict[str, int]
) -> None:
    link = upstream(bridge, dialect=dialect)
    link.connected(0)
    bridge.publish(snapshot(250), 0)
    messages = {text["topic"]: text["msg"] for text in heard(link)}
    assert messages["/odom"]["header"]["stamp"] == stamp
    assert "/tf_static" in messages


def test_commands_come_from_there_and_are_checked(bridge: ConsoleBridge, control: Callable[..., Any]) -> None:
    link = upstream(bridge)
    link.connected(0)
    heard(link)
    assert link.receive(publish(CONTROL, control(0.2)), 0).kind == "command"
    assert bridge.inputs.command.road_wheel_rad == 0.2
    assert link.receive(publish(CONTROL, control(9.9)), 0).kind == "refused"
    assert bridge.inputs.command.refused == 1.0
    assert heard(link) == []  # rosbridge_suite has no use for a status
    assert link.lost(0)
    assert bridge.inputs.take(1)[1].events == Event.COMMANDER_LOST
    assert not link.lost(0)


def test_it_is_one_commander_among_others(
    bridge: ConsoleBridge, join: Callable[..., Any], control: Callable[..., Any]
) -> None:
    link, client = upstream(bridge), join(bridge)
    link.connected(0)
    client.publish(CONTROL, control(0.1))
    assert "another client commands" in link.receive(publish(CONTROL, control(0.2)), 0).text


def test_nothing_else_is_taken(bridge: ConsoleBridge) -> None:
    link = upstream(bridge)
    link.connected(0)
    subscriptions = len(link.session.queues) if link.session else 0
    for operation, kind in (
        ({"op": "subscribe", "topic": "/new", "type": "std_msgs/String"}, "done"),
        ({"op": "call_service", "service": "/rosapi/set_param", "args": {"name": "a", "value": "1"}}, "done"),
        ({"op": "publish", "topic": "/odom", "msg": {}}, "done"),
        ({"op": "publish", "topic": "/elsewhere", "msg": {}}, "done"),
        ({"op": "status", "level": "error", "msg": "no such type"}, "remark"),
        ({"op": "surprise"}, "refused"),
    ):
        assert link.receive(json.dumps(operation).encode(), 0).kind == kind
    assert link.session is not None
    assert len(link.session.queues) == subscriptions
    assert "/new" not in bridge.router.topics


def test_a_new_connection_begins_anew(bridge: ConsoleBridge, snapshot: Callable[..., Any]) -> None:
    link = upstream(bridge)
    first = link.connected(0)
    link.lost(0)
    assert link.session is None
    assert bridge.router.sessions == ()
    assert link.connected(0) == first
    bridge.publish(snapshot(5), 0)
    assert "/odom" in {text["topic"] for text in heard(link)}


VELOCITY = "/vehicle/status/velocity_status"


def answer(link: Upstream, texts: list[bytes], has: Callable[[str], bool]) -> list[str]:
    """Answer the questions for types; return what is remarked."""
    asked = [each for each in map(json.loads, texts) if each["op"] == "call_service"]
    assert {each["service"] for each in asked} == {"/rosapi/message_details"}
    said = []
    for each in asked:
        found = {"typedefs": ["some"] if has(each["args"]["type"]) else []}
        response = {"op": "service_response", "service": each["service"], "id": each["id"], "values": found}
        outcome = link.receive(json.dumps({**response, "result": True}).encode(), 0)
        said += [outcome.text] * (outcome.kind == "remark")
    return said


def test_types_that_it_lacks_are_not_published_and_that_is_said_once(
    bridge: ConsoleBridge, snapshot: Callable[..., Any]
) -> None:
    link = upstream(bridge)
    for number in range(2):
        texts = link.connected(0)
        assert VELOCITY not in {json.loads(text).get("topic") for text in texts}
        said = answer(link, texts, lambda kind: kind.partition("/")[0] in ("std_msgs", "nav_msgs"))
        assert len(said) == (1, 0)[number]
        bridge.publish(snapshot(250 * (number + 1)), 0)
        topics = {text["topic"] for text in heard(link) if text["op"] == "publish"}
        assert "/odom" in topics
        assert not topics & {VELOCITY, "/tf"}, "tf2_msgs is of every ROS, but not of this"
        link.lost(0)
    assert not said
    assert len(answer(link, link.connected(0), lambda kind: kind != "tf2_msgs/TFMessage")) == 1


def test_types_that_it_has_are_published_as_soon_as_it_says_so(
    bridge: ConsoleBridge, snapshot: Callable[..., Any]
) -> None:
    link = upstream(bridge)
    assert answer(link, link.connected(0), lambda kind: True) == []
    assert VELOCITY in {text["topic"] for text in heard(link) if text["op"] == "advertise"}
    bridge.publish(snapshot(250), 0)
    assert {VELOCITY, "/tf", "/odom"} <= {text["topic"] for text in heard(link)}
    late = {"op": "service_response", "service": "/rosapi/message_details", "id": "x", "values": "no", "result": False}
    assert link.receive(json.dumps(late).encode(), 0).kind == "done"


def test_without_rosapi_what_every_ros_has_is_published(bridge: ConsoleBridge, snapshot: Callable[..., Any]) -> None:
    link = upstream(bridge)
    (said,) = answer(link, link.connected(0), lambda kind: False)
    assert "no rosapi" in said
    assert f"{VELOCITY} (autoware_vehicle_msgs/msg/VelocityReport)" in said
    bridge.publish(snapshot(250), 0)
    topics = {text["topic"] for text in heard(link)}
    assert ("/tf" in topics, "/odom" in topics, VELOCITY in topics) == (True, True, False)
