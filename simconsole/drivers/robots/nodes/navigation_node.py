"""Navigation as a program on the ROS side: goals and what SLAM says over rosbridge in, /cmd_vel out.

Topics, types and frames are those of nav2: it hears /map, /tf, /tf_static, /odom, /scan and /goal_pose, serves the
action /navigate_to_pose, and publishes /cmd_vel and /plan.
"""

import time
from collections.abc import Callable
from typing import Any, Final, NamedTuple, Protocol

import numpy as np

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.protocol.backoff import DEAD_AFTER_S
from simconsole.bridge.protocol.client_protocol import Received
from simconsole.drivers.robots.navigation.mission import Mission, Visit
from simconsole.drivers.robots.navigation.navigator import Navigator
from simconsole.drivers.robots.navigation.path_following import STOP, Speeds
from simconsole.drivers.robots.nodes.goals import ACTION, ACTION_TYPE, GOAL, Goals
from simconsole.drivers.robots.nodes.localisation import Localisation
from simconsole.drivers.robots.nodes.ros_client import RosClient
from simconsole.drivers.robots.nodes.ros_messages import (
    FrameTree,
    LaserScan,
    Odometry,
    TFMessage,
    end_ns_of,
    frames_of,
    grid_of_map,
    header,
    nanoseconds,
    plain_pose,
    pose_of,
    pose_of_transform,
    turn_of,
)
from simconsole.drivers.robots.nodes.slam_node import MAP, SCAN, TF, TF_STATIC, WAIT_S
from simconsole.drivers.robots.slam.odometry_track import Array, OdometryTrack
from simconsole.drivers.robots.slam.planar import composed, seen_from
from simconsole.drivers.robots.slam.rays import rays_of
from simconsole.values.errors import BridgeError
from simconsole.values.platform import Pose
from simconsole.values.units import NS_PER_S

ODOMETRY: Final = "/odom"
COMMAND: Final = "/cmd_vel"
PLAN: Final = "/plan"
MODE: Final = "/console/mode"
REQUEST: Final = "/console/request"
AUTONOMOUS: Final = "AUTONOMOUS"
"""The console's mode in which commands drive; what has no such topic, as a real robot, is always in it."""
CONTROL_NS: Final = NS_PER_S // 10
"""Between two decisions; in between the last one is repeated."""
OLD_NS: Final = 2 * NS_PER_S
"""Where a scan or a correction is older, the robot stands."""
LATE_S: Final = 10.0
"""Longest wait for SLAM in lockstep, by the clock on the wall."""
_ASK_EVERY: Final = 10


class Topics(NamedTuple):
    """Names of topics on the server."""

    scan: str
    map: str
    odometry: str
    command: str
    plan: str
    mode: str
    request: str
    goal: str
    action: str


class RobotTask(Protocol):
    """What gives a robot its goals, as `Mission` does."""

    def step(self, time_s: float, pose: Pose, points_m: Array) -> None:
        """Give the navigator its next goal where it needs one."""


