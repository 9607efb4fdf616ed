import math

import numpy as np
import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.drivers.robots.nodes.ros_messages import (
    FrameTree,
    end_ns_of,
    frames_of,
    grid_of_map,
    nanoseconds,
    plain_map,
    plain_transform,
    pose_of_transform,
    turn_of,
)
from simconsole.values.platform import Pose
from simconsole.world.arena.occupancy import Grid

REGISTRY = standard_registry()


def test_a_map_survives_the_way_there_and_back() -> None:
    cells = np.array([[0, 100, -1], [100, 0, 0]], dtype=np.int8)
    plain = plain_map(Grid(cells, 0.05, -1.2, 0.3), 1_500_000_000, "map")
    message = REGISTRY.from_plain("nav_msgs/msg/OccupancyGrid", plain)
    assert (message.info.width, message.info.height, message.header.frame_id) == (3, 2, "map")
    assert nanoseconds(message.header.stamp) == 1_500_000_000
    found = grid_of_map(message)
    assert (found.cells == cells).all()
    assert (found.resolution_m, found.x_m, found.y_m) == pytest.approx((0.05, -1.2, 0.3))


def test_cells_between_free_and_occupied_are_unknown() -> None:
    plain = plain_map(Grid(np.zeros((1, 4), dtype=np.int8), 0.1, 0.0, 0.0), 0, "map")
    message = REGISTRY.from_plain("nav_msgs/msg/OccupancyGrid", {**plain, "data": [25, 26, 64, 65]})
    assert grid_of_map(message).cells.tolist() == [[0, -1, -1, 100]]


def test_a_scan_says_when_it_ended_and_null_says_nothing() -> None:
    header = {"stamp": {"sec": 3, "nanosec": 100_000_000}, "frame_id": "base_scan"}
    plain = {"header": header, "angle_increment": 0.1, "time_increment": 0.01, "range_min": 0.12, "range_max": 3.5}
    scan = REGISTRY.from_plain("sensor_msgs/msg/LaserScan", {**plain, "ranges": [1.0, None, 2.0]})
    turn = turn_of(scan)
    assert end_ns_of(scan) == pytest.approx(3_130_000_000)
    assert turn.end_s == pytest.approx(3.13)
    assert math.isnan(turn.ranges_m[1])


def test_frames_hang_on_each_other() -> None:
    tree = FrameTree()
    told = [("base_footprint", "base_link", Pose(0.0, 0.0, 0.0)), ("base_link", "base_scan", Pose(-0.03, 0.01, 0.5))]
    plain = {"transforms": [plain_transform(0, *one) for one in told]}
    tree.add(REGISTRY.from_plain("tf2_msgs/msg/TFMessage", plain).transforms)
    assert tree.pose("base_scan", "base_footprint") == pytest.approx((-0.03, 0.01, 0.5))
    assert tree.pose("base_footprint", "base_footprint") == (0.0, 0.0, 0.0)
    assert tree.pose("base_scan", "map") is None
    around = [("a", "b", Pose(0.0, 0.0, 0.0)), ("b", "a", Pose(0.0, 0.0, 0.0))]
    tree.add(
        REGISTRY.from_plain(
            "tf2_msgs/msg/TFMessage", {"transforms": [plain_transform(0, *one) for one in around]}
        ).transforms
    )
    assert tree.pose("a", "map") is None, "and does not go round for ever"


def test_a_pose_survives_as_a_transform_and_frames_have_prefixes() -> None:
    plain = {"transforms": [plain_transform(5, "map", "odom", Pose(1.0, -2.0, 2.5))]}
    (one,) = REGISTRY.from_plain("tf2_msgs/msg/TFMessage", plain).transforms
    assert pose_of_transform(one.transform) == pytest.approx((1.0, -2.0, 2.5))
    assert frames_of("/tb3_0") == ("map", "tb3_0/odom", "tb3_0/base_footprint")
    assert frames_of("") == ("map", "odom", "base_footprint")
