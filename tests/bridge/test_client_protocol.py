import json
import math
from typing import Any

import pytest

from simconsole.bridge.client_protocol import MAX_STATUS, ClientProtocol
from simconsole.errors import BridgeError, LocalProtocolError


def publish(topic: str, msg: Any) -> bytes:
    return json.dumps({"op": "publish", "topic": topic, "msg": msg}).encode()


def test_messages_are_typed() -> None:
    client = ClientProtocol()
    assert json.loads(client.subscribe("/odom", "nav_msgs/Odometry", throttle_rate=20, queue_length=3)) == {
        "op": "subscribe",
        "topic": "/odom",
        "type": "nav_msgs/msg/Odometry",
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


def test_statuses_are_kept_bounded() -> None:
    client = ClientProtocol()
    for number in range(MAX_STATUS + 5):
        client.receive(b'{"op":"status","level":"error","msg":"%d"}' % number)
    assert len(client.statuses) == MAX_STATUS
    assert client.statuses[-1].msg == str(MAX_STATUS + 4)


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
    wishes = [json.loads(text) for text in client.wishes()]
    assert [(wish["op"], wish["topic"]) for wish in wishes] == [("advertise", "/b"), ("subscribe", "/d")]
