"""One tick of the car: the order of its parts. Every part is a kernel of its own file."""

from typing import Final

from simconsole.kernels import Row, clip, is_finite, kernel, put, take
from simconsole.rows import COMMAND_AT, COMMAND_WIDTH, PLATFORM_AT, VEHICLE_AT
from simconsole.signals import VehicleCommand
from simconsole.trigonometry import PI, cos, sin, wrap_angle
from simconsole.vehicle.car.body import front_load, move
from simconsole.vehicle.car.engine import engine_drive
from simconsole.vehicle.car.gearbox import Gearbox, bite, gear_ratio, work_gearbox
from simconsole.vehicle.car.outputs import vehicle_state
from simconsole.vehicle.car.parameters import (
    AXLE_WIDTH,
    BODY_AT,
    BODY_WIDTH,
    ENGINE_AT,
    ENGINE_WIDTH,
    FRONT_AT,
    GEARS_AT,
    GEARS_WIDTH,
    REAR_AT,
    AxleParameters,
    BodyParameters,
    CarParameters,
    EngineParameters,
    GearParameters,
)
from simconsole.vehicle.car.powertrain import braked, solve_shafts
from simconsole.vehicle.car.state import CAR_WIDTH, CarState
from simconsole.vehicle.car.steering import hand_wheel_torque, steer
from simconsole.vehicle.car.tyre import tyre

STEP_S: Final = 0.001
"""The car integrates at 1 ms whatever the tick; the stiffest mode (a wheel on its tyre) has 30 ms."""

ANTI_STALL_FROM: Final = 0.6
ANTI_STALL_TO: Final = 0.9
"""Shares of idle speed between which the automatic's clutch gives way at once, whatever its actuator does."""


@kernel
def step(previous: Row, row: Row, parameters: Row, substeps: int) -> None:
    """Advance the car by one tick: the platform interface of vehicle/platform.py."""
    car = CarParameters(
        BodyParameters(*take(parameters, BODY_AT, BODY_WIDTH)),
        EngineParameters(*take(parameters, ENGINE_AT, ENGINE_WIDTH)),
        GearParameters(*take(parameters, GEARS_AT, GEARS_WIDTH)),
        AxleParameters(*take(parameters, FRONT_AT, AXLE_WIDTH)),
        AxleParameters(*take(parameters, REAR_AT, AXLE_WIDTH)),
    )
    command = VehicleCommand(*take(row, COMMAND_AT, COMMAND_WIDTH))
    state = CarState(*take(previous, PLATFORM_AT, CAR_WIDTH))
    road_wheel = command.road_wheel_rad if is_finite(command.road_wheel_rad) else state.road_wheel_rad
    throttle = pedal(command.throttle)
    brake = pedal(command.brake)
    clutch = pedal(command.clutch)
    handbrake = pedal(command.handbrake)
    gear = command.gear if is_finite(command.gear) else 0.0
    for _ in range(substeps):
        state = substep(state, car, road_wheel, throttle, brake, clutch, handbrake, gear, command.automatic)
    put(row, PLATFORM_AT, state)
    put(row, VEHICLE_AT, vehicle_state(state, car, command.automatic))


@kernel
def pedal(value: float) -> float:
    """Return a pedal position 0..1. The gate passes only finite values; anything else counts as released."""
    return clip(value, 0.0, 1.0) if is_finite(value) else 0.0


