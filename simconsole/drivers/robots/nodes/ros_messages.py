"""What the robots' programs read and write of ROS messages: the fields they use, and poses on a plane."""

import math
from collections.abc import Iterable
from typing import Any, Final, NamedTuple

import msgspec
import numpy as np

from simconsole.drivers.robots.slam.planar import ORIGIN, composed
from simconsole.drivers.robots.slam.rays import Turn
from simconsole.values.platform import Pose
from simconsole.values.units import NS_PER_S
from simconsole.world.arena.occupancy import Grid

MAP_FRAME: Final = "map"


class Stamp(msgspec.Struct):
    """builtin_interfaces/Time."""

    sec: int
    nanosec: int


class Header(msgspec.Struct):
    """std_msgs/Header."""

    stamp: Stamp
    frame_id: str


class Vector(msgspec.Struct):
    """geometry_msgs/Vector3 and Point."""

    x: float
    y: float
    z: float


class Quaternion(msgspec.Struct):
    """geometry_msgs/Quaternion."""

    x: float
    y: float
    z: float
    w: float


class Transform(msgspec.Struct):
    """geometry_msgs/Transform."""

    translation: Vector
    rotation: Quaternion


class TransformStamped(msgspec.Struct):
    """geometry_msgs/TransformStamped."""

    header: Header
    child_frame_id: str
    transform: Transform


class TFMessage(msgspec.Struct):
    """tf2_msgs/TFMessage."""

    transforms: list[TransformStamped]


class LaserScan(msgspec.Struct):
    """sensor_msgs/LaserScan without intensities; a range that is no number comes as null."""

    header: Header
    angle_min: float
    angle_increment: float
    time_increment: float
    range_min: float
    range_max: float
    ranges: list[float | None]


class PoseMessage(msgspec.Struct):
    """geometry_msgs/Pose."""

    position: Vector
    orientation: Quaternion


class _PoseWithCovariance(msgspec.Struct):
    pose: PoseMessage


class Odometry(msgspec.Struct):
    """nav_msgs/Odometry without speeds and covariances."""

    header: Header
    pose: _PoseWithCovariance


class Frames(NamedTuple):
    """Names of frames: those of slam_toolbox and nav2 without a namespace."""

    map: str = MAP_FRAME
    odom: str = "odom"
    base: str = "base_footprint"


def frames_of(namespace: str) -> Frames:
    """Return the frames of a robot under a namespace; robots share the frame of the map."""
    prefix = f"{namespace.removeprefix('/')}/" if namespace else ""
    return Frames(MAP_FRAME, f"{prefix}odom", f"{prefix}base_footprint")


def nanoseconds(stamp: Any) -> int:
    """Return a stamp in ns."""
    return int(stamp.sec) * NS_PER_S + int(stamp.nanosec)


def header(time_ns: int, frame: str) -> dict[str, Any]:
    """Return a header as rosbridge carries it."""
    sec, nanosec = divmod(time_ns, NS_PER_S)
    return {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": frame}


def yaw_of(q: Any) -> float:
    """Return the heading of a quaternion."""
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))


def pose_of(pose: Any) -> Pose:
    """Return a geometry_msgs/Pose on the plane."""
    return Pose(pose.position.x, pose.position.y, yaw_of(pose.orientation))


def pose_of_transform(transform: Any) -> Pose:
    """Return a geometry_msgs/Transform on the plane."""
    return Pose(transform.translation.x, transform.translation.y, yaw_of(transform.rotation))


def plain_pose(pose: Pose) -> dict[str, Any]:
    """Return a geometry_msgs/Pose as rosbridge carries it."""
    return {"position": {"x": pose.x_m, "y": pose.y_m, "z": 0.0}, "orientation": _plain_turn(pose.yaw_rad)}


def plain_transform(time_ns: int, parent: str, child: str, pose: Pose) -> dict[str, Any]:
    """Return a geometry_msgs/TransformStamped as rosbridge carries it."""
    translation = {"x": pose.x_m, "y": pose.y_m, "z": 0.0}
    transform = {"translation": translation, "rotation": _plain_turn(pose.yaw_rad)}
    return {"header": header(time_ns, parent), "child_frame_id": child, "transform": transform}


def _plain_turn(yaw_rad: float) -> dict[str, float]:
    return {"x": 0.0, "y": 0.0, "z": math.sin(0.5 * yaw_rad), "w": math.cos(0.5 * yaw_rad)}


def turn_of(scan: Any) -> Turn:
    """Return what a sensor_msgs/LaserScan says; a range of null says nothing."""
    return Turn(
        time_s=nanoseconds(scan.header.stamp) / NS_PER_S,
        ranges_m=np.array(scan.ranges, dtype=np.float64),
        angle_min_rad=scan.angle_min,
        angle_step_rad=scan.angle_increment,
        time_step_s=scan.time_increment,
        min_m=scan.range_min,
        max_m=scan.range_max,
    )


def end_ns_of(scan: Any) -> int:
    """Return when a scan was complete."""
    turn_s: float = len(scan.ranges) * scan.time_increment
    return nanoseconds(scan.header.stamp) + round(turn_s * NS_PER_S)


def plain_map(grid: Grid, time_ns: int, frame: str) -> dict[str, Any]:
    """Return a grid as nav_msgs/OccupancyGrid, as rosbridge carries it."""
    rows, columns = grid.cells.shape
    sec, nanosec = divmod(time_ns, NS_PER_S)
    info = {
        "map_load_time": {"sec": sec, "nanosec": nanosec},
        "resolution": grid.resolution_m,
        "width": columns,
        "height": rows,
        "origin": plain_pose(Pose(grid.x_m, grid.y_m, 0.0)),
    }
    return {"header": header(time_ns, frame), "info": info, "data": grid.cells.ravel().tolist()}


def grid_of_map(message: Any) -> Grid:
    """Return a nav_msgs/OccupancyGrid whose origin is not turned; from 65 on a cell is occupied, up to 25 free.

    These are the limits of map_server's trinary maps.
    """
    info = message.info
    told = np.array(message.data, dtype=np.int16).reshape(info.height, info.width)
    cells = np.full(told.shape, -1, dtype=np.int8)
    cells[(told >= 0) & (told <= 25)] = 0
    cells[told >= 65] = 100
    return Grid(cells, info.resolution, info.origin.position.x, info.origin.position.y)


class FrameTree:
    """Which frame lies where in which."""

    def __init__(self) -> None:
        """Start with nothing known."""
        self._parents: dict[str, tuple[str, Pose]] = {}

    def add(self, transforms: Iterable[Any]) -> None:
        """Take transforms."""
        for one in transforms:
            self._parents[one.child_frame_id] = (one.header.frame_id, pose_of_transform(one.transform))

    def pose(self, frame: str, within: str) -> Pose | None:
        """Return where a frame lies in another that it hangs on; None where it does not."""
        pose, seen = ORIGIN, {frame}
        while frame != within:
            if frame not in self._parents:
                return None
            frame, step = self._parents[frame]
            if frame in seen:
                return None
            seen.add(frame)
            pose = composed(step, pose)
        return pose
