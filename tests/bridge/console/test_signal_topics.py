"""Traffic lights on the wire."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.signal_topics import SIGNALS, SIGNALS_TYPE, STOP_LINES, SignalTopics
from simconsole.bridge.console.surroundings import Surroundings
from simconsole.bridge.messages import standard_registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.link import LinkProfile, WayProfile
from simconsole.world.rules.road_signals import IN_REACH_M, RoadSignals
from tests.bridge.fixtures import Peer
from tests.world.nets import CITY, generated_map

HZ = 250


def heard(bridge: ConsoleBridge, snapshots: list[Any]) -> dict[str, list[dict[str, Any]]]:
    peer = Peer(bridge)
    peer.send(op="subscribe", topic=SIGNALS, type=SIGNALS_TYPE)
    peer.send(op="subscribe", topic=STOP_LINES, type="simconsole_msgs/StopLines")
    found: dict[str, list[dict[str, Any]]] = {SIGNALS: [], STOP_LINES: []}
    for one in snapshots:
        bridge.publish(one, 0)
        for message in peer.heard():
            found[message["topic"]].append(message["msg"])
    return found


def test_lights_near_the_vehicle_ten_times_a_second_and_stop_lines_once(snapshot: Callable[..., Any]) -> None:
    signals = RoadSignals(generated_map(*CITY), HZ)
    place = signals.stop_lines[0]
    bridge = ConsoleBridge(BridgeProfile(port=0), around=Surroundings(signals=signals))
    found = heard(bridge, [snapshot(tick, x_m=place.x_m, y_m=place.y_m) for tick in range(1, 2 * HZ + 1)])
    assert (len(found[SIGNALS]), len(found[STOP_LINES])) == (20, 1)
    for message in found[SIGNALS]:
        assert message["header"]["frame_id"] == "map"
        stamp = message["header"]["stamp"]
        tick = round((stamp["sec"] + stamp["nanosec"] * 1e-9) * HZ)
        told = [tuple(one.values()) for one in message["signals"]]
        assert told == [tuple(one) for one in signals.in_reach(place.x_m, place.y_m, tick)]
        assert place.signal in [one[0] for one in told]
    (lines,) = found[STOP_LINES]
    assert len(lines["stop_lines"]) == len(signals.stop_lines)
    for line, own in zip(lines["stop_lines"], signals.stop_lines, strict=True):
        assert (line["lane"], line["signal"], tuple(line["links"])) == own[:3]
        assert line["pose"]["position"] == pytest.approx({"x": own.x_m, "y": own.y_m, "z": 0.0})
        turn = line["pose"]["orientation"]
        assert 2.0 * math.atan2(turn["z"], turn["w"]) == pytest.approx(own.yaw_rad)


def test_far_lights_are_not_told(snapshot: Callable[..., Any]) -> None:
    signals = RoadSignals(generated_map(*CITY), HZ)
    bridge = ConsoleBridge(BridgeProfile(port=0), around=Surroundings(signals=signals))
    assert heard(bridge, [snapshot(25, x_m=-2.0 * IN_REACH_M)])[SIGNALS][0]["signals"] == []


def test_they_go_over_the_sessions_link_and_stop_lines_do_not(snapshot: Callable[..., Any]) -> None:
    signals = RoadSignals(generated_map(*CITY), HZ)
    place, late_ticks = signals.stop_lines[0], HZ // 5
    link = LinkProfile(seed=2, measurements=WayProfile(delay_ms=200.0, loss_share=0.5))
    bridge = ConsoleBridge(BridgeProfile(port=0, link=link), around=Surroundings(signals=signals))
    peer = Peer(bridge)
    peer.send(op="subscribe", topic=SIGNALS, type=SIGNALS_TYPE)
    peer.send(op="subscribe", topic=STOP_LINES, type="simconsole_msgs/StopLines")
    came: dict[str, list[int]] = {SIGNALS: [], STOP_LINES: []}
    for tick in range(1, 4 * HZ + 1):
        bridge.publish(snapshot(tick, x_m=place.x_m, y_m=place.y_m), 0)
        for message in peer.heard():
            stamp, seen = message["msg"]["header"]["stamp"], message["msg"].get("signals")
            made = round((stamp["sec"] + stamp["nanosec"] * 1e-9) * HZ)
            came[message["topic"]].append(tick - made)
            assert seen is None or [tuple(one.values()) for one in seen] == [
                tuple(one) for one in signals.in_reach(place.x_m, place.y_m, made)
            ], "as they were then"
    assert set(came[SIGNALS]) == {late_ticks}
    assert 8 < len(came[SIGNALS]) < 30, "of 38"
    assert came[STOP_LINES] == [0]


def test_world_without_lights_tells_so(snapshot: Callable[..., Any]) -> None:
    found = heard(ConsoleBridge(BridgeProfile(port=0)), [snapshot(25)])
    assert found[SIGNALS][0]["signals"] == found[STOP_LINES][0]["stop_lines"] == []
    assert [topic.name for topic in SignalTopics(standard_registry(), None).topics()] == [STOP_LINES, SIGNALS]
