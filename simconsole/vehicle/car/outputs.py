"""What others see of the car, and what its pedals would do now."""

from math import sqrt
from typing import Final, NamedTuple

from simconsole.kernels import clip, kernel
from simconsole.signals import VehicleState
from simconsole.trigonometry import atan, direction
from simconsole.vehicle.car.axles import along_speed, side_speed
from simconsole.vehicle.car.engine import above_idle, engine_friction, full_torque
from simconsole.vehicle.car.gearbox import bite, gear_ratio
from simconsole.vehicle.car.parameters import CarParameters
from simconsole.vehicle.car.state import Car

SMOOTH_MPS: Final = 0.3
"""Speed over which rolling resistance changes its direction in the forecasts (not in the car)."""


class Pedals(NamedTuple):
    """Forecast accelerations, along the body: positive forwards."""

    coast_mps2: float
    full_throttle_mps2: float
    full_brake_mps2: float


@kernel
def pedals(car: Car, p: CarParameters, automatic: float) -> Pedals:
    """Return what released pedals, full throttle and full brake would give now.

    Steady balance of forces in the gear in force, along the body (in reverse gear throttle is negative, brake
    positive). Smooth and finite at standstill: a held car counts as if it were just moving the way of its gear. In
    automatic the clutch counts as the automatic would have it, also during a shift.
    """
    body = p.body
    at_rear = p.gears.rear_driven != 0.0
    axle = p.rear if at_rear else p.front
    gear = car.box.wanted_gear if automatic != 0.0 else car.box.gear
    way = -1.0 if gear < 0.0 else 1.0
    radius = axle.radius_m
    speed = way * along_speed(car.body, body.cg_height_m)
    ratio = way * gear_ratio(p.gears, gear)
    grip = 1.0 if automatic != 0.0 else bite(p.gears, car.box.clutch)
    held = grip * p.gears.clutch_nm
    shaft = ratio * speed / radius
    driven = above_idle(p.engine, shaft)
    launch = shaft if shaft > p.gears.launch_to_radps else p.gears.launch_to_radps
    burned = full_torque(p.engine, launch) if car.shafts.engine_running != 0.0 else 0.0
    push = clip(burned, -held, held) * ratio / radius
    drag = clip(engine_friction(p.engine, shaft) * driven, 0.0, held) * ratio / radius
    wheels = 2.0 * (p.front.wheel_inertia_kgm2 + p.rear.wheel_inertia_kgm2)
    mass = body.mass_kg + (wheels + driven * grip * p.engine.inertia_kgm2 * ratio * ratio) / (radius * radius)
    load = body.mass_kg * body.gravity_plane_mps2
    ahead = direction(car.body.yaw_rad)
    slope = body.slope_x * ahead.cos + body.slope_y * ahead.sin
    air = speed - way * (body.wind_x_mps * ahead.cos + body.wind_y_mps * ahead.sin)
    rolling = p.rear.rolling_resistance * load * speed / (abs(speed) + SMOOTH_MPS)
    outside = -way * slope * load - rolling - body.drag_nsspmm * air * abs(air)
    traction = axle.static_n * (axle.friction_left + axle.friction_right)
    grips = p.front.static_n * (p.front.friction_left + p.front.friction_right)
    grips += p.rear.static_n * (p.rear.friction_left + p.rear.friction_right)
    stop = clip(2.0 * (p.front.brake_nm + p.rear.brake_nm) / radius, 0.0, grips)
    return Pedals(
        way * (outside - drag) / mass,
        way * (outside + clip(push, -traction, traction)) / mass,
        way * (outside - drag - stop) / mass,
    )


@kernel
def vehicle_state(car: Car, p: CarParameters, automatic: float) -> VehicleState:
    """Return the car as others see it: base_link on the plane of the ground, with the body's own roll and pitch.

    base_link moves with the rear tyres, not with the body above them: a car at rest has no speed while its body rocks.
    """
    body = p.body
    now = car.body
    ahead = direction(now.yaw_rad)
    c = ahead.cos
    d = ahead.sin
    forecast = pedals(car, p, automatic)
    ahead_slope = body.slope_x * c + body.slope_y * d
    side_slope = body.slope_y * c - body.slope_x * d
    tilt = sqrt(1.0 + side_slope * side_slope)
    return VehicleState(
        now.x_m,
        now.y_m,
        # x and y lie in the plane: one metre of it rises by the slope's sine.
        (body.slope_x * now.x_m + body.slope_y * now.y_m) / sqrt(tilt * tilt + ahead_slope * ahead_slope),
        now.yaw_rad,
        # ISO 8855: pitch is positive nose down, roll is positive left side up.
        -atan(ahead_slope / tilt) + now.pitch_rad,
        atan(side_slope) + now.roll_rad,
        along_speed(now, body.cg_height_m),
        side_speed(p.rear, now, car.rl, car.rr),
        now.yaw_rate_radps,
        now.ax_mps2,
        now.ay_mps2,
        car.steering.road_wheel_rad,
        car.steering.hand_wheel_torque_nm,
        car.shafts.engine_radps,
        car.shafts.engine_running,
        car.box.gear,
        car.box.clutch,
        now.distance_m,
        forecast.coast_mps2,
        forecast.full_throttle_mps2,
        forecast.full_brake_mps2,
        car.box.gear_fault,
    )
