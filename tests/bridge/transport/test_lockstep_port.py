"""Two platforms on one server in lockstep: each has its commander, its slot, its topics; some they have together."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.console.surroundings import NOWHERE
from simconsole.bridge.transport.lockstep_port import LockstepPort
from simconsole.bridge.transport.lockstep_server import LockstepBridge
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.signals import Event
from tests.bridge.transport.test_lockstep_server import beside
from tests.patience import PATIENCE_S

NAMES = ("/a", "/b")


@pytest.fixture
def ports() -> Iterator[tuple[LockstepBridge, list[LockstepPort]]]:
    with LockstepBridge(BridgeProfile(port=0, namespace="/a"), odometry_hz=50.0, platforms=2) as bridge:
        second = LockstepPort.beside(bridge, BridgeProfile(port=0, namespace="/b"), 50.0, NOWHERE)
        yield bridge, [LockstepPort.of_first(bridge), second]


def command_of(name: str) -> dict[str, Any]:
    speed = {"x": float(NAMES.index(name) + 1), "y": 0.0, "z": 0.0}
    return {"linear": speed, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}


def answering(url: str, name: str, count: int, heard: list[str]) -> Callable[[], None]:
    """Command one platform, `count` times, and leave; note what was heard beside odometry."""

    def run() -> None:
        with BridgeClient(url) as client:
            client.advertise(f"{name}/cmd_vel", "geometry_msgs/Twist")
            for topic, kind in (("/tf_static", "tf2_msgs/TFMessage"), ("/clock", "rosgraph_msgs/Clock")):
                client.subscribe(topic, kind, queue_length=100)
            client.subscribe(f"{name}/odom", "nav_msgs/Odometry")
            client.connect(PATIENCE_S)
            answers = 0
            while answers < count:
                received = client.receive(PATIENCE_S)
                assert received is not None
                heard.append(received.topic)
                if received.topic.endswith("/odom"):
                    answers += 1
                    client.publish(f"{name}/cmd_vel", command_of(name))

    return run


def test_each_platform_has_its_own_commander(
    ports: tuple[LockstepBridge, list[LockstepPort]], snapshot: Callable[..., Any]
) -> None:
    bridge, (first, second) = ports
    heard: list[list[str]] = [[], []]
    with beside(answering(bridge.url, "/a", 2, heard[0])), beside(answering(bridge.url, "/b", 4, heard[1])):
        assert bridge.wait_for_client(PATIENCE_S, [first.console, second.console])
        assert (first.clients, second.clients) == (1, 1)
        for tick in (5, 10):
            for port in (first, second):
                assert port.exchange(snapshot(tick), PATIENCE_S, lambda: False)
        (one, events), (other, others_events) = first.take(11), second.take(11)
        assert (one.speed_mps, other.speed_mps) == (1.0, 2.0)
        while first.clients:  # it has said all that it had to say, and leaves
            first.stand(0.05)
        assert second.exchange(snapshot(15), PATIENCE_S, lambda: False)
        assert (int(events.events) | int(first.take(16)[1].events)) & Event.COMMANDER_LOST
        other, more = second.take(16)
        assert not (int(others_events.events) | int(more.events)) & Event.COMMANDER_LOST
        assert other.sequence == 3.0
        assert second.exchange(snapshot(20), PATIENCE_S, lambda: False), "so it is still there"
    for topics in heard:
        assert topics.count("/tf_static") == 2, "one of each platform"
        assert topics.count("/clock") <= 4, "one tells the time for both"


def test_who_comes_later_gets_what_both_have_latched(
    ports: tuple[LockstepBridge, list[LockstepPort]], snapshot: Callable[..., Any]
) -> None:
    bridge, both = ports
    for port in both:
        port.publish(snapshot(5))
    heard: list[str] = []
    with beside(answering(bridge.url, "/b", 1, heard)):
        assert bridge.wait_for_client(PATIENCE_S, [both[1].console])
        assert both[1].exchange(snapshot(10), PATIENCE_S, lambda: False)
    assert heard.count("/tf_static") == 2
    assert both[0].counts()["connections"] == 1


def test_acts_belong_to_the_platform_that_was_operated(ports: tuple[LockstepBridge, list[LockstepPort]]) -> None:
    _, (first, second) = ports
    second.console.operator.operate({"act": "mark", "note": "here"})
    assert first.take_acts() == []
    assert b"here" in second.take_acts()[0]


def test_all_are_asked_before_an_answer_is_waited_for(
    ports: tuple[LockstepBridge, list[LockstepPort]], snapshot: Callable[..., Any]
) -> None:
    bridge, (first, second) = ports
    with BridgeClient(bridge.url) as one, beside(answering(bridge.url, "/b", 1, [])):
        one.subscribe("/a/odom", "nav_msgs/Odometry")  # hears, and says nothing
        with beside(lambda: one.connect(PATIENCE_S)):
            assert bridge.wait_for_client(PATIENCE_S, [first.console, second.console])
        asked = [port.ask(snapshot(5)) for port in (first, second)]
        assert not asked[0].is_settled
        assert second.hear(asked[1:], PATIENCE_S, lambda: False) == [True]
        assert first.hear(asked, 0.02, lambda: False) == [False, True]
        assert second.take(6)[0].speed_mps == 2.0
        assert first.hear(asked, PATIENCE_S, lambda: True) == [False, True], "nor longer than until it is to stop"
