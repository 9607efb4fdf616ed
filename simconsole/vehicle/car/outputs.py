"""What others see of the car, and what its pedals would do now."""

from collections.abc import Callable
from math import sqrt
from typing import Final, NamedTuple

from simconsole.values.ground import GROUND, Plane
from simconsole.values.kernels import Row, clip, kernel
from simconsole.values.layout import read
from simconsole.values.signals import VehicleState
from simconsole.values.trigonometry import atan, direction
from simconsole.vehicle.car.axles import along_speed, side_speed
from simconsole.vehicle.car.engine import above_idle, engine_friction, full_torque
from simconsole.vehicle.car.gearbox import bite, gear_ratio
from simconsole.vehicle.car.ground import Grips, Lie, on_base
from simconsole.vehicle.car.parameters import CarParameters
from simconsole.vehicle.car.state import Car

SMOOTH_MPS: Final = 0.3
"""Speed over which rolling resistance changes its direction in the forecasts (not in the car)."""


class RoadAndWind(NamedTuple):
    """The ground's slope and the wind in the car's directions."""

    slope_along: float
    wind_mps: float  # along the car
    up_rad: float  # of the ground ahead
    left_up_rad: float


class Pedals(NamedTuple):
    """Forecast accelerations, along the body: positive forwards."""

    coast_mps2: float
    full_throttle_mps2: float
    full_brake_mps2: float


@kernel
def road_and_wind(lie: Lie, air: Plane, yaw_rad: float) -> RoadAndWind:
    """Return slope and wind for a car that points to `yaw_rad`."""
    ahead = direction(yaw_rad)
    c = ahead.cos
    s = ahead.sin
    along = lie.slope_x * c + lie.slope_y * s
    wind_mps = air.wind_x_mps * c + air.wind_y_mps * s
    aside = lie.slope_y * c - lie.slope_x * s
    return RoadAndWind(along, wind_mps, atan(along / sqrt(1.0 + aside * aside)), atan(aside))


@kernel
def pedals(car: Car, p: CarParameters, lie: RoadAndWind, base: Grips, gravity_mps2: float, automatic: float) -> Pedals:
    """Return what released pedals, full throttle and full brake would give now, on ground of a friction and gravity.

    Steady balance of forces in the gear in force, along the body (in reverse gear throttle is negative, brake
    positive). Smooth and finite at standstill: a held car counts as if it were just moving the way of its gear. In
    automatic the clutch counts as the automatic would have it, also during a shift.
    """
    body = p.body
    gears = p.gears
    gear = car.box.wanted_gear if automatic != 0.0 else car.box.gear
    way = -1.0 if gear < 0.0 else 1.0
    speed = way * along_speed(p.rear, car.body, car.rl, car.rr, body.cg_height_m)
    leverage = way * gear_ratio(gears, gear) * gears.per_wheel_radius_m
    grip = 1.0 if automatic != 0.0 else bite(gears, car.box.clutch)
    held = grip * gears.clutch_nm
    shaft = leverage * speed
    driven = above_idle(p.engine, shaft)
    launch = shaft if shaft > gears.launch_to_radps else gears.launch_to_radps
    burned = full_torque(p.engine, launch) if car.shafts.engine_running != 0.0 else 0.0
    push = clip(burned, -held, held) * leverage * (1.0 - gears.loss_share)
    drag = clip(engine_friction(p.engine, shaft) * driven, 0.0, held) * leverage * (1.0 + gears.loss_share)
    if automatic != 0.0 and abs(gear) == 1.0:
        creep = clip((gears.idle_radps - shaft) * gears.per_fade_radps, 0.0, 1.0)
        drag -= creep * gears.creep_held_nm * leverage * (1.0 - gears.loss_share)
    per_mass = 1.0 / (body.moving_kg + driven * grip * p.engine.inertia_kgm2 * leverage * leverage)
    load = body.mass_kg * gravity_mps2
    front_n = p.front.static_n * (base.fl + base.fr)
    rear_n = p.rear.static_n * (base.rl + base.rr)
    traction = rear_n if gears.rear_driven != 0.0 else front_n
    held_n = front_n + rear_n
    full_brake = held_n if held_n < body.full_brake_n else body.full_brake_n
    air = speed - way * lie.wind_mps
    rolling = p.rear.rolling_resistance * load * speed / (abs(speed) + SMOOTH_MPS)
    outside = -way * lie.slope_along * load - rolling - body.drag_n_per_square_mps * air * abs(air)
    return Pedals(
        way * (outside - drag) * per_mass,
        way * (outside + clip(push, -traction, traction)) * per_mass,
        way * (outside - drag - full_brake) * per_mass,
    )


@kernel
def vehicle_state(
    car: Car, p: CarParameters, ground: Row, lie_of: Callable[[Car, CarParameters, Row], Lie], automatic: float
) -> VehicleState:
    """Return the car as others see it: base_link on the plane under the wheels, with the body's own roll and pitch.

    base_link moves with the rear tyres, not with the body above them: a car at rest has no speed while its body rocks.
    """
    body = p.body
    now = car.body
    # Most drives are on level ground without wind: skip the trigonometry there.
    under = lie_of(car, p, ground)
    air = read(ground, GROUND.plane)
    lie = RoadAndWind(0.0, 0.0, 0.0, 0.0)
    if under.slope_x != 0.0 or under.slope_y != 0.0 or air.wind_x_mps != 0.0 or air.wind_y_mps != 0.0:
        lie = road_and_wind(under, air, now.yaw_rad)
    forecast = pedals(car, p, lie, on_base(p, air), under.gravity_mps2, automatic)
    return VehicleState(
        x_m=now.x_m,
        y_m=now.y_m,
        z_m=under.height_m,
        yaw_rad=now.yaw_rad,
        # ISO 8855: pitch is positive nose down, roll is positive left side up.
        pitch_rad=now.pitch_rad - lie.up_rad,
        roll_rad=now.roll_rad + lie.left_up_rad,
        vx_mps=along_speed(p.rear, now, car.rl, car.rr, body.cg_height_m),
        vy_mps=side_speed(p.rear, now, car.rl, car.rr),
        yaw_rate_radps=now.yaw_rate_radps,
        ax_mps2=now.ax_mps2,
        ay_mps2=now.ay_mps2,
        road_wheel_rad=car.steering.road_wheel_rad,
        hand_wheel_torque_nm=car.steering.hand_wheel_torque_nm,
        engine_radps=car.shafts.engine_radps,
        engine_running=car.shafts.engine_running,
        gear=car.box.gear,
        clutch=car.box.clutch,
        distance_m=now.distance_m,
        coast_accel_mps2=forecast.coast_mps2,
        full_throttle_accel_mps2=forecast.full_throttle_mps2,
        full_brake_accel_mps2=forecast.full_brake_mps2,
        gear_fault=car.box.gear_fault,
    )
