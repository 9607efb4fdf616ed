"""What the autopilot reads of odometry: the fields of nav_msgs/Odometry that say where the car is and how it moves."""

import math
from typing import Any

import msgspec

from simconsole.drivers.path_tracker.state_estimator import VehicleMotion


class _Stamp(msgspec.Struct):
    sec: int
    nanosec: int


class _Header(msgspec.Struct):
    stamp: _Stamp


class _Vector(msgspec.Struct):
    x: float
    y: float
    z: float


class _Quaternion(msgspec.Struct):
    x: float
    y: float
    z: float
    w: float


class _Pose(msgspec.Struct):
    position: _Vector
    orientation: _Quaternion


class _PoseWithCovariance(msgspec.Struct):
    pose: _Pose


class _Twist(msgspec.Struct):
    linear: _Vector
    angular: _Vector


class _TwistWithCovariance(msgspec.Struct):
    twist: _Twist


class Odometry(msgspec.Struct):
    """A nav_msgs/Odometry without covariances and frames: half of its text is not even decoded."""

    header: _Header
    pose: _PoseWithCovariance
    twist: _TwistWithCovariance


def motion_of(odometry: Any) -> VehicleMotion | None:
    """Return what a nav_msgs/Odometry says of base_link, None if a value is not finite."""
    pose, twist = odometry.pose.pose, odometry.twist.twist
    q = pose.orientation
    yaw = math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
    seen = VehicleMotion(
        x_m=pose.position.x,
        y_m=pose.position.y,
        yaw_rad=yaw,
        vx_mps=twist.linear.x,
        vy_mps=twist.linear.y,
        yaw_rate_radps=twist.angular.z,
    )
    return seen if all(map(math.isfinite, seen)) else None
