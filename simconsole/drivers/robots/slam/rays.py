"""A turn of a lidar as rays in the frame that its robot has at the end of the turn: without the skew of its motion."""

from typing import NamedTuple

import numpy as np

from simconsole.drivers.robots.slam.odometry_track import Array, OdometryTrack
from simconsole.drivers.robots.slam.planar import seen_from
from simconsole.values.platform import Pose


class Turn(NamedTuple):
    """What a sensor_msgs/LaserScan says."""

    time_s: float  # of the first ray
    ranges_m: Array
    angle_min_rad: float
    angle_step_rad: float
    time_step_s: float
    min_m: float
    max_m: float

    @property
    def end_s(self) -> float:
        """When the turn was complete."""
        return self.time_s + len(self.ranges_m) * self.time_step_s


class Rays(NamedTuple):
    """Rays in the frame of a robot's base."""

    lines_m: Array  # [N, 4]: x, y where each begins and where it ends
    echo: Array  # [N]: 1 where something is at its end, 0 where it only is free up to there
    odometry: Pose  # of the base whose frame it is

    @property
    def points_m(self) -> Array:
        """The echoes: x, y [N, 2]."""
        return self.lines_m[self.echo > 0.0, 2:]


def rays_of(turn: Turn, mount: Pose, track: OdometryTrack) -> Rays:
    """Return the rays of a turn, each from where the lidar was at its time.

    A range of infinity is a ray without an echo up to the lidar's range. Any other that is not within the lidar's
    bounds says nothing: the LDS-01 gives 0 for what is too near and for what is too far.

    Args:
        turn: what the lidar has measured.
        mount: the lidar's pose in the frame of the robot's base.
        track: odometry at least up to the end of the turn.

    Raises:
        ValueError: there is no odometry.
    """
    numbers = np.arange(len(turn.ranges_m))
    poses = track.at(np.append(turn.time_s + numbers * turn.time_step_s, turn.end_s))
    last = Pose(*poses[-1].tolist())
    echo = (turn.ranges_m >= turn.min_m) & (turn.ranges_m <= turn.max_m)
    kept = echo | np.isposinf(turn.ranges_m)
    x, y, yaw = _seen_from(last, poses[:-1][kept])
    from_x = x + mount.x_m * np.cos(yaw) - mount.y_m * np.sin(yaw)
    from_y = y + mount.x_m * np.sin(yaw) + mount.y_m * np.cos(yaw)
    angles = yaw + mount.yaw_rad + turn.angle_min_rad + numbers[kept] * turn.angle_step_rad
    ranges = np.minimum(turn.ranges_m[kept], turn.max_m)
    lines = np.column_stack((from_x, from_y, from_x + ranges * np.cos(angles), from_y + ranges * np.sin(angles)))
    return Rays(lines, echo[kept].astype(np.float64), last)


def _seen_from(frame: Pose, poses: Array) -> tuple[Array, Array, Array]:
    """Return poses [N, 3] in a frame that is given as they are, by x, y, yaw."""
    back = seen_from(frame, Pose(0.0, 0.0, 0.0))
    cosine, sine = np.cos(back.yaw_rad), np.sin(back.yaw_rad)
    x, y = poses[:, 0], poses[:, 1]
    return back.x_m + cosine * x - sine * y, back.y_m + sine * x + cosine * y, poses[:, 2] - frame.yaw_rad
