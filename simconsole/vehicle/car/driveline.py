"""From pedals and lever to the shafts: gearbox, engine, clutch and brakes of one step, in their order."""

from typing import Final, NamedTuple

from simconsole.kernels import clip, kernel
from simconsole.signals import Request
from simconsole.vehicle.car.axles import Axles
from simconsole.vehicle.car.engine import EngineDrive, engine_drive
from simconsole.vehicle.car.gearbox import Gearbox, bite, gear_ratio, matched_throttle, work_gearbox
from simconsole.vehicle.car.parameters import CarParameters
from simconsole.vehicle.car.powertrain import Shafts, braked, solve_shafts
from simconsole.vehicle.car.state import CarState

ANTI_STALL_FROM: Final = 0.6
ANTI_STALL_TO: Final = 0.9
"""Shares of idle speed between which the automatic's clutch gives way at once, whatever its actuator does."""


class Driveline(NamedTuple):
    """Everything that turns, after one step."""

    box: Gearbox
    engine_running: float
    shafts: Shafts
    rear_wheel_radps: float


@kernel
def clutch_torque(s: CarState, car: CarParameters, box: Gearbox) -> float:
    """Return what the clutch can transmit in N m: nothing in neutral, less where the automatic saves the engine."""
    if box.gear == 0.0:
        return 0.0
    torque = bite(car.gears, box.clutch) * car.gears.clutch_nm
    if box.lever_adopted != 0.0:
        return torque
    turning = s.engine_radps / car.engine.idle_radps
    return torque * clip((turning - ANTI_STALL_FROM) / (ANTI_STALL_TO - ANTI_STALL_FROM), 0.0, 1.0)


@kernel
def turn(s: CarState, car: CarParameters, request: Request, axles: Axles, step_s: float) -> Driveline:
    """Return the driveline one step later, under the tyre forces of `axles`."""
    box = work_gearbox(
        car.gears,
        Gearbox(s.gear, s.clutch, s.lever_adopted, s.wanted_gear, s.shift_left_s, s.since_shift_s),
        request,
        s.engine_radps,
        s.front_wheel_radps,
        s.vx_mps,
        step_s,
    )
    clutch_nm = clutch_torque(s, car, box)
    throttle = matched_throttle(car.gears, box, request.throttle, s.engine_radps, s.front_wheel_radps)
    drive = engine_drive(car.engine, s.engine_radps, s.engine_running, throttle, clutch_nm == 0.0)
    shafts = turn_front(s, car, request, axles, drive, gear_ratio(car.gears, box.gear), clutch_nm, step_s)
    rear = car.rear
    rear_nm = request.brake * rear.brake_nm + request.handbrake * rear.handbrake_nm
    rear_wheel = braked(
        s.rear_wheel_radps - step_s * axles.rear.force_x_n * rear.radius_m / rear.wheel_inertia_kgm2,
        rear.wheel_inertia_kgm2,
        step_s * (rear_nm + rear.rolling_resistance * axles.rear_load_n * rear.radius_m),
    )
    return Driveline(box, drive.running, shafts, rear_wheel)


@kernel
def turn_front(
    s: CarState,
    car: CarParameters,
    request: Request,
    axles: Axles,
    drive: EngineDrive,
    ratio: float,
    clutch_nm: float,
    step_s: float,
) -> Shafts:
    """Return engine and front wheels one step later. Rolling resistance is a friction on the wheel, like the brake."""
    front = car.front
    brake_nm = request.brake * front.brake_nm + request.handbrake * front.handbrake_nm
    return solve_shafts(
        s.engine_radps + step_s * drive.torque_nm / car.engine.inertia_kgm2,
        s.front_wheel_radps - step_s * axles.front.force_x_n * front.radius_m / front.wheel_inertia_kgm2,
        ratio,
        car.engine.inertia_kgm2,
        front.wheel_inertia_kgm2,
        step_s * drive.friction_nm,
        step_s * clutch_nm,
        step_s * (brake_nm + front.rolling_resistance * axles.front_load_n * front.radius_m),
        s.engine_impulse_nms,
        s.clutch_impulse_nms,
        s.brake_impulse_nms,
    )
