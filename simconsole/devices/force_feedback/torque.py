"""Torque of the wheel's motor: the car's torque and the wheel's own effects, or the servo that follows the road wheels.

Pure kernels. The torque goes to 0 at once, and comes back slowly, when the wheel is not trusted, the mode is one in
which nobody is driven, the loop has stood still, or any part is not finite.
"""

from typing import Final, NamedTuple

from simconsole.devices.force_feedback.aligning import answered
from simconsole.devices.force_feedback.estimator import WheelEstimate, at_rest, observe
from simconsole.devices.force_feedback.force_settings import ForceSettings
from simconsole.devices.force_feedback.guidance import GuidanceReference, guidance_reference
from simconsole.devices.force_feedback.pipe import ahead, delivered, filled
from simconsole.devices.force_feedback.rim import Rim, turn
from simconsole.devices.force_feedback.torque_parts import TorqueParts, servo, soft_clip, torque_parts
from simconsole.values.kernels import approach, clip, is_finite, kernel
from simconsole.values.signals import (
    Arbitration,
    DriverInput,
    Event,
    Mode,
    MotorPipe,
    Notice,
    VehicleState,
    WheelMemory,
    WheelTorque,
)
from simconsole.values.validity import is_trusted, wilful_torque

_STANDING: Final = int(Event.LOOP_STALL | Event.PAUSE)

RESTING_S: Final = 0.05
"""Time constant with which the model follows a wheel with resting hands: that with which the estimate detects them."""
CARRIED_NMPS: Final = 2.0
"""How fast a torque that was held at engagement must go: hands let go of a bend within a second or two."""
CENTRING_RADPS: Final = 2.0
"""How fast the motor centres the wheel before a restart: a turn in 3 s, which hands that rest on it can follow."""
CENTRING_LEAD_RAD: Final = 0.15
"""Largest lead of the centring target over the wheel: a held wheel gets at most this times the servo's stiffness."""


class WheelTarget(NamedTuple):
    """The wheel's target position."""

    known: bool  # all inputs of the target and of the torque are finite
    rim: Rim  # where the road wheels are: the servo goes there
    asked: GuidanceReference  # where the controller would have the person's hands


class CarAnswer(NamedTuple):
    """How far the car has come after what it is steered by."""

    answered_rad: float  # of the hand wheel's angle, what the tyres have answered
    yaw_radps: float  # slow part of its yaw rate
    swing_radps: float  # the rest of it


class UnattendedWheel(NamedTuple):
    """The wheel as the motor alone would have it."""

    rad: float
    radps: float
    motor_nm: float
    explained_rad: float  # moved since the person may take over
    explained_radps: float


@kernel
def estimate(
    driver: DriverInput,
    live: bool,
    motor_nm: float,
    before: WheelTorque,
    memory: WheelMemory,
    force: ForceSettings,
    tick_s: float,
) -> WheelEstimate:
    """Return the wheel's motion and the person's torque; a wheel whose motor comes back starts at rest, hands off."""
    if not live or memory.live <= 0.0:
        return at_rest(driver.hand_wheel_rad)
    known = WheelEstimate(memory.wheel_rad, memory.wheel_radps, before.human_nm, memory.hands_nm, before.hands_on)
    return observe(known, driver.hand_wheel_rad, motor_nm, force, tick_s)


@kernel
def centring(arbitration: Arbitration) -> bool:
    """Return whether the wheel is to be centred, and to be held there until the pedals are released."""
    return arbitration.notice in (Notice.CENTRING_WHEEL, Notice.RELEASE_PEDALS)


@kernel
def wheel_target(
    arbitration: Arbitration,
    vehicle: VehicleState,
    estimated: WheelEstimate,
    memory: WheelMemory,
    force: ForceSettings,
    tick_s: float,
) -> WheelTarget:
    """Return the wheel's target; where an input is not finite, the last target with `known` False."""
    lock = force.end_stop_rad
    wanted_rad = vehicle.road_wheel_rad * force.hand_wheel_per_road_wheel
    known = is_finite(wanted_rad) and is_finite(vehicle.hand_wheel_torque_nm) and is_finite(vehicle.vx_mps)
    known = known and is_finite(vehicle.distance_m) and is_finite(estimated.rad) and is_finite(estimated.radps)
    known = known and is_finite(arbitration.remote_road_wheel_rad) and is_finite(vehicle.yaw_rate_radps)
    if not known:
        return WheelTarget(False, Rim(memory.target_rad, 0.0), GuidanceReference(0.0, 0.0))
    asked = guidance_reference(arbitration.remote_road_wheel_rad, memory.guide_rad, arbitration.mode, force, tick_s)
    if centring(arbitration):
        start = clip(memory.target_rad, estimated.rad - CENTRING_LEAD_RAD, estimated.rad + CENTRING_LEAD_RAD)
        centred = approach(start, 0.0, CENTRING_RADPS * tick_s)
        return WheelTarget(True, Rim(centred, (centred - start) / tick_s), asked)
    target_rad = clip(wanted_rad, -lock, lock)
    radps = (target_rad - memory.target_rad) / tick_s if memory.live > 0.0 else 0.0
    return WheelTarget(True, Rim(target_rad, radps), asked)


