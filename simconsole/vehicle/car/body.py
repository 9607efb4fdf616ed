"""Body: axle loads and the motion of a rigid body in the plane of the ground."""

from math import sqrt
from typing import NamedTuple

from simconsole.kernels import clip, kernel
from simconsole.trigonometry import cos, sin
from simconsole.vehicle.car.parameters import BodyParameters
from simconsole.vehicle.car.state import CarState


class Motion(NamedTuple):
    """Pose of base_link, velocities and accelerations of the centre of gravity after one step."""

    x_m: float
    y_m: float
    yaw_rad: float
    vx_mps: float
    vy_mps: float
    yaw_rate_radps: float
    ax_mps2: float
    ay_mps2: float
    distance_m: float


@kernel
def front_load(p: BodyParameters, transfer_ax_mps2: float) -> float:
    """Return the load of the front axle in N: static share minus what accelerating moves to the rear.

    Quasi-static balance about the rear contact: neither axle ever lifts (5 to 95 %), so that the tyres keep a limit.
    """
    share = (p.cg_to_rear_m - p.cg_height_m * transfer_ax_mps2 / p.gravity_plane_mps2) / (
        p.cg_to_front_m + p.cg_to_rear_m
    )
    return p.mass_kg * p.gravity_plane_mps2 * clip(share, 0.05, 0.95)


@kernel
def move(
    p: BodyParameters, before: CarState, force_x_n: float, force_y_n: float, moment_nm: float, step_s: float
) -> Motion:
    """Advance the body by one semi-implicit step: velocities from the forces, then the pose from the new velocities.

    Args:
        p: body and ground.
        before: the car before the step.
        force_x_n: sum of the tyre forces, forwards.
        force_y_n: sum of the tyre forces, to the left.
        moment_nm: of the tyre forces about the centre of gravity.
        step_s: length of the step.
    """
    c = cos(before.yaw_rad)
    s = sin(before.yaw_rad)
    air = p.drag_nsspmm * sqrt(before.vx_mps * before.vx_mps + before.vy_mps * before.vy_mps)
    ax = (force_x_n - air * before.vx_mps) / p.mass_kg - p.gravity_plane_mps2 * (p.slope_x * c + p.slope_y * s)
    ay = (force_y_n - air * before.vy_mps) / p.mass_kg - p.gravity_plane_mps2 * (p.slope_y * c - p.slope_x * s)
    # One after the other, not both from the old values: turning the body then neither adds nor takes energy.
    vx = before.vx_mps + step_s * (ax + before.yaw_rate_radps * before.vy_mps)
    vy = before.vy_mps + step_s * (ay - before.yaw_rate_radps * vx)
    yaw_rate = before.yaw_rate_radps + step_s * moment_nm / p.yaw_inertia_kgm2
    rear_vy = vy - p.cg_to_rear_m * yaw_rate
    return Motion(
        before.x_m + step_s * (vx * c - rear_vy * s),
        before.y_m + step_s * (vx * s + rear_vy * c),
        before.yaw_rad + step_s * yaw_rate,
        vx,
        vy,
        yaw_rate,
        ax,
        ay,
        before.distance_m + step_s * sqrt(vx * vx + rear_vy * rear_vy),
    )
