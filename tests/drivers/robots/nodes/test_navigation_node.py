from typing import Any

import numpy as np
import pytest

from simconsole.bridge.protocol.client_protocol import Received
from simconsole.drivers.robots.navigation.navigator import Navigator, Progress
from simconsole.drivers.robots.nodes.navigation_node import NavigationNode
from simconsole.drivers.robots.nodes.ros_messages import header, plain_map, plain_pose, plain_transform
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from tests.drivers.robots.arena_robot import MOUNT, START, ArenaRobot, burger
from tests.drivers.robots.navigation.rooms import two_rooms
from tests.drivers.robots.nodes.stub_client import StubClient
from tests.drivers.robots.nodes.test_slam_node import TURN_NS, scan_of

PERIOD_NS = 20_000_000


class Driven:
    """A node whose robot stands at the origin of odom, at (0.8, 0.8) in map."""

    def __init__(self, namespace: str = "", lockstep: bool = False) -> None:
        self.client = StubClient()
        self.navigator = Navigator(burger(), compiled)
        self.node = NavigationNode(self.client, self.navigator, namespace=namespace, lockstep=lockstep)
        self.namespace, self.prefix = namespace, f"{namespace[1:]}/" if namespace else ""
        self.robot = ArenaRobot(np.random.default_rng(1), START)
        mount = plain_transform(0, f"{self.prefix}base_footprint", f"{self.prefix}base_scan", MOUNT)
        self.take("/tf_static", {"transforms": [mount]})

    def take(self, topic: str, plain: dict[str, Any]) -> None:
        self.node.take(topic, self.client.typed(topic, plain))

    def localised(self, time_ns: int) -> None:
        self.take(f"{self.namespace}/map", plain_map(two_rooms(), time_ns, "map"))
        self.take("/tf", {"transforms": [self.correction(time_ns)]})

    def correction(self, time_ns: int) -> dict[str, Any]:
        return plain_transform(time_ns, "map", f"{self.prefix}odom", START)

    def scan(self, number: int) -> None:
        self.take(f"{self.namespace}/scan", scan_of(self.robot, f"{self.prefix}base_scan", number))

    def odometry(self, time_ns: int) -> Any:
        """Send odometry; return the command that answers it."""
        pose = {"pose": plain_pose(Pose(0.0, 0.0, 0.0)), "covariance": [0.0] * 36}
        self.take(f"{self.namespace}/odom", {"header": header(time_ns, f"{self.prefix}odom"), "pose": pose})
        return self.client.told[f"{self.namespace}/cmd_vel"][-1]

    def aim(self, x: float, y: float, frame: str = "map") -> None:
        goal = {"header": header(0, frame), "pose": plain_pose(Pose(x, y, 0.0))}
        self.take(f"{self.namespace}/goal_pose", goal)


@pytest.mark.parametrize("namespace", ["", "/tb3_0"])
def test_a_goal_by_topic_is_driven_to_and_its_plan_is_told(namespace: str) -> None:
    drive = Driven(namespace)
    drive.aim(1.4, 0.8)
    drive.scan(0)
    assert drive.odometry(TURN_NS).linear.x == 0.0, "it does not know where it is"
    drive.localised(TURN_NS)
    told = [drive.odometry(TURN_NS + number * PERIOD_NS) for number in range(1, 8)]
    assert told[-1].linear.x > 0.1
    (plan,) = drive.client.told[f"{namespace}/plan"]
    assert (plan.poses[-1].pose.position.x, plan.poses[-1].pose.position.y) == pytest.approx((1.4, 0.8))
    assert len(drive.client.told[f"{namespace}/cmd_vel"]) == 8, "one for each odometry"
    assert drive.client.told[f"{namespace}/console/request"][0].data == "autonomous"
    assert f"{namespace}/navigate_to_pose" in drive.client.actions


def test_without_slam_or_scans_it_stands() -> None:
    drive = Driven()
    drive.aim(1.4, 0.8)
    drive.scan(0)
    drive.localised(TURN_NS)
    assert [drive.odometry(TURN_NS + number * PERIOD_NS).linear.x > 0.0 for number in range(7)][-1]
    assert drive.odometry(3_000_000_000).linear.x == 0.0, "what SLAM said last is old"
    drive.localised(3_000_000_000)
    assert drive.odometry(3_200_000_000).linear.x == 0.0, "and the scan is, too"
    drive.scan(16)
    assert drive.odometry(3_400_000_000).linear.x > 0.0


def test_in_lockstep_it_waits_for_slam_and_takes_what_it_hears_meanwhile() -> None:
    drive = Driven(lockstep=True)
    drive.aim(1.4, 0.8)
    drive.scan(0)
    drive.odometry(TURN_NS)
    drive.scan(1)
    coming = drive.client.typed("/tf", {"transforms": [drive.correction(TURN_NS)]})
    grid = drive.client.typed("/map", plain_map(two_rooms(), TURN_NS, "map"))
    drive.client.coming = [Received("/map", grid), Received("/tf", coming)]
    assert drive.odometry(2 * TURN_NS).linear.x > 0.0
    assert drive.client.coming == []


def test_a_goal_in_another_frame_is_passed_over_and_who_drives_is_asked_for_once_in_a_while() -> None:
    drive = Driven()
    drive.aim(1.4, 0.8, "odom")
    assert drive.navigator.progress is Progress.NONE
    for number in range(20):
        drive.odometry(number * PERIOD_NS)
    assert len(drive.client.told["/console/request"]) == 2
    drive.take("/console/mode", {"data": "AUTONOMOUS"})
    for number in range(20, 40):
        drive.odometry(number * PERIOD_NS)
    assert len(drive.client.told["/console/request"]) == 2
