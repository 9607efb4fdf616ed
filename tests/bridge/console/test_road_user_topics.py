"""What the bridge tells of the other road users."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.surroundings import Surroundings
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.link import LinkProfile, LocalisationProfile
from simconsole.world.traffic.road_users import NOBODY, RoadUser, RoadUserKind, RoadUsersAt, table
from tests.bridge.fixtures import Peer

TYPES = {"/road_users": "simconsole_msgs/RoadUsers", "/road_users/detections": "vision_msgs/Detection3DArray"}
VAN = RoadUser(
    id=42.0,
    kind=float(RoadUserKind.VAN),
    x_m=30.0,
    y_m=4.0,
    yaw_rad=math.pi / 2.0,
    speed_mps=7.5,
    length_m=5.5,
    width_m=2.0,
    height_m=2.2,
)


def told(snapshot: Callable[..., Any], profile: BridgeProfile, at: RoadUsersAt, **fields: float) -> dict[str, Any]:
    peer = Peer(ConsoleBridge(profile, around=Surroundings(road_users=lambda: at)))
    for topic, kind in TYPES.items():
        assert peer.send(op="subscribe", topic=topic, type=kind).kind == "done"
    peer.bridge.publish(snapshot(375, **fields), 0)
    return {message["topic"]: message["msg"] for message in peer.heard()}


def test_box_speed_and_kind_of_each_at_the_time_of_the_step(snapshot: Callable[..., Any]) -> None:
    messages = told(snapshot, BridgeProfile(), RoadUsersAt(370, table([VAN])))
    users = messages["/road_users"]
    assert users["header"]["frame_id"] == "map"
    assert users["header"]["stamp"] == {"sec": 1, "nanosec": 480_000_000}
    (user,) = users["users"]
    assert (user["id"], user["kind"]) == (42, 2)
    assert user["pose"]["position"] == {"x": 30.0, "y": 4.0, "z": 0.0}
    assert user["pose"]["orientation"] == pytest.approx({"x": 0.0, "y": 0.0, "z": math.sqrt(0.5), "w": math.sqrt(0.5)})
    assert user["twist"]["linear"] == {"x": 7.5, "y": 0.0, "z": 0.0}
    assert user["size"] == {"x": 5.5, "y": 2.0, "z": 2.2}
    (detection,) = messages["/road_users/detections"]["detections"]
    assert detection["id"] == "42"
    assert detection["results"][0]["hypothesis"] == {"class_id": "van", "score": 1.0}
    assert detection["bbox"]["center"]["position"] == {"x": 30.0, "y": 4.0, "z": 1.1}
    assert detection["bbox"]["size"] == {"x": 5.5, "y": 2.0, "z": 2.2}


def test_height_and_indicators_are_told(snapshot: Callable[..., Any]) -> None:
    messages = told(snapshot, BridgeProfile(), RoadUsersAt(370, table([VAN._replace(z_m=12.0, turn_indicators=-1.0)])))
    (user,), (detection,) = messages["/road_users"]["users"], messages["/road_users/detections"]["detections"]
    assert (user["pose"]["position"]["z"], user["turn_indicators"]) == (12.0, -1)
    assert detection["bbox"]["center"]["position"]["z"] == pytest.approx(13.1)


def test_nobody_is_an_empty_message(snapshot: Callable[..., Any]) -> None:
    messages = told(snapshot, BridgeProfile(), RoadUsersAt(0, NOBODY))
    assert messages["/road_users"]["users"] == messages["/road_users/detections"]["detections"] == []


def test_places_relative_to_the_vehicle_are_exact_whatever_its_localisation(snapshot: Callable[..., Any]) -> None:
    errors = LocalisationProfile(position_noise_m=0.5, yaw_noise_deg=2.0)
    profile = BridgeProfile(link=LinkProfile(localisation=errors, seed=3))
    peer = Peer(ConsoleBridge(profile, around=Surroundings(road_users=lambda: RoadUsersAt(375, table([VAN])))))
    for topic, kind in {**TYPES, "/odom": "nav_msgs/Odometry"}.items():
        peer.send(op="subscribe", topic=topic, type=kind)
    peer.bridge.publish(snapshot(375, x_m=10.0, y_m=2.0, yaw_rad=0.4), 0)
    messages = {message["topic"]: message["msg"] for message in peer.heard()}
    (user,), own = messages["/road_users"]["users"], messages["/odom"]["pose"]["pose"]
    place, here = user["pose"]["position"], own["position"]
    assert math.hypot(place["x"] - 30.0, place["y"] - 4.0) > 0.1
    apart = math.hypot(place["x"] - here["x"], place["y"] - here["y"])
    assert apart == pytest.approx(math.hypot(20.0, 2.0))
    yaw = 2.0 * math.atan2(own["orientation"]["z"], own["orientation"]["w"])
    bearing = math.atan2(place["y"] - here["y"], place["x"] - here["x"]) - yaw
    assert bearing == pytest.approx(math.atan2(2.0, 20.0) - 0.4)


def test_without_traffic_there_are_no_such_topics(bridge: ConsoleBridge) -> None:
    assert not set(TYPES) & set(bridge.names)


def test_names_and_rates_are_the_profiles(snapshot: Callable[..., Any]) -> None:
    profile = BridgeProfile(rename={"/road_users": "/objects"}, rates_hz={"/road_users": 5.0})
    bridge = ConsoleBridge(profile, around=Surroundings(road_users=lambda: RoadUsersAt(0, NOBODY)))
    assert bridge.names["/road_users"] == "/objects"
