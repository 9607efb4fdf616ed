import json
import math
from typing import Any

import msgspec
import pytest

from simconsole.bridge.protocol.client_protocol import MAX_STATUS, ClientProtocol, Goal
from simconsole.bridge.protocol.operations import write_publish
from simconsole.values.errors import BridgeError, LocalProtocolError


def publish(topic: str, msg: Any) -> bytes:
    return json.dumps({"op": "publish", "topic": topic, "msg": msg}).encode()


def test_messages_are_typed() -> None:
    client = ClientProtocol()
    assert json.loads(client.subscribe("/odom", "nav_msgs/Odometry", throttle_rate=20, queue_length=3)) == {
        "op": "subscribe",
        "topic": "/odom",
        "type": "nav_msgs/Odometry",
        "throttle_rate": 20,
        "queue_length": 3,
    }
    received = client.receive(publish("/odom", {"pose": {"pose": {"position": {"x": 1.5}}}}))
    assert received is not None
    topic, message = received
    assert topic == "/odom"
    assert message.pose.pose.position.x == 1.5


def test_quirks_of_the_real_server_are_understood() -> None:
    client = ClientProtocol()
    client.subscribe("/odom", "nav_msgs/Odometry")
    text = publish("/odom", {"header": {"seq": 3, "stamp": {"secs": 1, "nsecs": 2}}})
    received = client.receive(text.replace(b'"seq": 3', b'"seq": 3, "frame_id": "a\\/b"'))
    assert received is not None
    assert (received.message.header.stamp.nanosec, received.message.header.frame_id) == (2, "a/b")
    client.subscribe("/f", "std_msgs/Float64")
    for value in ("NaN", "null", "Infinity"):
        got = client.receive(b'{"op":"publish","topic":"/f","msg":{"data":' + value.encode() + b"}}")
        assert got is not None
        assert math.isnan(got.message.data)


def test_callback_gets_the_message_instead() -> None:
    client, seen = ClientProtocol(), []
    client.subscribe("/s", "std_msgs/String", lambda topic, message: seen.append((topic, message.data)))
    assert client.receive(publish("/s", {"data": "x"})) is None
    assert seen == [("/s", "x")]


def test_exception_of_a_callback_is_the_program_s_own() -> None:
    client = ClientProtocol()

    def fail(topic: str, message: Any) -> None:
        raise BridgeError("mine")

    client.subscribe("/s", "std_msgs/String", fail)
    with pytest.raises(BridgeError, match="mine"):
        client.receive(publish("/s", {"data": "x"}))
    assert client.refused == 0


def test_mistakes_of_the_server_are_counted_and_end_nothing() -> None:
    client = ClientProtocol()
    client.subscribe("/s", "std_msgs/String")
    bad = [b"", b"[]", b'{"op":"surprise"}', publish("/s", {"data": 5}), publish("/s", [])]
    assert [client.receive(text) for text in bad] == [None] * 5
    assert client.refused == 5
    assert client.receive(publish("/other", {"data": "x"})) is None
    assert client.receive(publish("/s", {"data": "x"})) is not None


def test_what_servers_nearly_always_send_is_read_as_any_other_text() -> None:
    """The short way and the long one: one message, written as `write_publish` does and with a space more."""
    for text in (write_publish("/s", {"data": "x"}), b'{"op": "publish", "topic": "/s", "msg": {"data": "x"}}'):
        client = ClientProtocol(dialect="ros2")
        client.subscribe("/s", "std_msgs/String")
        found = client.receive(text)
        assert found is not None
        assert (found.topic, found.message.data) == ("/s", "x")
    short = ClientProtocol(dialect="ros2")
    short.subscribe("/s", "std_msgs/String")
    for bad in (write_publish("/s", {"data": 5}), b'{"op":"publish","topic":"/s","msg":{"data":"x"'):
        assert short.receive(bad) is None
    assert short.receive(write_publish("/other", {"data": "x"})) is None
    assert short.refused == 2


def test_statuses_are_kept_bounded() -> None:
    client = ClientProtocol()
    for number in range(MAX_STATUS + 5):
        client.receive(b'{"op":"status","level":"error","msg":"%d"}' % number)
    assert len(client.statuses) == MAX_STATUS
    assert client.statuses[-1].msg == str(MAX_STATUS + 4)


