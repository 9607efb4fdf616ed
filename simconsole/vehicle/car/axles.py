"""Both axles: where their contact patches slide, what their tyres push."""

from typing import NamedTuple

from simconsole.kernels import kernel
from simconsole.trigonometry import cos, sin
from simconsole.vehicle.car.body import front_load
from simconsole.vehicle.car.parameters import CarParameters
from simconsole.vehicle.car.state import CarState
from simconsole.vehicle.car.tyre import Tyre, tyre


class Axles(NamedTuple):
    """Tyres of one step and the sum of their forces on the body."""

    front: Tyre
    rear: Tyre
    front_load_n: float
    rear_load_n: float
    force_x_n: float  # along the body
    force_y_n: float
    moment_nm: float  # about the centre of gravity, left-positive


@kernel
def push(s: CarState, car: CarParameters, angle_rad: float, step_s: float) -> Axles:
    """Return the tyres one step later, at the new road-wheel angle."""
    body = car.body
    c = cos(angle_rad)
    d = sin(angle_rad)
    front_n = front_load(body, s.transfer_ax_mps2)
    rear_n = body.mass_kg * body.gravity_plane_mps2 - front_n
    front_vy = s.vy_mps + body.cg_to_front_m * s.yaw_rate_radps
    # The contact patch stays on the ground while the wheel turns about it: its deflection turns back in the wheel.
    turned = angle_rad - s.road_wheel_rad
    kept_x = s.front_deflection_x_m + turned * s.front_deflection_y_m
    kept_y = s.front_deflection_y_m - turned * kept_x
    front = tyre(
        car.front,
        front_n,
        s.vx_mps * c + front_vy * d - s.front_wheel_radps * car.front.radius_m,
        front_vy * c - s.vx_mps * d,
        s.front_wheel_radps,
        kept_x,
        kept_y,
        step_s,
    )
    rear = tyre(
        car.rear,
        rear_n,
        s.vx_mps - s.rear_wheel_radps * car.rear.radius_m,
        s.vy_mps - body.cg_to_rear_m * s.yaw_rate_radps,
        s.rear_wheel_radps,
        s.rear_deflection_x_m,
        s.rear_deflection_y_m,
        step_s,
    )
    front_y = front.force_x_n * d + front.force_y_n * c
    return Axles(
        front,
        rear,
        front_n,
        rear_n,
        front.force_x_n * c - front.force_y_n * d + rear.force_x_n,
        front_y + rear.force_y_n,
        body.cg_to_front_m * front_y - body.cg_to_rear_m * rear.force_y_n,
    )