class NavigationNode:
    """Drives one robot.

    Attributes:
        commands: how many it has published.
        answered_ns: the time of the odometry that it has answered last; 0 before the first.
    """

    def __init__(
        self,
        client: RosClient,
        navigator: Navigator,
        mission: RobotTask | None = None,
        *,
        namespace: str = "",
        lockstep: bool = False,
        yields: Callable[[float, Pose], bool] = lambda time_s, pose: False,
        heard: Callable[[float, bool], None] = lambda time_s, obeys: None,
    ) -> None:
        """Register with `client`, which is not connected yet.

        Args:
            client: of the rosbridge server.
            navigator: what decides.
            mission: gives it goals, in place of those from outside.
            namespace: of its topics and frames, `/tb3_0`; tf's topics and the frame of the map have none.
            lockstep: the console waits for each answer, and this program waits for SLAM.
            yields: whether the robot, at this time and place, stands for another one.
            heard: told of each odometry's time, and whether the robot drives by commands as far as is known.
        """
        self.commands = 0
        self.answered_ns = 0
        self._heard = heard
        self._yields = yields
        self._mission = mission
        self._client = client
        self._navigator = navigator
        self._frames = frames_of(namespace)
        names = (SCAN, MAP, ODOMETRY, COMMAND, PLAN, MODE, REQUEST, GOAL, ACTION)
        self._topics = Topics(*(namespace + name for name in names))
        self._tree = FrameTree()
        self._track = OdometryTrack()
        self._localisation = Localisation(lockstep)
        self._goals = Goals(navigator, is_open=mission is None)
        self._scan: LaserScan | None = None
        self._seen: tuple[int, Array] | None = None  # when a scan ended, and its echoes in odom
        self._decided_ns: int | None = None
        self._speeds = STOP
        self._plan: Array | None = None
        self._mode = ""
        self._count = 0
        self._register()

    def _register(self) -> None:
        client, topics = self._client, self._topics
        client.advertise(topics.command, "geometry_msgs/Twist")
        client.advertise(topics.plan, "nav_msgs/Path")
        client.advertise(topics.request, "std_msgs/String")
        client.advertise_action(topics.action, ACTION_TYPE, self._goals.pursue)
        client.subscribe(TF_STATIC, "tf2_msgs/TFMessage", reads=TFMessage, queue_length=100)
        client.subscribe(TF, "tf2_msgs/TFMessage", reads=TFMessage, queue_length=100)
        client.subscribe(topics.map, "nav_msgs/OccupancyGrid", queue_length=5)
        client.subscribe(topics.goal, "geometry_msgs/PoseStamped")
        client.subscribe(topics.mode, "std_msgs/String")
        client.subscribe(topics.scan, "sensor_msgs/LaserScan", reads=LaserScan, queue_length=5)
        # Last: a console in lockstep begins when somebody listens to this.
        client.subscribe(topics.odometry, "nav_msgs/Odometry", reads=Odometry)

    def is_asked(self, received: Received) -> bool:
        """Return whether this is odometry that the robot is to answer."""
        return received.topic == self._topics.odometry

    def take(self, topic: str, message: Any) -> None:
        """Take a message; each odometry is answered by one command."""
        topics, frames = self._topics, self._frames
        if topic == topics.odometry:
            self._answer(message)
        elif topic == topics.scan:
            self._scan = message
            self._localisation.scan(end_ns_of(message))
        elif topic == TF:
            for one in message.transforms:
                if one.child_frame_id == frames.odom and one.header.frame_id == frames.map:
                    self._localisation.correct(nanoseconds(one.header.stamp), pose_of_transform(one.transform))
        elif topic == topics.map:
            self._localisation.see_map(nanoseconds(message.header.stamp), grid_of_map(message))
        elif topic == TF_STATIC:
            self._tree.add(message.transforms)
        elif topic == topics.mode:
            self._mode = message.data
        elif topic == topics.goal:
            self._goals.aim(message)

    def _answer(self, odometry: Any) -> None:
        time_ns = nanoseconds(odometry.header.stamp)
        here = pose_of(odometry.pose.pose)
        self._track.add(time_ns / NS_PER_S, here)
        self._heard(time_ns / NS_PER_S, self._mode in ("", AUTONOMOUS))
        self._look()
        self._await_slam()
        grid = self._localisation.take()
        if grid is not None:
            self._navigator.see_map(grid)
        if self._decided_ns is None or time_ns >= self._decided_ns + CONTROL_NS:
            self._decided_ns = time_ns
            self._speeds = self._decide(time_ns, here)
        if self._count % _ASK_EVERY == 0 and self._mode != AUTONOMOUS:
            self._client.publish(self._topics.request, {"data": "autonomous"})
        self._count += 1
        self._tell(time_ns)
        linear = {"x": self._speeds.speed_mps, "y": 0.0, "z": 0.0}
        angular = {"x": 0.0, "y": 0.0, "z": self._speeds.yaw_rate_radps}
        self._client.publish(self._topics.command, {"linear": linear, "angular": angular})
        self.commands += 1
        self.answered_ns = time_ns

    def _look(self) -> None:
        """Turn a scan into echoes in odom once odometry up to its end is there."""
        scan = self._scan
        if scan is None or self._track.newest_s * NS_PER_S < end_ns_of(scan) - 1_000_000:
            return
        self._scan = None
        mount = self._tree.pose(scan.header.frame_id, self._frames.base)
        if mount is not None:
            rays = rays_of(turn_of(scan), mount, self._track)
            self._seen = (end_ns_of(scan), _moved(rays.odometry, rays.points_m))

    def _await_slam(self) -> None:
        deadline_s = time.monotonic() + LATE_S
        while self._localisation.waits and time.monotonic() < deadline_s:
            received = self._client.receive(WAIT_S)
            if received is not None and received.topic != self._topics.odometry:
                self.take(*received)

    def _decide(self, time_ns: int, odometry: Pose) -> Speeds:
        """Return the speeds for a tenth of a second: 0 where the robot does not know its place, or sees nothing."""
        said = self._localisation
        if said.correction is None or self._seen is None or time_ns > min(said.corrected_ns, self._seen[0]) + OLD_NS:
            return STOP
        pose = composed(said.correction, odometry)
        points_m = _moved(seen_from(odometry, Pose(0.0, 0.0, 0.0)), self._seen[1])
        time_s = time_ns / NS_PER_S
        if self._mission is not None:
            self._mission.step(time_s, pose, points_m)
        speeds = self._navigator.hold() if self._yields(time_s, pose) else self._navigator.steer(time_s, pose, points_m)
        self._goals.report(time_s, pose)
        return speeds

    def _tell(self, time_ns: int) -> None:
        """Publish the plan where it is a new one."""
        path = self._navigator.path_m
        if path is self._plan or path is None:
            return
        self._plan = path
        frame = self._frames.map
        poses = [{"header": header(time_ns, frame), "pose": plain_pose(Pose(x, y, 0.0))} for x, y in path.tolist()]
        self._client.publish(self._topics.plan, {"header": header(time_ns, frame), "poses": poses})


