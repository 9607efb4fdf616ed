"""Body: axle loads and the motion of a rigid body in the plane of the ground."""

from math import sqrt
from typing import NamedTuple

from simconsole.kernels import clip, kernel
from simconsole.trigonometry import cos, sin
from simconsole.vehicle.car.parameters import BodyParameters


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
    p: BodyParameters,
    x_m: float,
    y_m: float,
    yaw_rad: float,
    vx_mps: float,
    vy_mps: float,
    yaw_rate_radps: float,
    distance_m: float,
    force_x_n: float,
    force_y_n: float,
    moment_nm: float,
    step_s: float,
) -> Motion:
    """Advance the body by one semi-implicit step: velocities from the forces, then the pose from the new velocities.

    Args:
        p: body and ground.
        x_m: base_link in map.
        y_m: base_link in map.
        yaw_rad: heading.
        vx_mps: centre of gravity, forwards.
        vy_mps: centre of gravity, to the left.
        yaw_rate_radps: left-positive.
        distance_m: odometer.
        force_x_n: sum of the tyre forces, forwards.
        force_y_n: sum of the tyre forces, to the left.
        moment_nm: of the tyre forces about the centre of gravity.
        step_s: length of the step.
    """
    c = cos(yaw_rad)
    s = sin(yaw_rad)
    air = p.drag_nsspmm * sqrt(vx_mps * vx_mps + vy_mps * vy_mps)
    ax = (force_x_n - air * vx_mps) / p.mass_kg - p.gravity_plane_mps2 * (p.slope_x * c + p.slope_y * s)
    ay = (force_y_n - air * vy_mps) / p.mass_kg - p.gravity_plane_mps2 * (p.slope_y * c - p.slope_x * s)
    # One after the other, not both from the old values: turning the body then neither adds nor takes energy.
    vx = vx_mps + step_s * (ax + yaw_rate_radps * vy_mps)
    vy = vy_mps + step_s * (ay - yaw_rate_radps * vx)
    yaw_rate = yaw_rate_radps + step_s * moment_nm / p.yaw_inertia_kgm2
    rear_vy = vy - p.cg_to_rear_m * yaw_rate
    return Motion(
        x_m + step_s * (vx * c - rear_vy * s),
        y_m + step_s * (vx * s + rear_vy * c),
        yaw_rad + step_s * yaw_rate,
        vx,
        vy,
        yaw_rate,
        ax,
        ay,
        distance_m + step_s * sqrt(vx * vx + rear_vy * rear_vy),
    )
