"""SLAM as a program on the ROS side: scans and odometry over rosbridge in, map, pose and `map` to `odom` out.

Topics, types and frames are those of slam_toolbox, so that one can stand in the place of the other: it hears /scan, /tf
and /tf_static, and publishes /map and /map_metadata (latched), /pose, and the transform from map to odom on /tf.
"""

from collections import deque
from collections.abc import Callable
from typing import Any, Final, NamedTuple

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.protocol.backoff import DEAD_AFTER_S
from simconsole.drivers.robots.nodes.ros_client import RosClient
from simconsole.drivers.robots.nodes.ros_messages import (
    Frames,
    FrameTree,
    LaserScan,
    TFMessage,
    end_ns_of,
    frames_of,
    header,
    nanoseconds,
    plain_map,
    plain_pose,
    plain_transform,
    pose_of_transform,
    turn_of,
)
from simconsole.drivers.robots.slam.mapper import Fix, Localiser, SharedMap
from simconsole.drivers.robots.slam.odometry_track import OdometryTrack
from simconsole.drivers.robots.slam.planar import ORIGIN
from simconsole.drivers.robots.slam.rays import rays_of
from simconsole.values.errors import BridgeError
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from simconsole.values.units import NS_PER_S
from simconsole.world.arena.occupancy import Grid

SCAN: Final = "/scan"
TF: Final = "/tf"
TF_STATIC: Final = "/tf_static"
MAP: Final = "/map"
METADATA: Final = "/map_metadata"
POSE: Final = "/pose"
MAP_NS: Final = 3 * NS_PER_S
"""Between two maps, by the scans' time."""
WAIT_S: Final = 0.25
_WAITING: Final = 5  # scans for which odometry has not come
_SLACK_NS: Final = 1_000_000  # by which odometry may end before a scan does


class StampedPose(NamedTuple):
    """Where SLAM had the robot at the end of a scan."""

    time_ns: int
    pose: Pose  # of base_footprint, in map
    share: float  # of the echoes that fitted


class SlamNode:
    """Localises one robot and maps what it sees.

    Attributes:
        moments: its trajectory.
    """

    def __init__(self, client: RosClient, shared: SharedMap, start: Pose, namespace: str = "") -> None:
        """Register with `client`, which is not connected yet.

        Args:
            client: of the rosbridge server.
            shared: the map, of this robot alone or of several.
            start: the robot's pose in map when its first scan ends.
            namespace: of its topics and frames, `/tb3_0`; tf's topics and the frame of the map have none.
        """
        self.moments: list[StampedPose] = []
        self._client = client
        self._shared = shared
        self._localiser = Localiser(shared, start)
        self._frames: Frames = frames_of(namespace)
        self._scan, self._map, self._metadata, self._pose = (namespace + name for name in (SCAN, MAP, METADATA, POSE))
        self._tree = FrameTree()
        self._track = OdometryTrack()
        self._waiting: deque[LaserScan] = deque(maxlen=_WAITING)
        self._mapped_ns: int | None = None
        client.advertise(TF, "tf2_msgs/TFMessage")
        client.advertise(self._map, "nav_msgs/OccupancyGrid", latch=True)
        client.advertise(self._metadata, "nav_msgs/MapMetaData", latch=True)
        client.advertise(self._pose, "geometry_msgs/PoseWithCovarianceStamped")
        client.subscribe(TF_STATIC, "tf2_msgs/TFMessage", reads=TFMessage, queue_length=100)
        client.subscribe(TF, "tf2_msgs/TFMessage", reads=TFMessage, queue_length=100)
        client.subscribe(self._scan, "sensor_msgs/LaserScan", reads=LaserScan, queue_length=_WAITING)

    def take(self, topic: str, message: Any) -> None:
        """Take a message; a scan is used as soon as odometry up to its end is there."""
        if topic == TF_STATIC:
            self._tree.add(message.transforms)
        elif topic == self._scan:
            self._waiting.append(message)
        elif topic == TF:
            frames = self._frames
            for one in message.transforms:
                if one.child_frame_id == frames.base and one.header.frame_id == frames.odom:
                    self._track.add(nanoseconds(one.header.stamp) / NS_PER_S, pose_of_transform(one.transform))
        while self._waiting and self._track.newest_s * NS_PER_S >= end_ns_of(self._waiting[0]) - _SLACK_NS:
            self._use(self._waiting.popleft())

    def _use(self, scan: LaserScan) -> None:
        mount = self._tree.pose(scan.header.frame_id, self._frames.base)
        if mount is None:
            return
        time_ns = end_ns_of(scan)
        fix = self._localiser.add(rays_of(turn_of(scan), mount, self._track))
        self.moments.append(StampedPose(time_ns, fix.pose, fix.share))
        grid = None
        if self._mapped_ns is None or time_ns >= self._mapped_ns + MAP_NS:
            grid = self._shared.grid
        if grid is not None:
            self._mapped_ns = time_ns
            self._publish_map(grid, time_ns)
        # The transform comes last: who has it has all that this scan changed.
        self._client.publish(self._pose, self._posed(fix, time_ns))
        moved = plain_transform(time_ns, self._frames.map, self._frames.odom, fix.correction)
        self._client.publish(TF, {"transforms": [moved]})

    def _publish_map(self, grid: Grid, time_ns: int) -> None:
        message = plain_map(grid, time_ns, self._frames.map)
        self._client.publish(self._map, message)
        self._client.publish(self._metadata, message["info"])

    def _posed(self, fix: Fix, time_ns: int) -> dict[str, Any]:
        covariance = [0.0] * 36
        for row, at in enumerate((0, 1, 5)):
            for column, along in enumerate((0, 1, 5)):
                covariance[6 * at + along] = float(fix.covariance[row, column])
        return {
            "header": header(time_ns, self._frames.map),
            "pose": {"pose": plain_pose(fix.pose), "covariance": covariance},
        }


class Mapped(NamedTuple):
    """What SLAM has made of a drive."""

    moments: list[StampedPose]
    grid: Grid | None  # None: there was no scan
    ended: str  # why


def run(
    url: str,
    start: Pose = ORIGIN,
    *,
    namespace: str = "",
    stop: Callable[[], bool] = lambda: False,
    ready: Callable[[], None] = lambda: None,
    patience_s: float = 10.0,
    dead_after_s: float = DEAD_AFTER_S,
) -> Mapped:
    """Map until the server ends the session or `stop()` is true; return the map and the trajectory.

    Args:
        url: the rosbridge server, `ws://HOST:PORT`.
        start: the robot's pose in map at the start.
        namespace: of the robot's topics and frames.
        stop: called after every message and four times a second.
        ready: called once it listens.
        patience_s: how long to try to connect.
        dead_after_s: as `BridgeClient` takes it.

    Raises:
        BridgeError: no server answers at `url`.
    """
    shared = SharedMap(compiled)
    with BridgeClient(url, until_good_bye=True, dead_after_s=dead_after_s) as client:
        node = SlamNode(client, shared, start, namespace)
        shared.warm_up()
        client.connect(patience_s)
        ready()
        ended = "stopped"
        try:
            while not stop():
                received = client.receive(WAIT_S)
                if received is not None:
                    node.take(*received)
        except BridgeError as error:
            ended = str(error)
    return Mapped(node.moments, shared.grid, ended)
