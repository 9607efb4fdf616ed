import math
from typing import Any

import numpy as np
import pytest

from simconsole.drivers.robots.nodes.ros_messages import header, plain_transform
from simconsole.drivers.robots.nodes.slam_node import SlamNode
from simconsole.drivers.robots.slam.mapper import SharedMap
from simconsole.drivers.robots.slam.planar import ORIGIN
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from tests.drivers.robots.arena_robot import MOUNT, START, STOPPED, ArenaRobot
from tests.drivers.robots.nodes.stub_client import StubClient
from tests.samples import Sample

TURN_NS = 200_000_000


def scan_of(robot: ArenaRobot, frame: str, number: int) -> dict[str, Any]:
    turn = None
    while turn is None:
        turn = robot.advance(STOPPED)
    steps = {"angle_increment": turn.angle_step_rad, "time_increment": turn.time_step_s}
    bounds = {"range_min": turn.min_m, "range_max": turn.max_m, "ranges": turn.ranges_m.tolist()}
    return {"header": header(number * TURN_NS, frame), **steps, **bounds}


class Heard:
    """A node of a robot that stands in the arena, and what it publishes."""

    def __init__(self, seed: int, namespace: str = "") -> None:
        self.client = StubClient()
        self.node = SlamNode(self.client, SharedMap(compiled), START, namespace)
        self.prefix = f"{namespace[1:]}/" if namespace else ""
        self.namespace = namespace
        self.robot = ArenaRobot(np.random.default_rng(seed), START)
        mount = plain_transform(0, f"{self.prefix}base_footprint", f"{self.prefix}base_scan", MOUNT)
        self.take("/tf_static", {"transforms": [mount]})

    def take(self, topic: str, plain: dict[str, Any]) -> None:
        self.node.take(topic, self.client.typed(topic, plain))

    def scan(self, number: int) -> None:
        self.take(f"{self.namespace}/scan", scan_of(self.robot, f"{self.prefix}base_scan", number))

    def odometry(self, time_ns: int, pose: Pose = ORIGIN, frame: str = "odom") -> None:
        moved = plain_transform(time_ns, f"{self.prefix}{frame}", f"{self.prefix}base_footprint", pose)
        self.take("/tf", {"transforms": [moved]})


@pytest.mark.parametrize("namespace", ["", "/tb3_0"])
def test_a_scan_makes_map_pose_and_transform(sample: Sample, namespace: str) -> None:
    heard = Heard(sample.seed, namespace)
    told = heard.client.told
    heard.odometry(0)
    heard.scan(0)
    assert not told["/tf"], "odometry up to the end of the scan is not there yet"
    heard.odometry(TURN_NS + 10_000_000)
    (transform,) = told["/tf"][0].transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", f"{heard.prefix}odom")
    assert transform.header.stamp.nanosec == TURN_NS
    assert (transform.transform.translation.x, transform.transform.translation.y) == pytest.approx((0.8, 0.8), abs=0.01)
    (field,) = told[f"{namespace}/map"]
    assert field.info.resolution == pytest.approx(0.05)
    assert {0, 100, -1} == set(field.data)
    assert told[f"{namespace}/map_metadata"][0].width == field.info.width
    (pose,) = told[f"{namespace}/pose"]
    assert pose.header.frame_id == "map"
    assert 0.0 < pose.pose.covariance[0] < 1e-3
    assert heard.client.latched == {f"{namespace}/map", f"{namespace}/map_metadata"}
    assert heard.node.moments[0].time_ns == TURN_NS


def test_maps_come_now_and_then_and_each_scan_corrects(sample: Sample) -> None:
    heard = Heard(sample.seed)
    for number in range(32):
        heard.scan(number)
        heard.odometry((number + 1) * TURN_NS, Pose(0.0, 0.0, 0.001 * number))
    assert len(heard.client.told["/map"]) == 3
    assert len(heard.client.told["/tf"]) == 32
    last = heard.client.told["/tf"][-1].transforms[0].transform.rotation
    assert 2.0 * math.atan2(last.z, last.w) == pytest.approx(-0.031, abs=0.004), "odometry turns, the robot does not"


def test_other_robots_transforms_and_scans_of_unknown_frames_are_passed_over(sample: Sample) -> None:
    heard = Heard(sample.seed)
    heard.odometry(2 * TURN_NS, frame="tb3_1/odom")
    heard.scan(0)
    assert not heard.client.told["/tf"]
    heard.odometry(2 * TURN_NS)
    assert len(heard.client.told["/tf"]) == 1
    heard.take("/scan", scan_of(heard.robot, "somewhere", 1))
    heard.odometry(4 * TURN_NS)
    assert len(heard.client.told["/tf"]) == 1
