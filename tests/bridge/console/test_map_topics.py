"""The map and the place on the earth on the wire."""

import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from simconsole.bridge.console import map_topics
from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.map_topics import GNSS, MARKERS, MOST_POINTS, MapTopics
from simconsole.bridge.console.surroundings import Surroundings
from simconsole.bridge.messages import standard_registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.link import LinkProfile, LocalisationProfile
from simconsole.world.earth import earth_of
from simconsole.world.kinds.worlds import open_world, shown_map
from simconsole.world.world import ShownMap
from tests.bridge.fixtures import Peer

HZ = 250
MOST_BYTES = 1_000_000
"""A listener that has asked for nothing else holds as much."""
ROAD_M = 40.0
"""No road of ours, junctions included, is wider between its edges than twice this."""
LINE_LIST, TRIANGLE_LIST = 5, 11


def heard(bridge: ConsoleBridge, snapshots: list[Any]) -> dict[str, list[dict[str, Any]]]:
    peer = Peer(bridge)
    peer.send(op="subscribe", topic=MARKERS, type="visualization_msgs/MarkerArray")
    peer.send(op="subscribe", topic=GNSS, type="sensor_msgs/NavSatFix")
    found: dict[str, list[dict[str, Any]]] = {MARKERS: [], GNSS: []}
    for one in snapshots:
        bridge.publish(one, 0)
        for message in peer.heard():
            found[message["topic"]].append(message["msg"])
    return found


def from_segments(spot: np.ndarray, starts: np.ndarray, ends: np.ndarray) -> float:
    """How far a point is from the nearest of some segments."""
    steps = ends - starts
    share = ((spot - starts) * steps).sum(axis=1) / np.maximum((steps**2).sum(axis=1), 1e-12)
    return float(np.hypot(*(starts + np.clip(share, 0.0, 1.0)[:, None] * steps - spot).T).min())


def test_place_on_the_earth_ten_times_a_second_is_that_of_the_pose(snapshot: Callable[..., Any]) -> None:
    earth = earth_of()
    assert earth is not None
    bridge = ConsoleBridge(BridgeProfile(port=0), around=Surroundings(shown_map=ShownMap(earth=earth)))
    found = heard(bridge, [snapshot(tick, x_m=120.0, y_m=-40.0) for tick in range(1, 2 * HZ + 1)])
    assert (len(found[GNSS]), len(found[MARKERS])) == (20, 1)
    assert found[MARKERS] == [{"markers": []}]
    for message in found[GNSS]:
        assert (message["latitude"], message["longitude"]) == earth.place(120.0, -40.0)
        assert message["header"]["frame_id"] == "base_link"
        assert message["status"] == {"status": 0, "service": 1}
        assert message["position_covariance"] == [0.0] * 9


def test_errors_are_those_of_the_odometry(snapshot: Callable[..., Any]) -> None:
    earth = earth_of()
    assert earth is not None
    noisy = LinkProfile(localisation=LocalisationProfile(position_noise_m=0.5))
    bridge = ConsoleBridge(BridgeProfile(port=0, link=noisy), around=Surroundings(shown_map=ShownMap(earth=earth)))
    peer = Peer(bridge)
    peer.send(op="subscribe", topic=GNSS, type="sensor_msgs/NavSatFix")
    peer.send(op="subscribe", topic="/odom", type="nav_msgs/Odometry")
    places: dict[tuple[int, int], dict[str, Any]] = {}
    pairs = 0
    for tick in range(1, 2 * HZ + 1):
        bridge.publish(snapshot(tick, x_m=10.0, y_m=20.0), 0)
        for message in peer.heard():
            stamp = tuple(message["msg"]["header"]["stamp"].values())
            other = places.setdefault(stamp, {}) | {message["topic"]: message["msg"]}
            places[stamp] = other
            if len(other) == 2:
                point = other["/odom"]["pose"]["pose"]["position"]
                assert (other[GNSS]["latitude"], other[GNSS]["longitude"]) == earth.place(point["x"], point["y"])
                assert math.hypot(point["x"] - 10.0, point["y"] - 20.0) > 0.0
                assert other[GNSS]["position_covariance"] == [0.25, 0.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0, 0.0]
                pairs += 1
    assert pairs >= 10


@pytest.mark.parametrize("world", ["urban", "urban_signals", "motorway", "country", "skid_pad"])
def test_map_of_each_shipped_world_is_bounded_and_covers_its_route(snapshot: Callable[..., Any], world: str) -> None:
    profile = load_world(world)
    bridge = ConsoleBridge(BridgeProfile(port=0), around=Surroundings(shown_map=shown_map(profile)))
    peer = Peer(bridge)
    peer.send(op="subscribe", topic=MARKERS, type="visualization_msgs/MarkerArray")
    bridge.publish(snapshot(1), 0)
    text = peer.session.next_text(0)
    assert text is not None
    print(f"measured: {len(text)} bytes of {world}")
    assert len(text) < MOST_BYTES
    markers = {marker["ns"]: marker for marker in json.loads(text)["msg"]["markers"]}
    assert {"edges", "surfaces"} <= markers.keys()
    assert sum(len(marker["points"]) for marker in markers.values()) <= MOST_POINTS
    for marker in markers.values():
        size = {LINE_LIST: 2, TRIANGLE_LIST: 3}[marker["type"]]
        assert len(marker["points"]) % size == 0
        assert marker["header"]["frame_id"] == "map"
    points = np.array([(point["x"], point["y"]) for point in markers["edges"]["points"]])
    for spot in open_world(profile).drawing.path[::20]:
        assert from_segments(spot, points[::2], points[1::2]) < ROAD_M


def test_world_of_an_unknown_projection_has_no_place_on_the_earth() -> None:
    topics = MapTopics(standard_registry(), ShownMap(), LocalisationProfile()).topics()
    assert [topic.name for topic in topics] == [MARKERS]


def test_platforms_of_one_world_share_the_work_of_its_markers(snapshot: Callable[..., Any]) -> None:
    shown = shown_map(load_world("urban"))
    drawing = shown.drawing()
    around = Surroundings(shown_map=shown._replace(drawing=lambda: drawing))
    before = map_topics._points_of.cache_info().misses
    one, other = (heard(ConsoleBridge(BridgeProfile(port=0), around=around), [snapshot(1)]) for _ in range(2))
    assert map_topics._points_of.cache_info().misses == before + 1
    assert one[MARKERS] == other[MARKERS]
    assert len(one[MARKERS][0]["markers"]) > 0
