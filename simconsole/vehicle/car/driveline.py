"""From pedals and lever to the shafts: gearbox, engine, clutch and brakes of one step, in their order."""

from typing import Final, NamedTuple

from simconsole.values.kernels import clip, kernel
from simconsole.values.signals import Request
from simconsole.vehicle.car.aids import Brakes, brake_torques, hill_hold, stability, traction
from simconsole.vehicle.car.axles import Axles, Contact
from simconsole.vehicle.car.engine import EngineDrive, engine_drive, net_torque, torques_at
from simconsole.vehicle.car.gearbox import COOLED, Turning, bite, gear_ratio, gearbox_step, matched_throttle
from simconsole.vehicle.car.parameters import AxleParameters, CarParameters, GearParameters
from simconsole.vehicle.car.powertrain import Capacity, Inertia, Shafts, braked, solve_shafts
from simconsole.vehicle.car.state import AidState, Car, Gearbox, ShaftState, Wheel

ANTI_STALL_FROM: Final = 0.55
ANTI_STALL_TO: Final = 0.75
"""Shares of idle speed between which the automatic's clutch opens at once, however slow its actuator is."""

BURNT: Final = 2.0
"""Heat beyond which a clutch becomes no hotter: there is nothing left of it to wear."""


class Driveline(NamedTuple):
    """Everything that turns, after one step."""

    box: Gearbox
    shafts: ShaftState
    brakes: Brakes
    aids: AidState
    fl_radps: float
    fr_radps: float
    rl_radps: float
    rr_radps: float


@kernel
def clutch_torque(engine_radps: float, car: CarParameters, box: Gearbox) -> float:
    """Return what the clutch can transmit in N m: nothing in neutral, less where the automatic saves the engine."""
    if box.gear == 0.0:
        return 0.0
    torque = bite(car.gears, box.clutch) * car.gears.clutch_nm
    if box.lever_adopted != 0.0:
        return torque
    turning = engine_radps * car.engine.per_idle_radps
    return torque * clip((turning - ANTI_STALL_FROM) * (1.0 / (ANTI_STALL_TO - ANTI_STALL_FROM)), 0.0, 1.0)


@kernel
def spun(axle: AxleParameters, wheel: Wheel, on_ground: Contact, step_s: float) -> float:
    """Return the spin of a wheel after its tyre's force, before its brake."""
    return wheel.radps - on_ground.tyre.force_x_n * (step_s * axle.spin_radps_per_newton_second)


@kernel
def friction_nms(axle: AxleParameters, brake_nm: float, on_ground: Contact, step_s: float) -> float:
    """Return the capacity of brake and rolling resistance in a step: both are a friction on the wheel."""
    return step_s * (brake_nm + axle.rolling_resistance * on_ground.load_n * axle.radius_m)