def test_a_latched_publisher_says_so() -> None:
    client = ClientProtocol()
    assert json.loads(client.advertise("/map", "nav_msgs/OccupancyGrid", latch=True))["latch"] is True
    assert "latch" not in json.loads(client.advertise("/s", "std_msgs/String"))


def test_what_is_published_must_be_advertised_and_fit() -> None:
    client = ClientProtocol()
    with pytest.raises(LocalProtocolError, match="advertise it before"):
        client.publish("/s", {"data": "x"})
    client.advertise("/s", "std_msgs/String")
    with pytest.raises(LocalProtocolError, match=r"/s: .*\$.data"):
        client.publish("/s", {"data": 5})
    with pytest.raises(LocalProtocolError, match="cannot be std_msgs/msg/Bool"):
        client.advertise("/s", "std_msgs/Bool")
    with pytest.raises(BridgeError, match="not known"):
        client.advertise("/t", "demo/Nothing")
    assert json.loads(client.publish("/s", {"data": "x"})) == {"op": "publish", "topic": "/s", "msg": {"data": "x"}}


def test_fields_left_out_stay_left_out() -> None:
    client = ClientProtocol()
    client.advertise("/cmd_vel", "geometry_msgs/Twist")
    assert json.loads(client.publish("/cmd_vel", {"linear": {"x": 1.0}}))["msg"] == {"linear": {"x": 1.0}}


def test_typed_message_is_published() -> None:
    client = ClientProtocol()
    client.advertise("/p", "geometry_msgs/Point")
    point = client.registry.struct("geometry_msgs/Point")(x=math.nan)
    assert json.loads(client.publish("/p", point))["msg"] == {"x": None, "y": 0.0, "z": 0.0}


def test_wishes_are_what_is_still_wanted() -> None:
    client = ClientProtocol()
    client.advertise("/a", "std_msgs/String")
    client.advertise("/b", "std_msgs/String")
    client.subscribe("/c", "std_msgs/String")
    client.subscribe("/d", "std_msgs/String")
    assert json.loads(client.unadvertise("/a"))["op"] == "unadvertise"
    assert json.loads(client.unsubscribe("/c"))["op"] == "unsubscribe"
    registrations = [json.loads(text) for text in client.registrations()]
    assert [(registration["op"], registration["topic"]) for registration in registrations] == [
        ("advertise", "/b"),
        ("subscribe", "/d"),
    ]


def sent(client: ClientProtocol) -> list[dict[str, Any]]:
    texts = [json.loads(text) for text in client.replies]
    client.replies.clear()
    return texts


@pytest.mark.parametrize(
    ("stamp", "dialect", "written"),
    [
        ({"secs": 1, "nsecs": 2}, "ros1", {"seq": 0, "stamp": {"secs": 3, "nsecs": 4}, "frame_id": ""}),
        ({"sec": 1, "nanosec": 2}, "ros2", {"stamp": {"sec": 3, "nanosec": 4}}),
        ({}, None, {"stamp": {"sec": 3, "nanosec": 4}}),
        (None, None, {"stamp": {"sec": 3, "nanosec": 4}}),
    ],
)
def test_stamps_are_spelled_as_the_server_s_first(stamp: Any, dialect: str | None, written: dict[str, Any]) -> None:
    client = ClientProtocol()
    client.subscribe("/odom", "nav_msgs/Odometry")
    client.receive(publish("/odom", {} if stamp is None else {"header": {"stamp": stamp}}))
    assert client.dialect == dialect
    client.advertise("/p", "geometry_msgs/PointStamped")
    message = json.loads(client.publish("/p", {"header": {"stamp": {"sec": 3, "nanosec": 4}}}))["msg"]
    assert message["header"] == written


def test_messages_in_pieces_as_the_real_server_writes_them() -> None:
    client = ClientProtocol()
    client.subscribe("/s", "std_msgs/String")
    for _ in range(2):  # every message of rosbridge_suite has the id 0 and a fraction for its total
        text = publish("/s", {"data": "x" * 100}).decode()
        pieces = [text[at : at + 30] for at in range(0, len(text), 30)]
        fixed = {"op": "fragment", "id": 0, "total": len(pieces) - 0.3}
        operations = [{**fixed, "num": number, "data": piece} for number, piece in enumerate(pieces)]
        received = [client.receive(json.dumps(operation).encode()) for operation in operations]
        assert [each is not None for each in received] == [False] * (len(pieces) - 1) + [True]


