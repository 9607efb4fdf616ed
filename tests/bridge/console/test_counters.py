from collections.abc import Callable
from typing import Any

from simconsole.bridge.console.counters import link_state, total_counts
from simconsole.bridge.console.endpoint import ConsoleBridge

CONTROL = "/control/command/control_cmd"


def test_counts_are_published_and_outlive_their_clients(
    bridge: ConsoleBridge, join: Callable[..., Any], control: Callable[..., Any], snapshot: Callable[..., Any]
) -> None:
    watcher, commander, gone = join(bridge), join(bridge, "driver"), join(bridge)
    watcher.send(op="subscribe", topic="/console/bridge")
    watcher.send(op="subscribe", topic="/odom")
    commander.publish(CONTROL, control(99.0))
    for _ in range(500):
        commander.publish(CONTROL, control())
    gone.send("garbage")
    gone.heard()
    bridge.disconnect(gone.session, 0)
    for tick in (5, 10, 250):
        bridge.publish(snapshot(tick), 0)
    (counts,) = [message["msg"] for message in watcher.heard() if message["topic"] == "/console/bridge"]
    assert counts["header"]["stamp"] == {"sec": 1, "nanosec": 0}
    assert (counts["commander"], counts["connections"]) == ("driver", 3)
    assert counts["state"] == "commander"
    assert (counts["received"], counts["refused"], counts["throttled"]) == (2 + 501 + 1, 2, 1)
    assert (counts["sent"], counts["dropped"]) == (1, 1)
    first, second = counts["clients"]
    assert (first["peer"], first["role"], first["received"], first["dropped"]) == ("peer", "control", 2, 1)
    assert dict(zip(first["topics"], first["topics_dropped"], strict=True)) == {"/console/bridge": 0, "/odom": 1}
    assert first["waiting_bytes"] > 0
    assert (second["received"], second["refused"], second["throttled"], second["topics"]) == (501, 1, 1, [])
    totals = {"connections": 3, "received": 504, "refused": 2, "throttled": 1, "sent": 3, "dropped": 2}
    assert bridge.counts() == total_counts(bridge.router) == totals
    commander.now_ns = 10**9
    bridge.publish(snapshot(500), 10**9)
    (counts,) = [message["msg"] for message in watcher.heard() if message["topic"] == "/console/bridge"]
    assert counts["commander"] == ""


def test_link_goes_from_nobody_over_clients_and_a_commander_to_lost(
    bridge: ConsoleBridge, join: Callable[..., Any], control: Callable[..., Any]
) -> None:
    def now(now_ns: int = 0) -> str:
        return link_state(bridge.router, now_ns)

    assert now() == "nobody"
    first = join(bridge)
    assert now() == "1 client"
    second = join(bridge)
    assert now() == "2 clients"
    first.publish(CONTROL, control())
    assert (now(), now(10**9)) == ("commander", "2 clients"), "its lease ends"
    bridge.disconnect(first.session, 10**9)
    bridge.disconnect(second.session, 10**9)
    assert now(10**9) == "lost"
    bridge.router.upstream = "connecting"
    assert now(10**9) == "connecting", "it was never there"
    bridge.router.upstream = "lost"
    assert now(10**9) == "retrying"
    bridge.router.upstream = "connected"
    assert now(10**9) == "lost"
