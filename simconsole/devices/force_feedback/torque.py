"""Torque of the wheel's motor: the car's torque and the wheel's own effects, or the servo that follows the road wheels.

Pure kernels. The torque goes to 0 at once, and comes back slowly, when the wheel is not trusted, the mode is one in
which nobody is driven, the loop has stood still, or any part is not finite.
"""

from typing import Final, NamedTuple

from simconsole.devices.force_feedback.aligning import FAST_MPS, aligning, answered, share_of, stiffness
from simconsole.devices.force_feedback.estimator import WheelEstimate, at_rest, observe
from simconsole.devices.force_feedback.force_settings import ForceSettings
from simconsole.devices.force_feedback.guidance import GuidanceReference, guidance, guidance_reference
from simconsole.devices.force_feedback.pipe import ahead, delivered, filled
from simconsole.devices.force_feedback.rim import Rim, turn
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
from simconsole.values.trigonometry import sin
from simconsole.values.validity import is_trusted

_STANDING: Final = int(Event.LOOP_STALL | Event.PAUSE)

FRICTION_RADPS: Final = 1.0
"""Rate over which simulated friction changes its sign; a steeper change would chatter due to the motor's delay."""
END_STOP_NMS: Final = 1.0
RESTING_S: Final = 0.05
"""Time constant with which the model follows a wheel with resting hands: that with which the estimate detects them."""
CARRIED_NMPS: Final = 2.0
"""How fast a torque that was held at engagement must go: hands let go of a bend within a second or two."""
CENTRING_RADPS: Final = 2.0
"""How fast the motor centres the wheel before a restart: a turn in 3 s, which hands that rest on it can follow."""
CENTRING_LEAD_RAD: Final = 0.15
"""Largest lead of the centring target over the wheel: a held wheel gets at most this times the servo's stiffness."""
LONG_WAVE_RADPM: Final = 3.7
SHORT_WAVE_RADPM: Final = 9.97
"""Two waves of rough road, 1.7 m and 0.63 m long: 6 to 32 Hz between 36 and 72 km/h, incommensurable."""


class TorqueParts(NamedTuple):
    """What the torque is made of."""

    car_nm: float
    servo_nm: float
    guide_nm: float
    effects_nm: float  # damping, friction, end stop, road
    car_share: float  # of the car's torque that the motor bears


class WheelTarget(NamedTuple):
    """The wheel's target position."""

    known: bool  # all inputs of the target and of the torque are finite
    rim: Rim  # where the road wheels are: the servo goes there
    asked: GuidanceReference  # where the controller would have the person's hands


class UnattendedWheel(NamedTuple):
    """The wheel as the motor alone would have it."""

    rad: float
    radps: float
    motor_nm: float
    explained_rad: float  # moved since the person may take over
    explained_radps: float


@kernel
def servo(target: Rim, rim: Rim, force: ForceSettings) -> float:
    """Return the torque in N m that brings the rim to a target that moves itself (PD on the angle)."""
    return force.servo_nm_per_rad * (target.rad - rim.rad) + force.servo_damping_nms * (target.radps - rim.radps)


@kernel
def soft_clip(torque_nm: float, force: ForceSettings) -> float:
    """Return the torque below the motor's limit: unchanged up to the knee, then compressed, so that detail is kept.

    Beyond the knee k, with room r above it: k + r x / (r + x) for an excess x; continuous in value and slope.
    """
    knee = force.soft_clip_from * force.max_torque_nm
    size = abs(torque_nm)
    if size <= knee:
        return torque_nm
    room = force.max_torque_nm - knee
    bent = knee + room * (size - knee) / (room + size - knee)
    return bent if torque_nm > 0.0 else -bent


@kernel
def end_stop(rim: Rim, force: ForceSettings) -> float:
    """Return the spring at the lock: nothing inside it, and no pull back out of it when the rim already returns."""
    beyond = abs(rim.rad) - force.end_stop_rad
    if beyond <= 0.0:
        return 0.0
    side = 1.0 if rim.rad > 0.0 else -1.0
    outwards = side * rim.radps
    push = force.end_stop_nm_per_rad * beyond + (END_STOP_NMS * outwards if outwards > 0.0 else 0.0)
    return -side * push


