"""Poses on a plane: what one is in the frame of another."""

import math

from simconsole.values.platform import Pose

ORIGIN = Pose(0.0, 0.0, 0.0)


def composed(frame: Pose, pose: Pose) -> Pose:
    """Return a pose that is given in `frame` in the frame that `frame` is given in."""
    cosine, sine = math.cos(frame.yaw_rad), math.sin(frame.yaw_rad)
    return Pose(
        x_m=frame.x_m + cosine * pose.x_m - sine * pose.y_m,
        y_m=frame.y_m + sine * pose.x_m + cosine * pose.y_m,
        yaw_rad=wrapped(frame.yaw_rad + pose.yaw_rad),
    )


def inverse(pose: Pose) -> Pose:
    """Return the pose of the outer frame as seen from `pose`."""
    cosine, sine = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
    x_m = -cosine * pose.x_m - sine * pose.y_m
    y_m = sine * pose.x_m - cosine * pose.y_m
    return Pose(x_m, y_m, wrapped(-pose.yaw_rad))


def seen_from(frame: Pose, pose: Pose) -> Pose:
    """Return a pose in the frame of another that is given in the same frame."""
    return composed(inverse(frame), pose)


def wrapped(angle_rad: float) -> float:
    """Return an angle within half a turn to both sides."""
    return math.remainder(angle_rad, math.tau)
