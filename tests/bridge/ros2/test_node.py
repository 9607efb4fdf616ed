"""What can be said of the ROS 2 link without a ROS 2; tests/interop/test_ros2.py has a real one."""

import importlib.util

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.ros2 import node as ros2
from simconsole.bridge.ros2.message_types import describe, load
from simconsole.bridge.ros2.node import Ros2Link, check, role_of_graph
from simconsole.bridge.ros2.received_messages import TURN_BYTES, TURN_MESSAGES
from simconsole.profiles.bridge import BridgeProfile, Ros2Profile
from simconsole.values.errors import BridgeError, ProfileError


@pytest.mark.parametrize(
    ("said", "anonymous", "role"),
    [
        (None, Role.CONTROL, Role.CONTROL),  # no tokens: who is on this machine may do everything
        (None, Role.NONE, Role.VIEW),
        (None, Role.PUBLISH, Role.PUBLISH),
        ("view", Role.CONTROL, Role.VIEW),
        ("control", Role.NONE, Role.CONTROL),
    ],
)
def test_role_of_the_graph(said: str | None, anonymous: Role, role: Role) -> None:
    profile = BridgeProfile(ros2=Ros2Profile(role=said))  # type: ignore[arg-type]  # one of its words
    assert role_of_graph(profile, anonymous) is role


def test_a_graph_of_other_machines_only_where_the_network_is_trusted(monkeypatch: pytest.MonkeyPatch) -> None:
    settings = Ros2Profile(discovery="subnet")
    with pytest.raises(ProfileError, match=r"ros2\.discovery: value subnet: only with outputs\.bridge\.trust_network"):
        check(BridgeProfile(ros2=settings))
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: object())
    check(BridgeProfile(ros2=settings, trust_network=True))


def test_without_rclpy() -> None:
    profile = BridgeProfile(port=0, ros2=Ros2Profile())
    check(BridgeProfile())
    with pytest.raises(BridgeError, match="there is no rclpy; pip install 'simconsole\\[ros2\\]'"):
        check(profile)
    bridge = ConsoleBridge(profile)
    with pytest.raises(BridgeError, match="there is no rclpy"):
        Ros2Link(bridge, profile, lambda: None)
    assert bridge.router.sessions == ()
    assert (load("std_msgs/msg/String"), describe("std_msgs/msg/String")) == (None, None)


def test_a_flood_of_remarks_is_logged_sparingly(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(ros2, "Graph", lambda *arguments: None)
    link = Ros2Link(ConsoleBridge(BridgeProfile(port=0)), BridgeProfile(port=0), lambda: None)
    for _ in range(3000):
        link._log("/driver", "wrong")
    assert caplog.text.count("/driver") == ros2.LOGGED + 3


def test_a_flood_of_calls_is_taken_in_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    handled: list[str] = []
    woken: list[int] = []
    monkeypatch.setattr(ros2, "Graph", lambda *arguments: None)
    link = Ros2Link(ConsoleBridge(BridgeProfile(port=0)), BridgeProfile(port=0), lambda: woken.append(1))
    monkeypatch.setattr(link._relay.calls, "call_service", lambda key, name, data, now_ns: handled.append(key))
    for number in range(TURN_MESSAGES + 1):
        link._put("call_service", str(number), "/flip", b"")
    for _ in range(3):
        link._put("call_service", "long", "/flip", bytes(TURN_BYTES))
    counts: list[int] = []
    while not counts or counts[-1] < TURN_MESSAGES + 4:
        woken.clear()
        link.pump(0)
        counts.append(len(handled))
        assert bool(woken) is (counts[-1] < TURN_MESSAGES + 4), "it asks for another turn while something is left"
    assert counts == [TURN_MESSAGES, TURN_MESSAGES + 2, TURN_MESSAGES + 3, TURN_MESSAGES + 4]