@kernel
def car_answer(
    arbitration: Arbitration,
    vehicle: VehicleState,
    known: bool,
    memory: WheelMemory,
    force: ForceSettings,
    tick_s: float,
) -> CarAnswer:
    """Return how far the car has come; as in the tick before, and steady, where an input is not finite."""
    if not known:
        return CarAnswer(memory.answered_rad, memory.yaw_radps, 0.0)
    hands_rad = vehicle.road_wheel_rad - arbitration.remote_lateral * arbitration.remote_road_wheel_rad
    start_rad = memory.answered_rad if memory.live > 0.0 else hands_rad * force.hand_wheel_per_road_wheel
    slow_radps = memory.yaw_radps
    slow_radps += (vehicle.yaw_rate_radps - slow_radps) * (tick_s / (tick_s + force.yaw_slow_s))
    return CarAnswer(
        answered_rad=answered(start_rad, hands_rad, abs(vehicle.vx_mps), force, tick_s),
        yaw_radps=slow_radps,
        swing_radps=vehicle.yaw_rate_radps - slow_radps,
    )


@kernel
def let_go(estimated: WheelEstimate) -> WheelTorque:
    """Return no torque at all, beside what is known of the person's."""
    return WheelTorque(
        torque_nm=0.0,
        car_nm=0.0,
        servo_nm=0.0,
        guide_nm=0.0,
        ramp=0.0,
        clipped=0.0,
        enabled=0.0,
        human_nm=estimated.human_nm,
        hands_on=estimated.hands_on,
        car_share=0.0,
    )


@kernel
def limited_torque(
    parts: TorqueParts, ramp: float, estimated: WheelEstimate, before: WheelTorque, force: ForceSettings
) -> WheelTorque:
    """Return the torque that the motor is asked for: within its limit, coming in slowly and never in steps."""
    raw_nm = parts.car_nm + parts.servo_nm + parts.guide_nm + parts.effects_nm
    wished_nm = ramp * soft_clip(raw_nm, force)
    return WheelTorque(
        torque_nm=approach(before.torque_nm, wished_nm, force.slew_nm),
        car_nm=parts.car_nm,
        servo_nm=parts.servo_nm,
        guide_nm=parts.guide_nm,
        ramp=ramp,
        clipped=1.0 if abs(raw_nm) > force.max_torque_nm else 0.0,
        enabled=1.0,
        human_nm=estimated.human_nm,
        hands_on=estimated.hands_on,
        car_share=parts.car_share,
    )


@kernel
def driven_torque(
    arbitration: Arbitration,
    follows: bool,
    target: WheelTarget,
    rim: Rim,
    vehicle: VehicleState,
    answer: CarAnswer,
    ramp: float,
    estimated: WheelEstimate,
    before: WheelTorque,
    force: ForceSettings,
) -> WheelTorque:
    """Return the torque while somebody drives; `rim` is the wheel when this torque acts."""
    guided = arbitration.remote_guidance if arbitration.mode == Mode.SHARED else 0.0
    by_hand = 1.0 - arbitration.remote_lateral
    answered_rad, swing_radps = answer.answered_rad, answer.swing_radps
    parts = torque_parts(
        follows, target.rim, rim, vehicle, target.asked, guided, by_hand, answered_rad, swing_radps, force
    )
    return limited_torque(parts, ramp, estimated, before, force)


@kernel
def unattended_motion(
    driver: DriverInput,
    estimated: WheelEstimate,
    target: Rim,
    share: float,
    watching: bool,
    live: bool,
    before: WheelMemory,
    force: ForceSettings,
    rate_filter_s: float,
    tick_s: float,
) -> UnattendedWheel:
    """Return where the motor alone would have the wheel: the rim under a servo of its own, with nobody at it.

    Hands that only rest on the rim add drag and inertia: while the person's torque is no more than that, the model is
    drawn to the wheel's real angle, however fast the motor turns it. So a take-over needs both, the angle and a
    person's torque.

    Args:
        driver: Angle and rate read now.
        estimated: Rate and the person's torque, estimated.
        target: Where the servo goes.
        share: How far the servo is in force, 0 (let go) to 1.
        watching: Whether it matters; if not, the model follows the wheel and explains nothing.
        live: Whether there is a wheel with a motor; without one the motor alone moves nothing.
        before: From the tick before.
        force: Of this drive.
        rate_filter_s: First-order filter of the rate.
        tick_s: Length of a tick.
    """
    if not watching:
        return UnattendedWheel(driver.hand_wheel_rad, estimated.radps, 0.0, 0.0, 0.0)
    if not live:
        return UnattendedWheel(driver.hand_wheel_rad, 0.0, 0.0, before.explained_rad, 0.0)
    start = Rim(before.model_rad, before.model_radps) if before.live > 0.0 else Rim(driver.hand_wheel_rad, 0.0)
    asked_nm = share * soft_clip(servo(target, start, force), force)
    motor_nm = before.model_nm + force.motor_lag_share * (asked_nm - before.model_nm)
    rim = turn(start, motor_nm, force.inertia_kgm2, force.motor_damping_nms, force.motor_friction_nm, tick_s)
    smooth = tick_s / (tick_s + rate_filter_s)
    explained_radps = before.explained_radps + smooth * (rim.radps - before.explained_radps)
    radps2 = (estimated.radps - before.wheel_radps) / tick_s if before.live > 0.0 else 0.0
    if wilful_torque(estimated.human_nm, radps2) < share * force.resting_hands_nm:
        go = tick_s / (tick_s + RESTING_S)
        rim = Rim(rim.rad + go * (estimated.rad - rim.rad), rim.radps + go * (estimated.radps - rim.radps))
        explained_radps = driver.hand_wheel_radps
    return UnattendedWheel(rim.rad, rim.radps, motor_nm, before.explained_rad + (rim.rad - start.rad), explained_radps)


