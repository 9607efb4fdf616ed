"""One tick of the car: the order of its parts. Every part is a kernel of its own file."""

from typing import Final

from simconsole.kernels import Row, clip, is_finite, kernel, put, take
from simconsole.rows import COMMAND_AT, COMMAND_WIDTH, PLATFORM_AT, VEHICLE_AT
from simconsole.signals import Request, VehicleCommand
from simconsole.trigonometry import wrap_angle
from simconsole.vehicle.car.axles import push
from simconsole.vehicle.car.body import move
from simconsole.vehicle.car.driveline import turn
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
from simconsole.vehicle.car.state import CAR_WIDTH, CarState
from simconsole.vehicle.car.steering import hand_wheel_torque, steer

STEP_S: Final = 0.001
"""The car integrates at 1 ms whatever the tick; its stiffest mode (a wheel on its tyre) has a period of 30 ms."""


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
    request = Request(
        command.road_wheel_rad if is_finite(command.road_wheel_rad) else state.road_wheel_rad,
        pedal(command.throttle),
        pedal(command.brake),
        pedal(command.clutch),
        pedal(command.handbrake),
        command.gear if is_finite(command.gear) else 0.0,
        command.automatic,
    )
    for _ in range(substeps):
        state = substep(state, car, request)
    put(row, PLATFORM_AT, state)
    put(row, VEHICLE_AT, vehicle_state(state, car, command.automatic))


@kernel
def pedal(value: float) -> float:
    """Return a pedal position 0..1. The gate passes only finite values; anything else counts as released."""
    return clip(value, 0.0, 1.0) if is_finite(value) else 0.0


@kernel
def substep(s: CarState, car: CarParameters, request: Request) -> CarState:
    """Advance the car by 1 ms: steer, push against the ground, turn the shafts, move."""
    body = car.body
    angle = steer(body, s.road_wheel_rad, request.road_wheel_rad, STEP_S)
    axles = push(s, car, angle, STEP_S)
    line = turn(s, car, request, axles, STEP_S)
    motion = move(body, s, axles.force_x_n, axles.force_y_n, axles.moment_nm, STEP_S)
    torque = hand_wheel_torque(
        body,
        axles.front.force_y_n,
        axles.front.grip,
        line.shafts.wheel_radps * car.front.radius_m,
        (angle - s.road_wheel_rad) / STEP_S,
    )
    share = STEP_S / (body.sway_s + STEP_S)
    return CarState(
        motion.x_m,
        motion.y_m,
        wrap_angle(motion.yaw_rad),
        motion.vx_mps,
        motion.vy_mps,
        motion.yaw_rate_radps,
        motion.ax_mps2,
        motion.ay_mps2,
        s.transfer_ax_mps2 + share * (axles.force_x_n / body.mass_kg - s.transfer_ax_mps2),
        s.lean_ay_mps2 + share * (axles.force_y_n / body.mass_kg - s.lean_ay_mps2),
        angle,
        line.shafts.wheel_radps,
        line.rear_wheel_radps,
        axles.front.deflection_x_m,
        axles.front.deflection_y_m,
        axles.rear.deflection_x_m,
        axles.rear.deflection_y_m,
        torque,
        line.shafts.engine_radps,
        line.engine_running,
        line.shafts.engine_impulse_nms,
        line.shafts.clutch_impulse_nms,
        line.shafts.brake_impulse_nms,
        line.box.gear,
        line.box.clutch,
        line.box.lever_adopted,
        line.box.wanted_gear,
        line.box.shift_left_s,
        line.box.since_shift_s,
        motion.distance_m,
    )
