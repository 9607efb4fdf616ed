"""What navigation knows of the robot that it drives."""

from typing import NamedTuple

from simconsole.profiles.parts.turtlebot import TurtlebotProfile


class RobotShape(NamedTuple):
    """A round body on two driven wheels."""

    body_x_m: float  # its middle, ahead of base_footprint
    radius_m: float
    wheels_apart_m: float
    wheel_mps: float  # at most, at the rim
    speed_mps: float
    yaw_rate_radps: float
    accel_mps2: float
    lidar_x_m: float


def shape_of(profile: TurtlebotProfile) -> RobotShape:
    """Return the shape of a robot."""
    return RobotShape(
        body_x_m=profile.body_x_m,
        radius_m=profile.body_radius_m,
        wheels_apart_m=profile.wheel_separation_m,
        wheel_mps=profile.max_wheel_radps * profile.wheel_radius_m,
        speed_mps=profile.max_speed_mps,
        yaw_rate_radps=profile.max_yaw_rate_radps,
        accel_mps2=profile.max_accel_mps2,
        lidar_x_m=profile.lidar.x_m,
    )
