"""From a ball's profile to a platform."""

import numpy as np

from simconsole.profiles.vehicle import BallProfile
from simconsole.values.ground import Ground, ground_row
from simconsole.values.platform import Platform, Pose
from simconsole.values.trigonometry import wrap_angle
from simconsole.values.units import RAD_PER_DEG
from simconsole.vehicle.ball.ball_step import (
    BALL,
    BallParameters,
    BallState,
    field_step,
    on_field,
    on_plane,
    step,
    vehicle_state,
)


def build_ball(profile: BallProfile, pose: Pose, ground: Ground) -> Platform:
    """Return the ball at rest."""
    parameters = BallParameters(
        radius_m=profile.radius_m,
        max_accel_mps2=profile.max_accel_mps2,
        brake_mps2=profile.brake_mps2,
        rolling_mps2=profile.rolling_mps2,
        approach_s=profile.approach_s,
        turn_per_s=profile.turn_per_s,
        max_road_wheel_rad=profile.max_road_wheel_deg * RAD_PER_DEG,
    )
    initial = BallState(*(0.0,) * BALL.width)._replace(x_m=pose.x_m, y_m=pose.y_m, yaw_rad=wrap_angle(pose.yaw_rad))
    under = ground_row(ground)
    on = (on_plane if ground.field is None else on_field)(initial.x_m, initial.y_m, parameters, under)
    size = 2.0 * profile.radius_m
    return Platform(
        name="ball",
        state=BallState,
        initial_state=tuple(initial),
        initial_vehicle=vehicle_state(initial, parameters, on, 0.0),
        parameters=np.array(parameters, dtype=np.float64),
        ground=under,
        step=step if ground.field is None else field_step,
        steering_ratio=profile.steering_ratio,
        max_road_wheel_rad=parameters.max_road_wheel_rad,
        wheelbase_m=size,
        length_m=size,
        width_m=size,
        height_m=size,
        rear_overhang_m=profile.radius_m,
    )
