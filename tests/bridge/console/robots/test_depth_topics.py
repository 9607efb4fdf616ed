"""The topics of a Waffle's depth camera: off by default, then as REP 118 and sensor_msgs have them."""

import base64
import math
from typing import Any

import numpy as np
import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.robots.depth_topics import DEPTH_IMAGE, DEPTH_INFO, OPTICAL_FRAME, POINTS
from simconsole.bridge.console.robots.robot_topics import robot_table
from simconsole.bridge.console.surroundings import Surroundings
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.values.host.jit import plain
from simconsole.world.arena.arena_world import arena_of
from simconsole.world.kinds.worlds import open_world
from tests.bridge.console.robots.test_robot_topics import heard, snapshot
from tests.bridge.fixtures import Peer

WAFFLE = load("vehicles", "turtlebot3_waffle", TurtlebotProfile)
TOPICS = (DEPTH_INFO, DEPTH_IMAGE, POINTS)


def bridge(rates_hz: dict[str, float]) -> ConsoleBridge:
    table = robot_table(WAFFLE, arena_of(open_world(load_world("arena"))), plain)
    return ConsoleBridge(BridgeProfile(port=0, rates_hz=rates_hz), around=Surroundings(robot=table))


def told(*topics: str) -> dict[str, Any]:
    return heard(bridge(dict.fromkeys(TOPICS, 5.0)), snapshot(200), *topics)


def test_without_a_rate_there_are_no_pictures() -> None:
    assert heard(bridge({}), snapshot(200), *TOPICS, "/odom").keys() == {"/odom"}


def test_image_info_and_points_tell_one_picture() -> None:
    found = told(*TOPICS)
    image, info, cloud = found[DEPTH_IMAGE], found[DEPTH_INFO], found[POINTS]
    assert image["header"] == info["header"] == cloud["header"]
    assert image["header"]["frame_id"] == OPTICAL_FRAME
    assert (image["encoding"], image["width"], image["height"], image["step"]) == ("32FC1", 160, 120, 640)
    assert (info["width"], info["height"]) == (160, 120)
    depth = np.frombuffer(base64.b64decode(image["data"]), "<f4").reshape(120, 160)
    assert [(one["name"], one["offset"], one["datatype"]) for one in cloud["fields"]] == [
        ("x", 0, 7),
        ("y", 4, 7),
        ("z", 8, 7),
    ]
    points = np.frombuffer(base64.b64decode(cloud["data"]), "<f4").reshape(120, 160, 3)
    assert (cloud["point_step"], cloud["row_step"], cloud["is_dense"]) == (12, 12 * 160, False)
    seen = np.isfinite(depth)
    assert seen.any()
    assert (points[seen, 2] == depth[seen]).all()
    assert np.isnan(points[~seen]).all()
    row, column = np.argwhere(seen)[-1]
    x, y, z = points[row, column].tolist()
    k = info["k"]
    assert (k[0] * x / z + k[2], k[4] * y / z + k[5]) == pytest.approx((column, row), abs=1e-3)


def test_its_frame_is_told_once_and_looks_ahead() -> None:
    peer = Peer(bridge({}))
    peer.send(op="subscribe", topic="/tf_static")
    peer.bridge.publish(snapshot(0), 0)
    (static,) = (one["msg"] for one in peer.heard() if one["op"] == "publish")
    frames = {one["child_frame_id"]: one for one in static["transforms"]}
    turn = frames[OPTICAL_FRAME]["transform"]["rotation"]
    assert math.hypot(*turn.values()) == pytest.approx(1.0)
    assert (turn["x"], turn["y"], turn["z"], turn["w"]) == pytest.approx((-0.5, 0.5, -0.5, 0.5))
    assert frames[OPTICAL_FRAME]["header"]["frame_id"] == "base_link"
