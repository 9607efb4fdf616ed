"""What a graph sends faster than it can be taken is lost before the relay sees it; those who subscribe are told."""

from collections.abc import Callable
from typing import Any

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.relay import Relay
from simconsole.bridge.protocol.access import Role

S = 10**9


def test_it_is_said_once_a_second_and_counted(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    relay = Relay(bridge, Role.CONTROL, lambda name: None, lambda: None)
    peer, other = join(bridge), join(bridge)
    peer.send(op="subscribe", topic="/scan", type="std_msgs/String", queue_length=10)
    other.send(op="subscribe", topic="/scan", type="std_msgs/String", queue_length=1)
    for now_ns, count in ((0, 3), (1, 4), (S, 1)):
        relay.lost("/scan", count, now_ns)
    relay.lost("/gone", 1, 0)
    assert [(message["level"], message["msg"]) for message in peer.heard()] == [
        ("error", f"/scan: too slow: {count} messages dropped so far") for count in (3, 8)
    ]
    assert other.heard() == [], "it wants the newest only"
    assert peer.session.counts().dropped == other.session.counts().dropped == 8
