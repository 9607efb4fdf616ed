"""Quality of service: what a publisher or subscriber asks for is done. The rest is in test_server_protocol.py."""

from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge

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


@pytest.mark.parametrize("lifespan", [2.0, {"sec": 1, "nanosec": 10**9 - 1}])
def test_lifespan_ends_a_latch(pair: tuple[Any, Any], lifespan: Any) -> None:
    talker, late = pair
    talker.send(op="advertise", **CHATTER, qos={"durability": "transient_local", "lifespan": lifespan})
    say(talker, "old")
    for now_ns, expected in ((S, ["old"]), (3 * S, [])):
        late.now_ns = now_ns
        late.send(op="subscribe", **CHATTER)
        assert words(late) == expected
        late.send(op="unsubscribe", topic="/chatter")


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
