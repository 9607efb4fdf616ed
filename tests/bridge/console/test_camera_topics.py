import base64
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from simconsole.bridge.console.camera_topics import CameraShot, optical
from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.surroundings import Surroundings
from simconsole.profiles.bridge import BridgeProfile, CameraProfile
from simconsole.values.state_vector import Snapshot
from tests.bridge.fixtures import Peer

CAMERA = CameraProfile(width_px=800, height_px=600, horizontal_fov_deg=90.0, x_m=1.5, z_m=1.2, pitch_deg=5.0)
TOPICS = ("/camera/image_raw/compressed", "/camera/camera_info", "/tf_static")


def heard(shots: list[CameraShot | None], snapshots: list[Snapshot]) -> dict[str, list[dict[str, Any]]]:
    """Return what a client hears when before each tick the newest picture is the next of these."""
    newest = iter(shots)
    shot: list[CameraShot | None] = [None]
    profile = BridgeProfile(port=0, camera=CAMERA)
    peer = Peer(ConsoleBridge(profile, around=Surroundings(camera=lambda: shot[0])))
    found: dict[str, list[dict[str, Any]]] = {}
    for topic in TOPICS:
        peer.send(op="subscribe", topic=topic)
        found[topic] = []
    for snapshot in snapshots:
        shot[0] = next(newest)
        peer.bridge.publish(snapshot, 0)
        for message in peer.heard():
            found[message["topic"]].append(message["msg"])
    return found


def test_each_picture_is_told_once_with_what_projects_into_it(snapshot: Callable[..., Snapshot]) -> None:
    one, two = CameraShot(25, b"\xff\xd8one"), CameraShot(50, b"\xff\xd8two")
    told = heard([None, one, one, two], [snapshot(tick) for tick in (20, 27, 28, 52)])
    images, infos = told[TOPICS[0]], told[TOPICS[1]]
    assert [base64.b64decode(image["data"]) for image in images] == [one.jpeg, two.jpeg]
    assert {image["format"] for image in images} == {"jpeg"}
    assert [info["header"] for info in infos] == [image["header"] for image in images]
    assert images[0]["header"]["frame_id"] == "camera_optical"
    tick_hz = snapshot(20).tick_hz
    stamp = images[0]["header"]["stamp"]
    assert stamp["sec"] + 1e-9 * stamp["nanosec"] == pytest.approx(25 / tick_hz)


def test_camera_info_is_that_of_the_pinhole(snapshot: Callable[..., Snapshot]) -> None:
    (info,) = heard([CameraShot(1, b"x")], [snapshot(2)])[TOPICS[1]]
    assert (info["width"], info["height"], info["distortion_model"]) == (800, 600, "plumb_bob")
    assert info["k"] == pytest.approx([400.0, 0.0, 399.5, 0.0, 400.0, 299.5, 0.0, 0.0, 1.0])
    assert info["p"] == pytest.approx([400.0, 0.0, 399.5, 0.0, 0.0, 400.0, 299.5, 0.0, 0.0, 0.0, 1.0, 0.0])
    assert info["d"] == [0.0] * 5


def test_where_the_camera_is_stands_in_tf_static(snapshot: Callable[..., Snapshot]) -> None:
    (message,) = heard([None], [snapshot(2)])["/tf_static"]
    (transform,) = (part for part in message["transforms"] if part["child_frame_id"] == "camera_optical")
    assert transform["header"]["frame_id"] == "base_link"
    assert transform["transform"]["translation"] == {"x": 1.5, "y": 0.0, "z": 1.2}


@pytest.mark.parametrize(("yaw", "pitch"), [(0.0, 0.0), (0.4, 0.0), (0.0, 0.3), (-1.2, 0.2)])
def test_the_optical_frame_looks_along_the_camera(yaw: float, pitch: float) -> None:
    x, y, z, w = optical(yaw, pitch)
    assert x * x + y * y + z * z + w * w == pytest.approx(1.0)
    axes = np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )
    )
    forwards = (math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), -math.sin(pitch))
    assert axes[:, 2] == pytest.approx(forwards, abs=1e-12)
    assert axes[:, 0] == pytest.approx((math.sin(yaw), -math.cos(yaw), 0.0), abs=1e-12)


def test_without_a_camera_there_is_nothing_of_it() -> None:
    names = ConsoleBridge(BridgeProfile(port=0), around=Surroundings(camera=lambda: CameraShot(1, b"x"))).names
    assert set(TOPICS).isdisjoint(set(names) - {"/tf_static"})
    assert "/camera/camera_info" not in ConsoleBridge(BridgeProfile(port=0, camera=CAMERA)).names