@kernel
def substep(
    s: CarState,
    car: CarParameters,
    road_wheel_rad: float,
    throttle: float,
    brake: float,
    clutch: float,
    handbrake: float,
    gear: float,
    automatic: float,
) -> CarState:
    """Advance the car by 1 ms: steer, shift, burn, grip, turn the shafts, move. Arguments as in `VehicleCommand`."""
    body = car.body
    front = car.front
    rear = car.rear

    angle = steer(body, s.road_wheel_rad, road_wheel_rad, STEP_S)
    turned = angle - s.road_wheel_rad

    box = work_gearbox(
        car.gears,
        Gearbox(s.gear, s.clutch, s.lever_adopted, s.wanted_gear, s.shift_left_s, s.since_shift_s),
        automatic,
        gear,
        clutch,
        throttle,
        s.engine_radps,
        s.front_wheel_radps,
        s.vx_mps,
        STEP_S,
    )
    ratio = gear_ratio(car.gears, box.gear)
    clutch_nm = bite(car.gears, box.clutch) * car.gears.clutch_nm if ratio != 0.0 else 0.0
    if box.lever_adopted == 0.0:
        turning = s.engine_radps / car.engine.idle_radps
        clutch_nm *= clip((turning - ANTI_STALL_FROM) / (ANTI_STALL_TO - ANTI_STALL_FROM), 0.0, 1.0)
        if box.shift_left_s > 0.0:
            throttle = 0.0  # the automatic lifts while its clutch is open
    drive = engine_drive(car.engine, s.engine_radps, s.engine_running, throttle, clutch_nm == 0.0)

    c = cos(angle)
    d = sin(angle)
    front_vy = s.vy_mps + body.cg_to_front_m * s.yaw_rate_radps
    front_n = front_load(body, s.transfer_ax_mps2)
    rear_n = body.mass_kg * body.gravity_plane_mps2 - front_n
    # The contact patch stays on the ground while the wheel turns about it: its deflection turns back in the wheel.
    kept_x = s.front_deflection_x_m + turned * s.front_deflection_y_m
    kept_y = s.front_deflection_y_m - turned * kept_x
    front_tyre = tyre(
        front,
        front_n,
        s.vx_mps * c + front_vy * d - s.front_wheel_radps * front.radius_m,
        front_vy * c - s.vx_mps * d,
        s.front_wheel_radps,
        kept_x,
        kept_y,
        STEP_S,
    )
    rear_tyre = tyre(
        rear,
        rear_n,
        s.vx_mps - s.rear_wheel_radps * rear.radius_m,
        s.vy_mps - body.cg_to_rear_m * s.yaw_rate_radps,
        s.rear_wheel_radps,
        s.rear_deflection_x_m,
        s.rear_deflection_y_m,
        STEP_S,
    )

    front_brake_nm = brake * front.brake_nm + handbrake * front.handbrake_nm
    rear_brake_nm = brake * rear.brake_nm + handbrake * rear.handbrake_nm
    shafts = solve_shafts(
        s.engine_radps + STEP_S * drive.torque_nm / car.engine.inertia_kgm2,
        s.front_wheel_radps - STEP_S * front_tyre.force_x_n * front.radius_m / front.wheel_inertia_kgm2,
        ratio,
        car.engine.inertia_kgm2,
        front.wheel_inertia_kgm2,
        STEP_S * drive.friction_nm,
        STEP_S * clutch_nm,
        STEP_S * (front_brake_nm + front.rolling_resistance * front_n * front.radius_m),
        s.engine_impulse_nms,
        s.clutch_impulse_nms,
        s.brake_impulse_nms,
    )
    rear_wheel = braked(
        s.rear_wheel_radps - STEP_S * rear_tyre.force_x_n * rear.radius_m / rear.wheel_inertia_kgm2,
        rear.wheel_inertia_kgm2,
        STEP_S * (rear_brake_nm + rear.rolling_resistance * rear_n * rear.radius_m),
    )

    front_x = front_tyre.force_x_n * c - front_tyre.force_y_n * d
    front_y = front_tyre.force_x_n * d + front_tyre.force_y_n * c
    force_x = front_x + rear_tyre.force_x_n
    force_y = front_y + rear_tyre.force_y_n
    motion = move(
        body,
        s.x_m,
        s.y_m,
        s.yaw_rad,
        s.vx_mps,
        s.vy_mps,
        s.yaw_rate_radps,
        s.distance_m,
        force_x,
        force_y,
        body.cg_to_front_m * front_y - body.cg_to_rear_m * rear_tyre.force_y_n,
        STEP_S,
    )
    share = STEP_S / (body.sway_s + STEP_S)
    return CarState(
        motion.x_m,
        motion.y_m,
        motion.yaw_rad if abs(motion.yaw_rad) <= PI else wrap_angle(motion.yaw_rad),
        motion.vx_mps,
        motion.vy_mps,
        motion.yaw_rate_radps,
        motion.ax_mps2,
        motion.ay_mps2,
        s.transfer_ax_mps2 + share * (force_x / body.mass_kg - s.transfer_ax_mps2),
        s.lean_ay_mps2 + share * (force_y / body.mass_kg - s.lean_ay_mps2),
        angle,
        shafts.wheel_radps,
        rear_wheel,
        front_tyre.deflection_x_m,
        front_tyre.deflection_y_m,
        rear_tyre.deflection_x_m,
        rear_tyre.deflection_y_m,
        hand_wheel_torque(
            body, front_tyre.force_y_n, front_tyre.grip, shafts.wheel_radps * front.radius_m, turned / STEP_S
        ),
        shafts.engine_radps,
        drive.running,
        shafts.engine_impulse_nms,
        shafts.clutch_impulse_nms,
        shafts.brake_impulse_nms,
        box.gear,
        box.clutch,
        box.lever_adopted,
        box.wanted_gear,
        box.shift_left_s,
        box.since_shift_s,
        motion.distance_m,
    )
