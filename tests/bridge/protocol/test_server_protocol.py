import json
import math
from collections.abc import Callable
from typing import Any

import cbor2
import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.messages import standard_registry
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.protocol.server_protocol import Router
from simconsole.profiles.bridge import BridgeLimits
from simconsole.values.errors import LocalProtocolError, RemoteProtocolError

MS = 1_000_000
CHATTER = {"topic": "/chatter", "type": "std_msgs/String"}


def told(peer: Any, complaint: str) -> bool:
    """Whether the only status a peer got says `complaint`."""
    statuses = peer.statuses()
    return len(statuses) == 1 and complaint in statuses[0]


def test_message_passes_from_client_to_client(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    talker, listener = join(bridge), join(bridge)
    listener.send(op="subscribe", **CHATTER)
    talker.send(op="advertise", **CHATTER)
    talker.publish("/chatter", {"data": "hello"})
    assert listener.heard() == [{"op": "publish", "topic": "/chatter", "msg": {"data": "hello"}}]
    assert talker.heard() == []


def test_burst_between_clients_loses_nothing(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    talker, listener = join(bridge), join(bridge)
    listener.send(op="subscribe", **CHATTER)
    talker.send(op="advertise", **CHATTER)
    for number in range(50):
        talker.publish("/chatter", {"data": str(number)})
    assert [message["msg"]["data"] for message in listener.heard()] == [str(number) for number in range(50)]


def test_client_hears_itself_under_the_name_it_used(peer: Any) -> None:
    peer.send(op="subscribe", topic="chatter", type="std_msgs/msg/String")
    peer.publish("/chatter", {"data": "x"})
    assert peer.heard() == [{"op": "publish", "topic": "chatter", "msg": {"data": "x"}}]


def test_second_subscription_of_a_client_is_served_by_one_delivery(peer: Any) -> None:
    peer.send(op="subscribe", id="a", **CHATTER)
    peer.send(op="subscribe", id="b", **CHATTER)
    peer.publish("/chatter", {"data": "x"})
    assert len(peer.heard()) == 1
    peer.send(op="unsubscribe", topic="/chatter", id="a")
    peer.publish("/chatter", {"data": "y"})
    assert len(peer.heard()) == 1
    peer.send(op="unsubscribe", topic="/chatter", id="b")
    peer.send(op="unadvertise", topic="/chatter")
    assert peer.publish("/chatter", {"data": "z"}).kind == "refused"


def test_unsubscribe_without_id_ends_all_and_drops_what_waits(peer: Any) -> None:
    peer.send(op="subscribe", id="a", **CHATTER)
    peer.send(op="subscribe", id="b", **CHATTER)
    peer.publish("/chatter", {"data": "x"})
    peer.send(op="unsubscribe", topic="/chatter")
    assert peer.heard() == []
    assert peer.session.send_queue.bytes == 0


def test_latched_message_reaches_who_comes_later(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    talker, listener = join(bridge), join(bridge)
    talker.send(op="advertise", latch=True, **CHATTER)
    talker.publish("/chatter", {"data": "old"})
    talker.publish("/chatter", {"data": "kept"})
    listener.send(op="subscribe", **CHATTER)
    listener.send(op="subscribe", id="again", **CHATTER)
    assert [message["msg"]["data"] for message in listener.heard()] == ["kept"]


def test_nan_passes_as_null_both_ways(peer: Any) -> None:
    peer.send(op="subscribe", topic="/f", type="std_msgs/Float64")
    for text in ('{"data": null}', '{"data": NaN}', '{"data": -Infinity}'):
        assert peer.send('{"op":"publish","topic":"/f","msg":' + text + "}").kind == "done"
    assert [message["msg"] for message in peer.heard()] == [{"data": None}] * 3


def test_message_without_a_stamp_is_stamped_with_the_present(peer: Any) -> None:
    peer.bridge.router.ros_time_ns = 7_000_000_009
    peer.send(op="subscribe", topic="/p", type="geometry_msgs/PoseStamped")
    messages: list[dict[str, Any]] = [{}, {"header": {"frame_id": "map"}}, {"header": {"stamp": {"sec": 0}}}]
    for msg in messages:
        peer.publish("/p", msg)
    stamps = [message["msg"]["header"]["stamp"] for message in peer.heard()]
    assert stamps == [{"sec": 7, "nanosec": 9}] * 2 + [{"sec": 0, "nanosec": 0}]


@pytest.mark.parametrize(
    ("operation", "complaint"),
    [
        ({"op": "publish", "topic": "/new", "msg": {}}, "advertise the topic first"),
        ({"op": "publish", "topic": "/odom", "msg": {}}, "only the console publishes"),
        ({"op": "publish", "topic": "/chatter", "msg": [1]}, "msg must be an object"),
        ({"op": "publish", "topic": "/chatter", "msg": {"data": 5}}, "`$.data`"),
        ({"op": "publish", "topic": "/../etc", "msg": {}}, "not a topic name"),
        ({"op": "advertise", "topic": "/odom", "type": "nav_msgs/Odometry"}, "only the console publishes"),
        ({"op": "advertise", "topic": "/chatter", "type": "std_msgs/Bool"}, "is std_msgs/msg/String"),
        ({"op": "advertise", "topic": "/new", "type": "demo/Nothing"}, "demo/msg/Nothing is not known"),
        ({"op": "advertise", "topic": "/new", "type": "nonsense"}, "not a message type name"),
        ({"op": "subscribe", "topic": "/new"}, "give its type"),
        ({"op": "subscribe", "topic": "/odom", "type": "std_msgs/String"}, "is nav_msgs/msg/Odometry"),
        ({"op": "subscribe", "topic": "/odom", "compression": "zip"}, "`$.compression`"),
        ({"op": "unsubscribe", "topic": "/odom"}, "not subscribed"),
        ({"op": "unsubscribe", "topic": "/chatter", "id": "other"}, "not subscribed"),
        ({"op": "unadvertise", "topic": "/new"}, "not advertised"),
        ({"op": "unadvertise", "topic": "/chatter", "id": "other"}, "not advertised"),
        ({"op": "advertise_service", "service": "/x y", "type": "std_srvs/Empty"}, "not a topic name"),
        ({"op": "service_response", "service": "/x", "values": {}}, "nobody waits for this"),
        ({"op": "fragment", "id": "q1", "data": "x", "num": 1, "total": 1}, "whole number below 1"),
        (
            {
                "op": "fragment",
                "id": "q1",
                "data": '{"op":"fragment","id":"q1","data":"","num":0,"total":1}',
                "num": 0,
                "total": 1,
            },
            "a fragment of fragments",
        ),
    ],
)
def test_refusal_is_answered_with_id_and_reason(peer: Any, operation: dict[str, Any], complaint: str) -> None:
    peer.send(op="advertise", id="mine", **CHATTER)
    peer.send(op="subscribe", id="mine", **CHATTER)
    outcome = peer.send(**{"id": "q1", **operation})
    assert outcome.kind == "refused"
    answers = peer.heard()
    assert len(answers) == 1
    assert answers[0]["op"] == "status"
    assert answers[0]["level"] == "error"
    assert answers[0]["id"] == operation.get("id", "q1")
    assert complaint in answers[0]["msg"]
    assert operation["op"] in answers[0]["msg"]
    assert peer.session.refused == 1


def test_refused_topics_leave_nothing_behind(peer: Any) -> None:
    peer.send(op="subscribe", topic="/new", type="std_msgs/String", compression="zip")
    peer.send(op="advertise", topic="/new", type="demo/Nothing")
    assert peer.session.queues == {}
    assert peer.session.advertised == {}
    assert peer.send(op="subscribe", topic="/new", type="std_msgs/Bool").kind == "done"


def test_set_level_and_status_of_the_client(peer: Any) -> None:
    assert peer.send(op="set_level", level="none").kind == "done"
    assert peer.send("nonsense").kind == "refused"
    assert peer.heard() == []
    outcome = peer.send(op="status", level="info", msg="hello")
    assert (outcome.kind, outcome.text) == ("remark", "info: hello")


def test_throttle_and_queue_of_a_subscription(peer: Any) -> None:
    peer.send(op="subscribe", throttle_rate=100, queue_length=1, **CHATTER)
    for number in range(30):
        peer.now_ns = number * 10 * MS
        peer.publish("/chatter", {"data": str(number)})
    assert [message["msg"]["data"] for message in peer.heard(0)] == ["29"]
    assert peer.session.send_queue.dropped == 29
    delivered = []
    for number in range(30, 60):
        peer.now_ns = number * 10 * MS
        peer.publish("/chatter", {"data": str(number)})
        delivered += [message["msg"]["data"] for message in peer.heard()]
    assert delivered == ["30", "40", "50"]


def test_client_that_goes_leaves_nothing(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    first = join(bridge)
    first.send(op="subscribe", topic="/odom", type="nav_msgs/Odometry")
    first.send(op="subscribe", **CHATTER)
    first.send(op="advertise", **CHATTER)
    bridge.disconnect(first.session, 0)
    bridge.disconnect(first.session, 0)
    assert bridge.router.sessions == ()
    assert not bridge.router.has_subscribers("/odom")
    other = join(bridge)
    # The topic is gone with its only user: its type is free again.
    assert other.send(op="advertise", topic="/chatter", type="std_msgs/Bool").kind == "done"


def test_topic_stays_while_one_side_uses_it(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    talker, listener = join(bridge), join(bridge)
    talker.send(op="advertise", id="a", **CHATTER)
    talker.send(op="advertise", id="b", **CHATTER)
    talker.send(op="unadvertise", topic="/chatter", id="a")
    listener.send(op="subscribe", **CHATTER)
    talker.send(op="unadvertise", topic="/chatter", id="b")
    assert talker.publish("/chatter", {"data": "still known"}).kind == "done"  # and it publishes again
    listener.send(op="unsubscribe", topic="/chatter")
    assert talker.send(op="unadvertise", topic="/chatter").kind == "done"
    assert talker.publish("/chatter", {"data": "gone"}).kind == "refused"


def test_limits_of_one_client_and_of_all() -> None:
    router = Router(standard_registry(), BridgeLimits(subscriptions=3, topics=16), 1)
    session = router.connect("x")

    def send(op: str, topic: str, more: str = "") -> str:
        text = f'{{"op":"{op}","topic":"{topic}","type":"std_msgs/String"{more}}}'
        return router.receive(session, text.encode(), 0).text

    assert [bool(send("subscribe", f"/t{number}")) for number in range(5)] == [False, False, False, True, True]
    assert [bool(send("subscribe", "/t0", f',"id":{number}')) for number in range(4)] == [False, False, True, True]
    answers = [send("advertise", f"/a{number}") for number in range(16)]
    assert answers[12] == ""
    assert "16 topics already" in answers[13]
    assert send("subscribe", "/t0", ',"id":0,"queue_length":1000000') == ""
    assert session.queues["/t0"].depth <= 1000
    for number in range(2000):
        send("advertise", "/a0", f',"id":{number}')
    assert len(session.advertised["/a0"]) <= 16


def test_two_outputs_of_one_name_are_a_bug() -> None:
    router = Router(standard_registry(), BridgeLimits(), 1)
    router.add_output("/a", "std_msgs/String")
    with pytest.raises(LocalProtocolError, match="two of the console"):
        router.add_output("/a", "std_msgs/String")


class Commanded:
    """A router with one command topic that takes numbers up to 10, and one request open to everyone."""

    def __init__(self) -> None:
        self.refused = 0
        self.taken: list[float] = []
        self.fresh = 0
        self.router = Router(standard_registry(), BridgeLimits(), 500 * MS, self.count)
        self.router.desk.on_new_commander = self.begin
        self.router.add_command("/cmd", "std_msgs/Float64", self.accept)
        self.router.add_command("/ask", "std_msgs/Float64", self.accept, leased=False)

    def begin(self) -> None:
        self.fresh += 1

    def count(self) -> None:
        self.refused += 1

    def accept(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        if message.data > 10.0:
            raise RemoteProtocolError("too much - at `$.data`")
        self.taken.append(message.data)

    def send(self, session: Any, data: str, now_ns: int = 0, topic: str = "/cmd") -> str:
        text = f'{{"op":"publish","topic":"{topic}","msg":{{"data":{data}}}}}'
        return self.router.receive(session, text.encode(), now_ns).kind


def test_one_commander_at_a_time() -> None:
    console = Commanded()
    first, second = console.router.connect("1"), console.router.connect("2")
    assert console.send(first, "11") == "refused"
    assert console.send(second, "2") == "command"
    assert console.send(first, "1", 100 * MS) == "refused"
    assert console.send(first, "1", 499 * MS) == "refused"
    assert console.send(first, "1", 500 * MS) == "command"
    assert console.send(second, "2", 501 * MS) == "refused"
    assert console.taken == [2.0, 1.0]
    assert console.fresh == 3


def test_lease_ends_with_its_holder() -> None:
    console = Commanded()
    first, second = console.router.connect("1"), console.router.connect("2")
    console.send(first, "1", 0)
    assert not console.router.disconnect(second, 1)
    assert console.router.disconnect(first, 2)
    third = console.router.connect("3")
    assert console.send(third, "3", 3) == "command"


def test_requests_need_no_lease() -> None:
    console = Commanded()
    first, second = console.router.connect("1"), console.router.connect("2")
    console.send(first, "1")
    assert console.send(second, "2", topic="/ask") == "command"
    assert console.send(first, "3", 1) == "command"


def test_mistakes_of_a_stranger_do_not_count_against_the_commander() -> None:
    console = Commanded()
    first, second = console.router.connect("1"), console.router.connect("2")
    console.send(first, "1")
    for data in ("null", "NaN", "11", '"x"'):
        console.send(second, data)
    console.router.receive(second, b"garbage", 0)
    assert console.refused == 0
    for data in ("null", "NaN", "11", '"x"'):
        console.send(first, data)
    console.router.receive(first, b"garbage", 0)
    console.router.receive(first, Binary(b"garbage"), 0)
    assert console.refused == 6
    assert (first.refused, second.refused) == (6, 5)


@pytest.mark.parametrize("data", ["null", "NaN", "Infinity", "-Infinity", "1e999", '1,"data":1', '"1"', "true", "{}"])
def test_command_is_refused_whole(data: str) -> None:
    console = Commanded()
    session = console.router.connect("1")
    assert console.send(session, data) == "refused"
    assert console.taken == []
    assert console.send(session, "1") == "command"


def test_accepted_commands_can_be_watched() -> None:
    console = Commanded()
    driver, watcher = console.router.connect("1"), console.router.connect("2")
    console.router.receive(watcher, b'{"op":"subscribe","topic":"/cmd","type":"std_msgs/Float64"}', 0)
    console.send(driver, "11")
    console.send(driver, "5")
    assert watcher.next_text(0) == b'{"op":"publish","topic":"/cmd","msg":{"data":5.0}}'
    assert watcher.next_text(0) is None


def test_stalled_client_costs_bounded_memory_and_no_one_a_message(
    bridge: ConsoleBridge, join: Callable[..., Any]
) -> None:
    talker, stalled, healthy = join(bridge), join(bridge), join(bridge)
    for client in (stalled, healthy):
        client.send(op="subscribe", **CHATTER)
    talker.send(op="advertise", **CHATTER)
    heard = 0
    for _ in range(1000):
        talker.publish("/chatter", {"data": "x" * 20_000})
        heard += len(healthy.heard())
    assert heard == 1000
    assert stalled.session.send_queue.bytes <= 1_048_576
    kept = sum(message["op"] == "publish" for message in stalled.heard())
    assert kept > 0
    assert kept + stalled.session.send_queue.dropped == 1000


def test_text_in_fragments_is_applied_once_it_is_whole(peer: Any) -> None:
    text = json.dumps({"op": "advertise", "id": "mine", **CHATTER})
    for number in (2, 0, 1):
        at = number * 20
        data = text[at : at + 20] if number < 2 else text[at:]
        outcome = peer.send(op="fragment", id=0, data=data, num=number, total=2.7)
    assert outcome.kind == "done"
    assert peer.session.advertised == {"/chatter": {"mine"}}


def test_each_subscriber_has_its_own_form(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    plain, small = join(bridge), join(bridge)
    old = join(bridge)
    old.session.dialect = "ros1"
    topic = {"topic": "/p", "type": "geometry_msgs/PointStamped"}
    for client in (plain, old):
        client.send(op="subscribe", **topic)
    small.send(op="subscribe", fragment_size=40, **topic)
    plain.send(op="advertise", **topic)
    for _ in range(2):
        plain.publish("/p", {"header": {"stamp": {"secs": 1, "nsecs": 2}}, "point": {"x": None}})
    point = {"x": None, "y": 0.0, "z": 0.0}
    new_header = {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": ""}
    assert [message["msg"] for message in plain.heard()] == [{"header": new_header, "point": point}] * 2
    headers = [message["msg"]["header"] for message in old.heard()]
    assert headers == [{"seq": number, "stamp": {"secs": 1, "nsecs": 2}, "frame_id": ""} for number in (1, 2)]
    pieces = small.heard()
    assert {piece["op"] for piece in pieces} == {"fragment"}
    assert all(len(piece["data"]) <= 40 and type(piece["total"]) is int for piece in pieces)
    first, second = ([piece for piece in pieces if piece["id"] == name] for name in ("f1", "f2"))
    assert [piece["num"] for piece in first] == list(range(first[0]["total"]))
    whole = "".join(piece["data"] for piece in second)
    assert json.loads(whole) == {"op": "publish", "topic": "/p", "msg": {"header": new_header, "point": point}}


def test_binary_command_is_checked_for_what_json_cannot_say(peer: Any, control: Callable[..., Any]) -> None:
    message = {**control(), "control_time": {"sec": 1}}
    for jerk, kind in ((math.nan, "refused"), (math.inf, "refused"), (0.5, "command")):
        message["longitudinal"]["jerk"] = jerk
        data = cbor2.dumps({"op": "publish", "topic": "/control/command/control_cmd", "msg": message})
        assert peer.send(Binary(data)).kind == kind
    listed = {"op": "publish", "topic": "/ball/desired_speed", "msg": {"data": [1.0, math.nan]}}
    assert "no command" in peer.send(Binary(cbor2.dumps(listed))).text
