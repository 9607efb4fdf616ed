"""From a robot's profile to a platform."""

from typing import Final

import numpy as np

from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.values.draws import Channel, even
from simconsole.values.ground import Ground, ground_row
from simconsole.values.platform import Obstacles, Platform, Pose
from simconsole.values.trigonometry import wrap_angle
from simconsole.values.units import RAD_PER_DEG, STANDARD_GRAVITY_MPS2
from simconsole.vehicle.turtlebot.robot_state import Gauges, Motion, Odometry, RobotParameters, RobotState, ScanKnot
from simconsole.vehicle.turtlebot.turtlebot_step import step, vehicle_state

_SEEDS: Final = 2147483645


def build_turtlebot(
    profile: TurtlebotProfile, pose: Pose, ground: Ground, obstacles: Obstacles, others: int = 0
) -> Platform:
    """Return the robot at rest, among `others`. The floor is level; its friction limits what the wheels pass on."""
    parameters = robot_parameters(profile, ground, obstacles, others)
    yaw = wrap_angle(pose.yaw_rad)
    here = ScanKnot(*(0.0,) * len(ScanKnot._fields))._replace(x_m=pose.x_m, y_m=pose.y_m, yaw_rad=yaw)
    seed = 1.0 + float(int(even(profile.odometry.seed, Channel.WHEEL_SLIP, 0) * _SEEDS))
    initial = RobotState(
        motion=Motion(*(0.0,) * len(Motion._fields))._replace(x_m=pose.x_m, y_m=pose.y_m, yaw_rad=yaw),
        gauges=Gauges(*(0.0,) * len(Gauges._fields))._replace(slip_seed=seed),
        odometry=Odometry(*(0.0,) * len(Odometry._fields)),
        scan_from=here,
        scan_to=here,
    )
    return Platform(
        name="turtlebot",
        state=RobotState,
        initial_state=tuple(value for part in initial for value in part),
        initial_vehicle=vehicle_state(initial, parameters, 0.0),
        parameters=np.array((*parameters, *_row(obstacles)), dtype=np.float64),
        ground=ground_row(ground),
        step=step,
        steering_ratio=profile.steering_ratio,
        max_road_wheel_rad=parameters.max_road_wheel_rad,
        wheelbase_m=profile.wheel_separation_m,
        length_m=profile.length_m,
        width_m=profile.width_m,
        height_m=profile.height_m,
        rear_overhang_m=0.5 * profile.length_m - profile.body_x_m,
        others=others,
        turns_in_place=True,
    )


def robot_parameters(
    profile: TurtlebotProfile, ground: Ground, obstacles: Obstacles, others: int = 0
) -> RobotParameters:
    """Return what stays constant over a drive."""
    grip = ground.friction * STANDARD_GRAVITY_MPS2
    return RobotParameters(
        wheel_radius_m=profile.wheel_radius_m,
        separation_m=profile.wheel_separation_m,
        max_wheel_radps=profile.max_wheel_radps,
        max_speed_mps=profile.max_speed_mps,
        max_yaw_rate_radps=profile.max_yaw_rate_radps,
        accel_mps2=min(profile.max_accel_mps2, grip),
        brake_mps2=min(profile.brake_mps2, grip),
        max_road_wheel_rad=profile.max_road_wheel_deg * RAD_PER_DEG,
        body_x_m=profile.body_x_m,
        body_radius_m=profile.body_radius_m,
        distance_scale=profile.odometry.distance_scale,
        turn_scale=profile.odometry.turn_scale,
        slip_m_per_root_m=profile.odometry.slip_m_per_root_m,
        idle_w=profile.battery.idle_w,
        drive_w=profile.battery.drive_w,
        scan_ms=round(1000.0 * profile.lidar.turn_s),
        others=float(others),
        segments=float(len(obstacles.segments)),
        circles=float(len(obstacles.circles)),
    )


def _row(obstacles: Obstacles) -> list[float]:
    return [value for part in obstacles for one in part for value in one]