@kernel
def road(vehicle: VehicleState, rolling: float, force: ForceSettings) -> float:
    """Return the torque of the road's texture: a function of distance only, so it rests with the car and replays."""
    waves = sin(LONG_WAVE_RADPM * vehicle.distance_m) + sin(SHORT_WAVE_RADPM * vehicle.distance_m)
    return 0.5 * force.texture_nm * rolling * waves


@kernel
def torque_parts(
    follows: bool,
    target: Rim,
    rim: Rim,
    vehicle: VehicleState,
    asked: GuidanceReference,
    share: float,
    by_hand: float,
    answered_rad: float,
    swing_radps: float,
    force: ForceSettings,
) -> TorqueParts:
    """Return the parts of the torque, unlimited.

    Args:
        follows: The wheel is to follow the road wheels; else it is the car's.
        target: Where the road wheels have it.
        rim: The wheel when this torque acts on it.
        vehicle: The vehicle after this tick.
        asked: What the controller asks of the hand wheel.
        share: How much of its guidance there is, 0 to 1.
        by_hand: How much of the road wheels' angle is the hand wheel's, 0 to 1; the rest is the controller's.
        answered_rad: Of that part, what the car's tyres have answered, at the hand wheel.
        swing_radps: The car's yaw rate, less its slow part.
        force: Of this drive.
    """
    speed = abs(vehicle.vx_mps)
    rolling = speed / (speed + force.fade_mps)
    texture = road(vehicle, rolling, force)
    if follows:
        return TorqueParts(0.0, servo(target, rim, force), 0.0, texture, 0.0)
    friction = force.friction_nm + (1.0 - rolling) * force.standstill_friction_nm
    drag = -force.damping_nms * rim.radps - friction * rim.radps / (abs(rim.radps) + FRICTION_RADPS)
    stiff = force.car_share * rolling * stiffness(speed, force)
    fast = speed / FAST_MPS
    bears = share_of(stiff, fast, force)
    felt = by_hand * bears
    car = aligning(
        felt * force.car_share * rolling * vehicle.hand_wheel_torque_nm,
        by_hand * rim.rad - answered_rad,
        swing_radps,
        rim.radps,
        felt * stiff,
        fast,
        share,
        force,
    )
    guide = guidance(asked, rim, rolling, share, force)
    return TorqueParts(car, 0.0, guide, drag + end_stop(rim, force) + texture, bears)


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
    known = known and is_finite(arbitration.remote_road_wheel_rad)
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
    drawn to the wheel's real angle. So a take-over needs both, the angle and a person's torque.

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
    if abs(estimated.human_nm) < share * force.resting_hands_nm:
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
    hands_rad = vehicle.road_wheel_rad - arbitration.remote_lateral * arbitration.remote_road_wheel_rad
    answered_rad = memory.answered_rad
    if target.known:
        start_rad = answered_rad if memory.live > 0.0 else hands_rad * force.hand_wheel_per_road_wheel
        answered_rad = answered(start_rad, hands_rad, abs(vehicle.vx_mps), force, tick_s)
    yaw_radps = memory.yaw_radps
    if target.known:
        yaw_radps += (vehicle.yaw_rate_radps - yaw_radps) * (tick_s / (tick_s + force.yaw_slow_s))
    swing_radps = vehicle.yaw_rate_radps - yaw_radps if target.known else 0.0
    torque = WheelTorque(
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
    if enabled:
        guided = arbitration.remote_guidance if mode == Mode.SHARED else 0.0
        by_hand = 1.0 - arbitration.remote_lateral
        parts = torque_parts(
            follows, target.rim, rim, vehicle, target.asked, guided, by_hand, answered_rad, swing_radps, force
        )
        torque = limited_torque(parts, ramp, estimated, before, force)
    share = ramp if follows else 0.0
    unattended = unattended_motion(
        driver, estimated, target.rim, share, watching, live, memory, force, rate_filter_s, tick_s
    )
    return (
        torque,
        WheelMemory(
            live=wheel_motor if live else 0.0,
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
            answered_rad=answered_rad,
            yaw_radps=yaw_radps,
            carried_nm=carried(memory.carried_nm, estimated.human_nm, watching, tick_s),
        ),
        pipe,
    )
