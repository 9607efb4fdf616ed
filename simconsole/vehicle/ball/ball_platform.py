"""From a ball's profile to a platform."""

import math

import numpy as np

from simconsole.profiles.vehicle import BallProfile
from simconsole.values.platform import Ground, Platform, Pose
from simconsole.values.trigonometry import wrap_angle
from simconsole.values.units import RAD_PER_DEG, STANDARD_GRAVITY_MPS2
from simconsole.vehicle.ball.ball_step import BALL, BallParameters, BallState, step, vehicle_state

ROLLING_SHARE = 5.0 / 7.0
"""Acceleration of a solid sphere rolling down a slope, as a share of a sliding body's (inertia 2/5 m r2)."""


def build_ball(profile: BallProfile, pose: Pose, ground: Ground) -> Platform:
    """Return the ball at rest. It needs little friction: `ground.friction` limits its acceleration and its brake."""
    gravity = STANDARD_GRAVITY_MPS2 / math.sqrt(1.0 + ground.slope_x**2 + ground.slope_y**2)
    grip = ground.friction * gravity
    parameters = BallParameters(
        radius_m=profile.radius_m,
        max_accel_mps2=min(profile.max_accel_mps2, grip),
        brake_mps2=min(profile.brake_mps2, grip),
        rolling_mps2=profile.rolling_mps2,
        approach_s=profile.approach_s,
        turn_per_s=profile.turn_per_s,
        max_road_wheel_rad=profile.max_road_wheel_deg * RAD_PER_DEG,
        slope_x=ground.slope_x,
        slope_y=ground.slope_y,
        gravity_x_mps2=-ROLLING_SHARE * gravity * ground.slope_x,
        gravity_y_mps2=-ROLLING_SHARE * gravity * ground.slope_y,
    )
    initial = BallState(*(0.0,) * BALL.width)._replace(x_m=pose.x_m, y_m=pose.y_m, yaw_rad=wrap_angle(pose.yaw_rad))
    size = 2.0 * profile.radius_m
    return Platform(
        name="ball",
        state=BallState,
        initial_state=tuple(initial),
        initial_vehicle=vehicle_state(initial, parameters, 0.0),
        parameters=np.array(parameters, dtype=np.float64),
        step=step,
        steering_ratio=profile.steering_ratio,
        max_road_wheel_rad=parameters.max_road_wheel_rad,
        wheelbase_m=size,
        length_m=size,
        width_m=size,
        height_m=size,
        rear_overhang_m=profile.radius_m,
    )
