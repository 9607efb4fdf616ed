"""Quality of service, and topics that are shared: what is asked for is done. The rest is in test_server_protocol.py."""

import json
from collections.abc import Callable
from typing import Any

import cbor2
import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.messages import standard_registry
from simconsole.bridge.protocol.message_decoding import Binary

S = 10**9
CHATTER = {"topic": "/chatter", "type": "std_msgs/String"}


@pytest.fixture
def pair(bridge: ConsoleBridge, join: Callable[..., Any]) -> tuple[Any, Any]:
    """A publisher and a client that has not subscribed yet."""
    return join(bridge), join(bridge)


def words(peer: Any) -> list[str]:
    return [message["msg"]["data"] for message in peer.heard() if message["op"] == "publish"]


def say(peer: Any, *texts: str, **more: Any) -> None:
    for text in texts:
        assert peer.publish("/chatter", {"data": text}, **more).kind == "done"


@pytest.mark.parametrize("how", [{"latch": True}, {"qos": {"durability": "transient_local"}}])
@pytest.mark.parametrize("when", ["advertise", "publish"])
def test_transient_local_is_a_latch(pair: tuple[Any, Any], how: dict[str, Any], when: str) -> None:
    talker, late = pair
    talker.send(op="advertise", **CHATTER, **(how if when == "advertise" else {}))
    say(talker, "old", "new", **(how if when == "publish" else {}))
    late.send(op="subscribe", **CHATTER)
    assert words(late) == ["new"]


@pytest.mark.parametrize("qos", [{}, {"durability": "volatile"}, {"durability": "system_default", "depth": 3}])
def test_other_durability_is_none(pair: tuple[Any, Any], qos: dict[str, Any]) -> None:
    talker, late = pair
    talker.send(op="advertise", **CHATTER, qos=qos)
    say(talker, "old")
    late.send(op="subscribe", **CHATTER)
    assert words(late) == []


def test_volatile_subscriber_of_a_latched_topic_gets_what_comes_only(pair: tuple[Any, Any]) -> None:
    talker, late = pair
    talker.send(op="advertise", **CHATTER, latch=True)
    say(talker, "old")
    late.send(op="subscribe", **CHATTER, qos={"durability": "volatile"})
    say(talker, "new")
    assert words(late) == ["new"]


@pytest.mark.parametrize("lifespan", [2.0, {"sec": 1, "nanosec": 10**9 - 1}, {"secs": 1, "nsecs": 10**9 - 1}])
def test_lifespan_ends_a_latch(pair: tuple[Any, Any], lifespan: Any) -> None:
    talker, late = pair
    talker.send(op="advertise", **CHATTER, qos={"durability": "transient_local", "lifespan": lifespan})
    say(talker, "old")
    for now_ns, expected in ((S, ["old"]), (3 * S, [])):
        late.now_ns = now_ns
        late.send(op="subscribe", **CHATTER)
        assert words(late) == expected
        late.send(op="unsubscribe", topic="/chatter")


@pytest.mark.parametrize("lifespan", ["infinite", "INFINITE", 0, {"secs": 0, "nsecs": 0}])
def test_lifespan_without_an_end_is_none(pair: tuple[Any, Any], lifespan: Any) -> None:
    talker, late = pair
    talker.send(op="advertise", **CHATTER, qos={"durability": "TRANSIENT_LOCAL", "lifespan": lifespan})
    say(talker, "old")
    late.now_ns = 10**9 * S
    late.send(op="subscribe", **CHATTER)
    assert words(late) == ["old"]


