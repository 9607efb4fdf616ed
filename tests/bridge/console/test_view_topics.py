import base64
import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.surroundings import Surroundings
from simconsole.bridge.console.view_topics import ExternalView, Model, view_topics
from simconsole.bridge.messages import standard_registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import ProfileError
from simconsole.values.state_vector import Snapshot
from tests.bridge.fixtures import Peer
from tests.paths import ROOT

GRANTED = BridgeProfile(port=0, external_view=True)
VIEW = ExternalView(
    models=(Model("map", "world.glb", b"\0world"), Model("base_link", "vehicle.glb", b"car")),
    frames=lambda snapshot: (
        ("map", "base_link", (snapshot.vehicle.x_m, 2.0, 3.0), (0.0, 0.0, snapshot.vehicle.yaw_rad)),
        ("base_link", "hand_wheel", (1.0, 0.5, 0.75), (0.5, 0.0, 0.0)),
    ),
    reading=lambda snapshot: {"speed": snapshot.vehicle.vx_mps, "gear": "3", "mode_words": "MANUAL"},
)


def heard(snapshots: list[Snapshot], profile: BridgeProfile = GRANTED) -> dict[str, list[dict[str, Any]]]:
    peer = Peer(ConsoleBridge(profile, around=Surroundings(view=VIEW)))
    found: dict[str, list[dict[str, Any]]] = {}
    for topic in ("/view/scene", "/view/poses", "/view/hud"):
        peer.send(op="subscribe", topic=topic)
        found[topic] = []
    for snapshot in snapshots:
        peer.bridge.publish(snapshot, 0)
        for message in peer.heard():
            found[message["topic"]].append(message["msg"])
    return found


def test_nothing_of_it_leaves_without_the_grant() -> None:
    assert view_topics(standard_registry(), BridgeProfile(), VIEW) == ()
    with pytest.raises(ProfileError, match="/view/poses is no topic of the console"):
        ConsoleBridge(BridgeProfile(port=0, rates_hz={"/view/poses": 10.0}))


def test_models_come_once_each_in_its_frame(snapshot: Callable[..., Snapshot]) -> None:
    (scene,) = heard([snapshot(tick) for tick in range(1, 30)])["/view/scene"]
    world, car = scene["markers"]
    assert (world["header"]["frame_id"], car["header"]["frame_id"]) == ("map", "base_link")
    assert [world["type"], world["id"], car["id"]] == [10, 0, 1]
    assert base64.b64decode(world["mesh_file"]["data"]) == b"\0world"
    assert world["mesh_resource"] == f"embedded://{world['mesh_file']['filename']}"
    assert [world["frame_locked"], car["frame_locked"]] == [False, True]
    assert world["scale"] == {"x": 1.0, "y": 1.0, "z": 1.0}
    assert world["pose"]["orientation"]["w"] == 1.0


def test_who_comes_late_gets_the_scene(snapshot: Callable[..., Snapshot]) -> None:
    bridge = ConsoleBridge(GRANTED, around=Surroundings(view=VIEW))
    bridge.publish(snapshot(1), 0)
    peer = Peer(bridge)
    peer.send(op="subscribe", topic="/view/scene")
    assert len(peer.heard()) == 1


def test_all_poses_of_a_moment_have_its_stamp(snapshot: Callable[..., Snapshot]) -> None:
    poses = heard([snapshot(tick, x_m=0.1 * tick, yaw_rad=math.pi / 2) for tick in range(1, 251)])["/view/poses"]
    assert len(poses) == 50
    base, wheel = poses[-1]["transforms"]
    assert base["header"] == {"stamp": {"sec": 1, "nanosec": 0}, "frame_id": "map"}
    assert base["header"]["stamp"] == wheel["header"]["stamp"]
    assert base["transform"]["translation"] == pytest.approx({"x": 25.0, "y": 2.0, "z": 3.0})
    half = math.sqrt(0.5)
    assert base["transform"]["rotation"] == pytest.approx({"x": 0.0, "y": 0.0, "z": half, "w": half})
    assert (wheel["header"]["frame_id"], wheel["child_frame_id"]) == ("base_link", "hand_wheel")
    assert wheel["transform"]["rotation"]["x"] == pytest.approx(math.sin(0.25))


def test_readings_come_as_often_as_the_profile_says(snapshot: Callable[..., Snapshot]) -> None:
    ticks = [snapshot(tick, vx_mps=7.0) for tick in range(1, 251)]
    readings = heard(ticks)["/view/hud"]
    assert (len(readings), readings[-1]["speed"], readings[-1]["gear"]) == (20, 7.0, "3")
    assert readings[-1]["header"]["stamp"] == {"sec": 1, "nanosec": 0}
    rated = BridgeProfile(port=0, external_view=True, rates_hz={"/view/hud": 5.0, "/view/poses": 125.0})
    found = heard(ticks, rated)
    assert (len(found["/view/hud"]), len(found["/view/poses"])) == (5, 125)


def test_the_page_has_the_table() -> None:
    page = (ROOT / "docs" / "engine.md").read_text()
    for row in view_topics(standard_registry(), GRANTED):
        rate = "once, latched" if row.rate_hz < 0 else f"{row.rate_hz:g}"
        assert f"| {row.name} | {row.type} | {rate} |" in page