def _moved(frame: Pose, points_m: Array) -> Array:
    """Return points [N, 2] of a frame in the one that its pose is given in."""
    cosine, sine = np.cos(frame.yaw_rad), np.sin(frame.yaw_rad)
    return np.asarray(points_m @ np.array(((cosine, sine), (-sine, cosine))) + (frame.x_m, frame.y_m))


class Navigated(NamedTuple):
    """What navigation has made of a drive."""

    visits: list[Visit]  # of a mission's targets
    planned_m: float
    explored_s: float | None
    commands: int
    ended: str  # why


def run(
    url: str,
    navigator: Navigator,
    mission: Mission | None = None,
    *,
    namespace: str = "",
    lockstep: bool = False,
    stop: Callable[[], bool] = lambda: False,
    patience_s: float = 10.0,
    dead_after_s: float = DEAD_AFTER_S,
) -> Navigated:
    """Drive until the server ends the session, the mission is done, or `stop()` is true.

    Args:
        url: the rosbridge server, `ws://HOST:PORT`.
        navigator: what decides.
        mission: what the robot does on its own; without, it waits for goals.
        namespace: of the robot's topics and frames.
        lockstep: the console waits for each command, and this program waits for SLAM.
        stop: called after every message and four times a second.
        patience_s: how long to try to connect.
        dead_after_s: as `BridgeClient` takes it.

    Raises:
        BridgeError: no server answers at `url`.
    """
    navigator.warm_up()
    with BridgeClient(url, until_good_bye=True, dead_after_s=dead_after_s) as client:
        node = NavigationNode(client, navigator, mission, namespace=namespace, lockstep=lockstep)
        client.connect(patience_s)
        ended = "stopped"
        try:
            while not stop() and not (mission is not None and mission.is_done):
                received = client.receive(WAIT_S)
                if received is not None:
                    node.take(*received)
            if mission is not None and mission.is_done:
                ended = "mission done"
                # Leave what is asked next unanswered, as a team does (`fleet_program.drive`).
                asked = not lockstep
                while not stop() and not asked:
                    received = client.receive(WAIT_S)
                    asked = received is not None and node.is_asked(received)
        except BridgeError as error:
            ended = str(error)
    found = ([], 0.0, None) if mission is None else (mission.visits, mission.planned_m, mission.explored_s)
    return Navigated(*found, commands=node.commands, ended=ended)