@pytest.mark.parametrize(
    ("deadline", "expected_ns"),
    [(0.5, S // 2), ({"secs": 1, "nsecs": 1}, S + 1), ("infinite", None), ("BEST_AVAILABLE", None)],
)
def test_what_only_a_graph_applies_is_kept_for_it(
    pair: tuple[Any, Any], deadline: Any, expected_ns: int | None
) -> None:
    talker, _ = pair
    talker.send(op="advertise", **CHATTER, qos={"reliability": "BEST_EFFORT", "deadline": deadline})
    topic = talker.bridge.router.topics["/chatter"]
    assert (topic.is_best_effort, topic.deadline_ns) == (True, expected_ns)


@pytest.mark.parametrize("qos", [{"deadline": -1}, {"lifespan": "for ever"}, {"lifespan": {"days": 1}}])
def test_quality_of_service_that_nobody_can_read_is_refused(pair: tuple[Any, Any], qos: dict[str, Any]) -> None:
    assert pair[0].send(op="advertise", **CHATTER, qos=qos).kind == "refused"


def test_publishing_with_a_type_advertises(pair: tuple[Any, Any]) -> None:
    talker, listener = pair
    say(talker, "first", type="std_msgs/String")
    listener.send(op="subscribe", topic="/chatter")
    say(talker, "second", type="std_msgs/msg/String")
    say(talker, "third")
    assert words(listener) == ["second", "third"]
    assert talker.bridge.router.topics["/chatter"].publishers == {talker.session.number}
    assert talker.publish("/chatter", {"data": 1}, type="std_msgs/Int32").kind == "refused"
    assert talker.publish("/other", {"data": 1}, type="std_msgs/NoSuch").kind == "refused"
    assert "/other" not in talker.bridge.router.topics


def test_publishing_on_a_topic_that_another_has_made_advertises_too(pair: tuple[Any, Any]) -> None:
    talker, listener = pair
    for more in ({}, {"type": "std_msgs/String"}):
        listener.send(op="subscribe", **CHATTER)
        say(talker, "here", **more)
        assert talker.bridge.router.topics["/chatter"].publishers == {talker.session.number}
        assert words(listener) == ["here"]
        talker.send(op="unadvertise", topic="/chatter")
        listener.send(op="unsubscribe", topic="/chatter")
    assert "/chatter" not in talker.bridge.router.topics


def test_publishing_with_a_type_cannot_take_a_topic_of_the_console(pair: tuple[Any, Any]) -> None:
    talker, _ = pair
    assert talker.publish("/odom", {}, type="nav_msgs/Odometry").kind == "refused"


@pytest.mark.parametrize("identifier", ["advertise:/chatter:2", "x" * 1000, 7])
def test_refused_second_advertisement_is_named_by_its_exact_id(pair: tuple[Any, Any], identifier: Any) -> None:
    talker, _ = pair
    talker.send(op="advertise", **CHATTER, id="advertise:/chatter:1")
    talker.send(op="advertise", topic="/chatter", type="std_msgs/Int32", id=identifier)
    assert [message["id"] for message in talker.heard()] == [identifier]


def test_ids_of_a_topic_are_bounded_and_all_that_are_taken_count(pair: tuple[Any, Any]) -> None:
    talker, _ = pair
    most = talker.bridge.profile.limits.topics
    kinds = [talker.send(op="advertise", **CHATTER, id=number).kind for number in range(most + 1)]
    assert kinds == ["done"] * most + ["refused"]
    assert all(talker.send(op="unadvertise", topic="/chatter", id=number).kind == "done" for number in range(most))
    assert talker.send(op="advertise", **CHATTER, id="y" * 1025).kind == "refused"


@pytest.mark.parametrize(
    ("asked", "kept"),
    [
        ({"qos": {"depth": 3}}, 3),
        ({"qos": {"depth": 3}, "queue_length": 5}, 5),
        ({"qos": {"history": "keep_all"}}, 200),
        ({"qos": {"history": "keep_last"}}, 100),
        ({"qos": {"depth": 0}}, 100),
    ],
)
def test_depth_of_a_subscriber_is_its_queue(pair: tuple[Any, Any], asked: dict[str, Any], kept: int) -> None:
    talker, slow = pair
    slow.send(op="subscribe", **CHATTER, **asked)
    say(talker, *map(str, range(200)))
    assert words(slow) == [str(number) for number in range(200 - kept, 200)]


def test_depth_of_a_publisher_is_for_whoever_does_not_say(pair: tuple[Any, Any]) -> None:
    talker, slow = pair
    talker.send(op="advertise", **CHATTER, qos={"depth": 2})
    slow.send(op="subscribe", **CHATTER)
    say(talker, "1", "2", "3")
    assert words(slow) == ["2", "3"]


def test_depth_ends_at_the_limit(pair: tuple[Any, Any]) -> None:
    talker, slow = pair
    slow.send(op="subscribe", **CHATTER, qos={"depth": 1_000_000})
    assert slow.session.queues["/chatter"].depth == 1000
    talker.send(op="advertise", **CHATTER, qos={"depth": 1_000_000})
    assert talker.bridge.router.topics["/chatter"].depth == 1000


def test_topics_of_the_console_keep_what_they_have(pair: tuple[Any, Any]) -> None:
    talker, _ = pair
    control = {"topic": "/control/command/control_cmd", "type": "autoware_control_msgs/Control"}
    talker.send(op="advertise", **control, qos={"durability": "transient_local", "depth": 7}, latch=True)
    topic = talker.bridge.router.topics[control["topic"]]
    assert (topic.latch, topic.depth, topic.lifespan_ns) == (False, 100, None)


def test_clients_of_one_spelling_and_encoding_share_a_text_and_others_get_their_own(
    bridge: ConsoleBridge, join: Callable[..., Any]
) -> None:
    talker = join(bridge)
    asked = [
        {"topic": "/chatter"},
        {"topic": "/chatter"},
        {"topic": "chatter"},
        {"topic": "/chatter", "compression": "cbor"},
        {"topic": "/chatter"},
    ]
    clients = [join(bridge) for _ in asked]
    for client, how in zip(clients, asked, strict=True):
        client.send(op="subscribe", type="std_msgs/String", **how)
    talker.send(op="advertise", **CHATTER)
    for word in ("one", "two"):
        say(talker, word)
        texts = [client.session.next_text(0) for client in clients]
        decoded = [(cbor2 if isinstance(text, Binary) else json).loads(text) for text in texts]
        assert [text["topic"] for text in decoded] == [how["topic"] for how in asked]
        assert [text["msg"]["data"] for text in decoded] == [word] * len(asked)
        assert [isinstance(text, Binary) for text in texts] == ["compression" in how for how in asked]
        assert texts[0] is texts[1]


def test_a_shared_output_is_published_by_clients_too_and_stays_when_they_leave(
    bridge: ConsoleBridge, join: Callable[..., Any]
) -> None:
    shared = {"topic": "/shared", "type": "std_msgs/String"}
    bridge.router.add_output("/shared", "std_msgs/String", shared=True)
    sender, listener = join(bridge), join(bridge)
    listener.send(op="subscribe", **shared)
    sender.send(op="advertise", **shared)
    sender.publish("/shared", {"data": "theirs"})
    bridge.router.publish("/shared", standard_registry().struct("std_msgs/String")("ours"), 0)
    assert sender.statuses() == []
    told = [message["msg"]["data"] for message in listener.heard()]
    assert told == ["theirs", "ours"], "the newer one has not taken the other's place"
    sender.send(op="unadvertise", topic="/shared")
    listener.send(op="unsubscribe", topic="/shared")
    assert bridge.router.topic("/shared") is not None