def test_requests_are_answered_and_none_is_left_open() -> None:
    client = ClientProtocol()
    offered = json.loads(client.advertise_service("/add", "a/Add", lambda args: {"sum": sum(args)}))
    assert offered == {"op": "advertise_service", "service": "/add", "type": "a/Add"}
    client.receive(b'{"op":"call_service","service":"/add","id":"1","args":[1,2]}')
    client.receive(b'{"op":"call_service","service":"/other","id":"2"}')
    assert [(text["id"], text["result"], text["values"]) for text in sent(client)] == [
        ("1", True, {"sum": 3}),
        ("2", False, "not provided here"),
    ]
    assert len(client.registrations()) == 1
    client.unadvertise_service("/add")
    assert client.registrations() == []


def test_goals_are_told_of_cancelled_and_ended() -> None:
    client = ClientProtocol()
    goals: list[Any] = []
    client.advertise_action("/go", "a/Go", goals.append)
    client.receive(b'{"op":"send_action_goal","action":"/go","id":"1","args":{"far":3}}')
    client.receive(b'{"op":"send_action_goal","action":"/other","id":"2"}')
    client.receive(b'{"op":"cancel_action_goal","action":"/go","id":"1"}')
    client.receive(b'{"op":"cancel_action_goal","action":"/go","id":"never"}')
    (goal,) = goals
    assert (goal.args, goal.cancelled) == ({"far": 3}, True)
    goal.tell({"m": 1})
    goal.fail("enough")
    client.receive(b'{"op":"send_action_goal","action":"/go","id":"3"}')
    goals[1].succeed({"m": 3})
    assert [(text["op"], text["values"], text.get("status"), text.get("result")) for text in sent(client)] == [
        ("action_feedback", {"m": 1}, None, None),
        ("action_result", "enough", 5, False),
        ("action_result", {"m": 3}, 4, True),
    ]
    assert client.goals == {}
    client.unadvertise_action("/go")
    assert client.registrations() == []


def test_answers_find_who_asked_and_nobody_waits_for_ever() -> None:
    client, heard = ClientProtocol(), []

    def take(values: Any, result: bool) -> None:
        heard.append((values, result))

    first = json.loads(client.call_service("/s", {"x": 1}, take))
    goal = json.loads(client.send_goal("/a", "t/A", {"y": 2}, take, heard.append))
    silent = json.loads(client.send_goal("/a", "t/A", {}, take))
    assert (goal["feedback"], silent["feedback"]) == (True, False)
    for answer in (
        {"op": "action_feedback", "action": "/a", "id": goal["id"], "values": 5},
        {"op": "action_feedback", "action": "/a", "id": silent["id"], "values": 6},
        {"op": "action_feedback", "action": "/a", "id": "no", "values": 7},
        {"op": "service_response", "service": "/s", "id": first["id"], "values": {"z": 1}, "result": True},
        {"op": "service_response", "service": "/s", "id": first["id"], "values": {"z": 2}, "result": True},
        {"op": "action_result", "action": "/a", "id": goal["id"], "values": {}, "status": 4, "result": True},
        {"op": "set_level", "level": "none"},
    ):
        client.receive(json.dumps(answer).encode())
    assert heard == [5, ({"z": 1}, True), ({}, True)]
    client.receive(b'{"op":"send_action_goal","action":"/go","id":"1"}')
    client.goals["x"] = Goal(client, "/go", "x", {})
    kept = client.goals["x"]
    client.end_calls()
    assert heard[-1] == ("the connection has ended", False)
    assert (kept.cancelled, client.goals) == (True, {})


def test_a_program_may_read_the_fields_that_it_wants() -> None:
    class Wanted(msgspec.Struct):
        y: float

    client = ClientProtocol(dialect="ros2")
    client.subscribe("/p", "geometry_msgs/Point", reads=Wanted)
    received = client.receive(write_publish("/p", {"x": 1.0, "y": 2.0, "z": 3.0}))
    assert received == ("/p", Wanted(2.0))
    long_way = client.receive(b'{"op": "publish", "topic": "/p", "msg": {"x": 1.0, "y": 2.5, "z": 3.0}}')
    assert long_way is not None
    assert long_way.message.y == 2.5