@kernel
def driveline_step(car: Car, p: CarParameters, request: Request, axles: Axles, step_s: float) -> Driveline:
    """Return the driveline one step later, under the tyre forces of `axles`."""
    at_rear = p.gears.rear_driven != 0.0
    before = car.shafts
    mean = 0.5 * (car.rl.radps + car.rr.radps) if at_rear else 0.5 * (car.fl.radps + car.fr.radps)
    driven_axle = p.rear if at_rear else p.front
    left = axles.rl if at_rear else axles.fl
    right = axles.rr if at_rear else axles.fr
    can = torques_at(p.engine, before.engine_radps)
    left_over = traction(car, p, request, can, driven_axle, left, right, mean)
    automatic_nm = 0.0
    if request.automatic != 0.0 or car.box.lever_adopted == 0.0:
        automatic_nm = net_torque(can, before.engine_running, left_over.throttle)
    turning = Turning(
        engine_radps=before.engine_radps,
        wheel_radps=mean,
        vx_mps=car.body.vx_mps,
        asked_nm=automatic_nm,
        most_nm=left_over.clutch_nm,
        hot=before.clutch_hot,
    )
    box = gearbox_step(p.gears, car.box, request, turning, step_s)
    clutch_nm = clutch_torque(before.engine_radps, p, box)
    ratio = gear_ratio(p.gears, box.gear)
    held = hill_hold(car, p, request, axles, ratio, step_s)
    aids = AidState(left_over.share, stability(car, p, request.handbrake, step_s), held.hold_left_s, held.hold_brake)
    brakes = brake_torques(car, p, request, axles, aids, step_s)
    throttle = matched_throttle(p.gears, box, left_over.throttle, before.engine_radps, mean)
    drive = engine_drive(p.engine, can, before.engine_radps, before.engine_running, throttle, clutch_nm == 0.0)
    fl = spun(p.front, car.fl, axles.fl, step_s)
    fr = spun(p.front, car.fr, axles.fr, step_s)
    rl = spun(p.rear, car.rl, axles.rl, step_s)
    rr = spun(p.rear, car.rr, axles.rr, step_s)
    hand_nm = request.handbrake * p.rear.handbrake_nm
    fl_nms = friction_nms(p.front, brakes.fl_nm, axles.fl, step_s)
    fr_nms = friction_nms(p.front, brakes.fr_nm, axles.fr, step_s)
    rl_nms = friction_nms(p.rear, brakes.rl_nm + hand_nm, axles.rl, step_s)
    rr_nms = friction_nms(p.rear, brakes.rr_nm + hand_nm, axles.rr, step_s)
    gears_nms = 0.5 * p.gears.loss_share * abs(ratio * before.clutch_impulse_nms)
    most = Capacity(
        engine_nms=step_s * drive.friction_nm,
        clutch_nms=step_s * clutch_nm,
        left_nms=(rl_nms if at_rear else fl_nms) + gears_nms,
        right_nms=(rr_nms if at_rear else fr_nms) + gears_nms,
        lock_nms=step_s * p.gears.lock_nm,
        lock_share=p.gears.lock_share,
    )
    shafts = shafts_step(car, p, drive, rl if at_rear else fl, rr if at_rear else fr, ratio, most, step_s)
    if at_rear:
        rl = shafts.left_radps
        rr = shafts.right_radps
        fl = braked(fl, p.front.per_wheel_inertia_kgm2, fl_nms)
        fr = braked(fr, p.front.per_wheel_inertia_kgm2, fr_nms)
    else:
        fl = shafts.left_radps
        fr = shafts.right_radps
        rl = braked(rl, p.rear.per_wheel_inertia_kgm2, rl_nms)
        rr = braked(rr, p.rear.per_wheel_inertia_kgm2, rr_nms)
    kept = shaft_state(before, p.gears, shafts, ratio, drive.running, step_s)
    return Driveline(box=box, shafts=kept, brakes=brakes, aids=aids, fl_radps=fl, fr_radps=fr, rl_radps=rl, rr_radps=rr)


@kernel
def shaft_state(
    before: ShaftState, p: GearParameters, shafts: Shafts, ratio: float, running: float, step_s: float
) -> ShaftState:
    """Return what stays of the shafts for the next step, with the heat that the slipping clutch has got."""
    slip = shafts.engine_radps - 0.5 * ratio * (shafts.left_radps + shafts.right_radps)
    worn_j = abs(shafts.clutch_impulse_nms * slip)
    cooled = before.clutch_heat * (1.0 - step_s * p.cooling_per_s)
    heat = clip(cooled + p.heat_per_j * worn_j, 0.0, BURNT)
    return ShaftState(
        engine_radps=shafts.engine_radps,
        engine_running=running,
        engine_impulse_nms=shafts.engine_impulse_nms,
        clutch_impulse_nms=shafts.clutch_impulse_nms,
        left_impulse_nms=shafts.left_impulse_nms,
        right_impulse_nms=shafts.right_impulse_nms,
        lock_impulse_nms=shafts.lock_impulse_nms,
        clutch_heat=heat,
        clutch_hot=1.0 if heat >= 1.0 or (before.clutch_hot != 0.0 and heat > COOLED) else 0.0,
    )


@kernel
def shafts_step(
    car: Car,
    p: CarParameters,
    drive: EngineDrive,
    left_radps: float,
    right_radps: float,
    ratio: float,
    most: Capacity,
    step_s: float,
) -> Shafts:
    """Return engine and driven wheels one step later."""
    s = car.shafts
    driven = p.rear if p.gears.rear_driven != 0.0 else p.front
    speeds = Shafts(
        engine_radps=s.engine_radps + drive.torque_nm * (step_s * p.engine.per_inertia_kgm2),
        left_radps=left_radps,
        right_radps=right_radps,
        engine_impulse_nms=s.engine_impulse_nms,
        clutch_impulse_nms=s.clutch_impulse_nms,
        left_impulse_nms=s.left_impulse_nms,
        right_impulse_nms=s.right_impulse_nms,
        lock_impulse_nms=s.lock_impulse_nms,
    )
    flywheel = Inertia(p.engine.inertia_kgm2, p.engine.per_inertia_kgm2)
    wheel = Inertia(driven.wheel_inertia_kgm2, driven.per_wheel_inertia_kgm2)
    return solve_shafts(speeds, ratio, flywheel, wheel, most)
