"""Everybody else on the road as the driver's view shows them: where they are between two steps of traffic."""

import math
from typing import Final

import numpy as np

from simconsole.hud.driver_view.mesh import Array
from simconsole.hud.driver_view.vehicle_body import Size, VehicleMeshes, vehicle_meshes
from simconsole.world.traffic.road_users import RoadUser, RoadUsersAt, users

SIZE: Final = Size(length_m=4.4, width_m=1.8, height_m=1.5, rear_overhang_m=0.9, wheelbase_m=2.6)
"""Of the vehicle that stands for all: others are it, stretched."""
LONGEST_S: Final = 0.5
"""Nobody is moved further on than this after the last step that came."""


def meshes() -> VehicleMeshes:
    """Return the vehicle that stands for all."""
    return vehicle_meshes(SIZE)


def at_moment(newest: RoadUsersAt, t_s: float, tick_hz: int) -> tuple[RoadUser, ...]:
    """Return the road users at `t_s`: moved on from their last step, straight ahead at their speed."""
    late_s = min(max(t_s - newest.tick / tick_hz, 0.0), LONGEST_S)
    return tuple(
        user._replace(
            x_m=user.x_m + late_s * user.speed_mps * math.cos(user.yaw_rad),
            y_m=user.y_m + late_s * user.speed_mps * math.sin(user.yaw_rad),
        )
        for user in users(newest.users)
    )


def model(user: RoadUser) -> Array:
    """Return the matrix [4, 4] that brings the vehicle that stands for all to the place and size of a road user."""
    cosine, sine = math.cos(user.yaw_rad), math.sin(user.yaw_rad)
    along, across, up = user.length_m / SIZE.length_m, user.width_m / SIZE.width_m, user.height_m / SIZE.height_m
    rear = -along * (0.5 * SIZE.length_m - SIZE.rear_overhang_m)  # base_link is behind the middle
    return np.array(
        (
            (along * cosine, -across * sine, 0.0, user.x_m + rear * cosine),
            (along * sine, across * cosine, 0.0, user.y_m + rear * sine),
            (0.0, 0.0, up, 0.0),
            (0.0, 0.0, 0.0, 1.0),
        )
    )
