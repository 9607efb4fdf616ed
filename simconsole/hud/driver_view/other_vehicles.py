"""Everybody else on the road as the driver's view shows them: where they are between two steps of traffic."""

import math
from typing import Final

import numpy as np

from simconsole.hud.driver_view.mesh import Array, Colour, Vertices, joined, placed
from simconsole.hud.driver_view.vehicle_body import PAINT, SEAT_M, Size, VehicleMeshes, vehicle_meshes
from simconsole.world.traffic.road_users import RoadUser, RoadUsersAt, users

SIZE: Final = Size(length_m=4.4, width_m=1.8, height_m=1.5, rear_overhang_m=0.9, wheelbase_m=2.6)
"""Of the vehicle that stands for all: others are it, stretched."""
ROBOT: Final = Size(length_m=0.138, width_m=0.178, height_m=0.192, rear_overhang_m=0.101, wheelbase_m=0.16)
"""Of the robot that stands for all, a TurtleBot3 Burger."""
PAINTS: Final[tuple[Colour, ...]] = (
    (206, 208, 210), (40, 42, 46), (140, 144, 150), (150, 34, 34), (54, 92, 150), (226, 224, 216), (44, 84, 66),
)  # fmt: skip
"""Of other vehicles."""
LONGEST_S: Final = 0.5
"""Nobody is moved further on than this after the last step that came."""
SHARPEST_RAD: Final = 0.3
"""Who has turned by more in a step has turned round on the spot, as people do, and does not go on turning."""


def meshes() -> VehicleMeshes:
    """Return the vehicle that stands for all."""
    return vehicle_meshes(SIZE)


def bodies() -> tuple[Vertices, ...]:
    """Return the body of the vehicle that stands for all in each paint."""
    body = meshes().body
    painted = (body["colour"][:, :3] == PAINT).all(axis=1)
    found = []
    for paint in PAINTS:
        made = body.copy()
        made["colour"][painted, :3] = paint
        found.append(made)
    return tuple(found)


def robot() -> Vertices:
    """Return the robot that stands for all, stretched to the box of the vehicle that does."""
    parts = vehicle_meshes(ROBOT)
    wheels = [placed(parts.wheel, (x_m, y_m, 0.0), 0.0, 1.0) for x_m, y_m in parts.wheel_places]
    made = joined([parts.body, *wheels])
    made["position"][:, 0] += ROBOT.rear_overhang_m
    made["position"] *= np.divide(SIZE[:3], ROBOT[:3])
    made["position"][:, 0] -= SIZE.rear_overhang_m
    return made


def is_robot(user: RoadUser) -> bool:
    """Return whether a vehicle is one that nobody sits in."""
    return user.height_m < SEAT_M


def paint_of(user: RoadUser) -> int:
    """Return which of the paints a road user has, as long as it is there."""
    return int(user.id) % len(PAINTS)


def at_moment(newest: RoadUsersAt, t_s: float, tick_hz: int, before: RoadUsersAt | None = None) -> tuple[RoadUser, ...]:
    """Return the road users at `t_s`: moved on from their last step at their speed, and on in their turn.

    Not between the last two steps: that would show who drives ahead a step's way too near.

    Args:
        newest: Their last step.
        t_s: The moment.
        tick_hz: Ticks of a second.
        before: The step before, which tells how fast they turn; None: they go straight ahead.
    """
    late_s = min(max(t_s - newest.tick / tick_hz, 0.0), LONGEST_S)
    step_s = 0.0 if before is None else (newest.tick - before.tick) / tick_hz
    yaws = {} if before is None or step_s <= 0.0 else {user.id: user.yaw_rad for user in users(before.users)}
    return tuple(_moved_on(user, late_s, yaws.get(user.id, user.yaw_rad), step_s) for user in users(newest.users))


def _moved_on(user: RoadUser, late_s: float, yaw_before: float, step_s: float) -> RoadUser:
    turned = math.remainder(user.yaw_rad - yaw_before, math.tau)
    more = turned * min(late_s / step_s, 1.0) if step_s > 0.0 and abs(turned) < SHARPEST_RAD else 0.0
    way_m, yaw = late_s * user.speed_mps, user.yaw_rad + 0.5 * more
    return user._replace(
        x_m=user.x_m + way_m * math.cos(yaw), y_m=user.y_m + way_m * math.sin(yaw), yaw_rad=user.yaw_rad + more
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
