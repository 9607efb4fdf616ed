"""What others see of the car, and what its pedals would do now."""

from typing import Final, NamedTuple

from simconsole.kernels import clip, kernel
from simconsole.signals import VehicleState
from simconsole.trigonometry import atan, cos, sin
from simconsole.vehicle.car.engine import above_idle, engine_friction, full_torque
from simconsole.vehicle.car.gearbox import bite, gear_ratio
from simconsole.vehicle.car.parameters import CarParameters
from simconsole.vehicle.car.state import CarState

SMOOTH_MPS: Final = 0.3
"""Speed over which rolling resistance changes its direction in the forecasts (not in the car)."""


class Pedals(NamedTuple):
    """Forecast accelerations, along the body: positive forwards."""

    coast_mps2: float
    full_throttle_mps2: float
    full_brake_mps2: float


@kernel
def pedals(s: CarState, car: CarParameters, automatic: float) -> Pedals:
    """Return what released pedals, full throttle and full brake would give now.

    Steady balance of forces in the gear in force, along the body (in reverse gear throttle is negative, brake
    positive). Smooth and finite at standstill: a held car counts as if it were just moving the way of its gear. In
    automatic the clutch counts as the automatic would have it, also during a shift.
    """
    body = car.body
    gear = s.wanted_gear if automatic != 0.0 else s.gear
    way = -1.0 if gear < 0.0 else 1.0
    radius = car.front.radius_m
    speed = way * s.vx_mps
    ratio = way * gear_ratio(car.gears, gear)
    grip = 1.0 if automatic != 0.0 else bite(car.gears, s.clutch)
    held = grip * car.gears.clutch_nm
    shaft = ratio * speed / radius
    driven = above_idle(car.engine, shaft)
    launch = shaft if shaft > car.gears.launch_to_radps else car.gears.launch_to_radps
    burned = full_torque(car.engine, launch) if s.engine_running != 0.0 else 0.0
    push = clip(burned, -held, held) * ratio / radius
    drag = clip(engine_friction(car.engine, shaft) * driven, 0.0, held) * ratio / radius
    mass = body.mass_kg + (
        car.front.wheel_inertia_kgm2
        + car.rear.wheel_inertia_kgm2
        + driven * grip * car.engine.inertia_kgm2 * ratio * ratio
    ) / (radius * radius)
    load = body.mass_kg * body.gravity_plane_mps2
    front_n = load * body.cg_to_rear_m / (body.cg_to_front_m + body.cg_to_rear_m)
    slope = body.slope_x * cos(s.yaw_rad) + body.slope_y * sin(s.yaw_rad)
    rolling = car.rear.rolling_resistance * load * speed / (abs(speed) + SMOOTH_MPS)
    outside = -way * slope * load - rolling - body.drag_nsspmm * speed * abs(speed)
    traction = car.front.friction * front_n
    stop = clip((car.front.brake_nm + car.rear.brake_nm) / radius, 0.0, car.rear.friction * load)
    return Pedals(
        way * (outside - drag) / mass,
        way * (outside + clip(push, -traction, traction)) / mass,
        way * (outside - drag - stop) / mass,
    )


@kernel
def vehicle_state(s: CarState, car: CarParameters, automatic: float) -> VehicleState:
    """Return the car as others see it: base_link on the plane of the ground, leaning with its accelerations."""
    body = car.body
    c = cos(s.yaw_rad)
    d = sin(s.yaw_rad)
    forecast = pedals(s, car, automatic)
    return VehicleState(
        s.x_m,
        s.y_m,
        body.slope_x * s.x_m + body.slope_y * s.y_m,
        s.yaw_rad,
        # ISO 8855: pitch is positive nose down, roll is positive left side up.
        -atan(body.slope_x * c + body.slope_y * d) - body.pitch_rad_per_mps2 * s.transfer_ax_mps2,
        atan(body.slope_y * c - body.slope_x * d) + body.roll_rad_per_mps2 * s.lean_ay_mps2,
        s.vx_mps,
        s.vy_mps - body.cg_to_rear_m * s.yaw_rate_radps,
        s.yaw_rate_radps,
        s.ax_mps2,
        s.ay_mps2,
        s.road_wheel_rad,
        s.hand_wheel_torque_nm,
        s.engine_radps,
        s.engine_running,
        s.gear,
        s.clutch,
        s.distance_m,
        forecast.coast_mps2,
        forecast.full_throttle_mps2,
        forecast.full_brake_mps2,
    )