@kernel
def carried(before_nm: float, human_nm: float, watching: bool, tick_s: float) -> float:
    """Return how much of the person's torque is no take-over: what they held as they engaged, while it fades.

    Args:
        before_nm: In the tick before.
        human_nm: The person's torque, estimated.
        watching: Whether the person may take over.
        tick_s: Length of a tick.
    """
    if not watching:
        return abs(human_nm)
    return clip(before_nm - CARRIED_NMPS * tick_s, 0.0, abs(human_nm))


@kernel
def remembered(
    live: float,
    estimated: WheelEstimate,
    motor_nm: float,
    target: WheelTarget,
    unattended: UnattendedWheel,
    answer: CarAnswer,
    carried_nm: float,
) -> WheelMemory:
    """Return what the next tick must know of this one."""
    return WheelMemory(
        live=live,
        wheel_rad=estimated.rad,
        wheel_radps=estimated.radps,
        motor_nm=motor_nm,
        hands_nm=estimated.hands_nm,
        target_rad=target.rim.rad,
        model_rad=unattended.rad,
        model_radps=unattended.radps,
        model_nm=unattended.motor_nm,
        explained_rad=unattended.explained_rad,
        explained_radps=unattended.explained_radps,
        guide_rad=target.asked.slow_rad,
        answered_rad=answer.answered_rad,
        yaw_radps=answer.yaw_radps,
        carried_nm=carried_nm,
    )


@kernel
def wheel_torque(
    driver: DriverInput,
    wheel_motor: float,
    arbitration: Arbitration,
    watching: bool,
    events: float,
    vehicle: VehicleState,
    before: WheelTorque,
    memory: WheelMemory,
    pipe_before: MotorPipe,
    force: ForceSettings,
    rate_filter_s: float,
    tick_s: float,
) -> tuple[WheelTorque, WheelMemory, MotorPipe]:
    """Return the motor's torque for the coming tick, and what must be remembered.

    Args:
        driver: The person, calibrated.
        wheel_motor: 1 while the wheel's motor obeys.
        arbitration: Who drives, and what the controller asks for.
        watching: Whether the person may take over by moving the wheel: then the motor's own motion is followed.
        events: Edges of this tick.
        vehicle: The vehicle after this tick.
        before: Torque of the tick before.
        memory: From the tick before.
        pipe_before: What was on its way to the motor in the tick before.
        force: Of this drive, with a motor.
        rate_filter_s: Of the rate in `driver`: the explained rate is filtered alike.
        tick_s: Length of a tick.
    """
    mode = arbitration.mode
    live = wheel_motor > 0.0 and is_trusted(driver.wheel_validity)
    motor_nm = delivered(pipe_before, before.torque_nm, force)
    pipe = filled(pipe_before, before.torque_nm, force)
    estimated = estimate(driver, live, motor_nm, before, memory, force, tick_s)
    rim = ahead(Rim(estimated.rad, estimated.radps), estimated.human_nm, pipe, force)
    follows = mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED) or centring(arbitration)
    target = wheel_target(arbitration, vehicle, estimated, memory, force, tick_s)
    driven = follows or mode in (Mode.MANUAL, Mode.SHARED)
    enabled = live and target.known and driven and int(events) & _STANDING == 0
    ramp = approach(before.ramp, 1.0, force.ramp_per_tick) if enabled else 0.0
    answer = car_answer(arbitration, vehicle, target.known, memory, force, tick_s)
    torque = let_go(estimated)
    if enabled:
        torque = driven_torque(arbitration, follows, target, rim, vehicle, answer, ramp, estimated, before, force)
    share = ramp if follows else 0.0
    unattended = unattended_motion(
        driver, estimated, target.rim, share, watching, live, memory, force, rate_filter_s, tick_s
    )
    held_nm = carried(memory.carried_nm, estimated.human_nm, watching, tick_s)
    alive = wheel_motor if live else 0.0
    return torque, remembered(alive, estimated, motor_nm, target, unattended, answer, held_nm), pipe
