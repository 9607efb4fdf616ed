"""The last gate: what no path, manual, autonomous or emergency, may exceed on its way to the vehicle.

Order: finite, range, lateral acceleration, then jerk and rate. Finiteness comes first because a NaN passes every
comparison. The rate limit comes last and therefore wins: no value ever jumps, not even back into a range that has just
become narrower. Throttle is the exception downwards: with the brake pressed or in a stop it is cut at once.
"""

from typing import Final, NamedTuple

from simconsole.control.requests.angles import limited_angle, limited_step
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.longitudinal import finite_or
from simconsole.values.kernels import approach, clip, is_finite, kernel
from simconsole.values.signals import (
    NEVER_TICKS,
    Arbitration,
    Event,
    GateLimit,
    Mode,
    RemoteCommand,
    RemoteKind,
    Request,
    VehicleCommand,
    VehicleState,
)

_SAFE_BRAKE: Final = 0.3
"""Replaces a brake request that is not finite: slows any car, locks the wheels of none on a dry road."""
_MOST_YAW_RAD: Final = 1000.0
_MOST_YAW_RADPS: Final = 20.0


class Limits(NamedTuple):
    """What the gate lets pass in one mode. A lateral acceleration or jerk of 0 is no limit."""

    road_wheel_rad: float
    road_wheel_radps: float
    lateral_accel_mps2: float
    lateral_jerk_mps3: float
    throttle_slew_per_s: float
    brake_slew_per_s: float
    target_accel_mps2: float


class Passed(NamedTuple):
    """One value after the gate, and the `GateLimit` bits that changed it."""

    value: float
    active: int


class Pose(NamedTuple):
    """A desired pose after the gate."""

    x_m: float
    y_m: float
    yaw_rad: float
    active: int


class Target(NamedTuple):
    """A desired speed and pose after the gate."""

    speed_mps: float
    x_m: float
    y_m: float
    yaw_rad: float
    yaw_rate_radps: float
    active: int


@kernel
def limits_of(mode: float, settings: ControlSettings) -> Limits:
    """Return the limits of a mode. A person's hands and feet are never noticeably held back, also in SHARED.

    In MANUAL and SHARED the wheel passes in the same tick up to the steering lock and a rate that no hand reaches;
    lateral acceleration and jerk are free: catching a skid or swerving needs more of both than any comfort limit has.
    """
    slew = settings.manual_pedal_slew_per_s
    if mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED):
        return Limits(
            road_wheel_rad=settings.automatic_road_wheel_rad,
            road_wheel_radps=settings.automatic_road_wheel_radps,
            lateral_accel_mps2=settings.automatic_lateral_accel_mps2,
            lateral_jerk_mps3=settings.automatic_lateral_jerk_mps3,
            throttle_slew_per_s=settings.automatic_throttle_slew_per_s,
            brake_slew_per_s=settings.automatic_brake_slew_per_s,
            target_accel_mps2=settings.target_accel_mps2,
        )
    if mode in (Mode.MANUAL, Mode.SHARED):
        lock = settings.max_road_wheel_rad
        return Limits(
            road_wheel_rad=lock,
            road_wheel_radps=settings.manual_road_wheel_radps,
            lateral_accel_mps2=0.0,
            lateral_jerk_mps3=0.0,
            throttle_slew_per_s=slew,
            brake_slew_per_s=slew,
            target_accel_mps2=settings.target_accel_mps2,
        )
    emergency = mode == Mode.EMERGENCY_STOP
    return Limits(
        road_wheel_rad=settings.max_road_wheel_rad,
        road_wheel_radps=settings.stop_road_wheel_radps,
        lateral_accel_mps2=0.0 if emergency else settings.automatic_lateral_accel_mps2,
        lateral_jerk_mps3=settings.automatic_lateral_jerk_mps3,
        throttle_slew_per_s=slew,
        brake_slew_per_s=settings.emergency_brake_slew_per_s if emergency else settings.automatic_brake_slew_per_s,
        target_accel_mps2=settings.target_accel_mps2 if emergency else settings.stop_decel_mps2,
    )


@kernel
def gate(
    request: Request,
    remote: RemoteCommand,
    arbitration: Arbitration,
    before: VehicleCommand,
    vehicle: VehicleState,
    settings: ControlSettings,
    tick_s: float,
    events: float,
) -> VehicleCommand:
    """Return the one command that the vehicle gets: finite and inside every limit, whatever comes in.

    Args:
        request: What arbitration asks for.
        remote: The newest accepted command: the targets of pose commands pass through here.
        arbitration: Mode of this tick.
        before: What left the gate in the tick before.
        vehicle: State after the tick before, for the limits that depend on speed.
        settings: Limits.
        tick_s: Length of a tick in s.
        events: `Event` mask of this tick: somebody may switch a driver aid off or on again.
    """
    mode = arbitration.mode
    limits = limits_of(mode, settings)
    wheel = _road_wheel(
        request.road_wheel_rad, finite_or(before.road_wheel_rad, 0.0), vehicle, limits, settings, tick_s
    )
    brake = _brake(request.brake, arbitration.person_brake, before.brake, limits, settings, tick_s)
    braked = _at_least(request.brake, brake.value, settings.brake_override)
    cut = mode == Mode.PARKED or mode >= Mode.MINIMAL_RISK or braked
    throttle = _throttle(request.throttle, before.throttle, cut, limits, settings, tick_s)
    hand_step = settings.manual_pedal_slew_per_s * tick_s
    clutch = _pedal(request.clutch, 0.0, before.clutch, hand_step, hand_step)
    handbrake = _pedal(request.handbrake, 0.0, before.handbrake, hand_step, hand_step)
    automatic = 1.0 if request.automatic > 0.0 else 0.0
    gear = _gear(request.gear, finite_or(before.gear, 0.0), automatic, vehicle, settings)
    target = _target(remote, mode, before, vehicle, limits, settings, tick_s)
    active = wheel.active | brake.active | throttle.active | clutch.active | handbrake.active
    turn = _switch(request.turn_indicators, before.turn_indicators, True)
    hazard = _switch(request.hazard_lights, before.hazard_lights, False)
    active |= gear.active | target.active | turn.active | hazard.active
    return VehicleCommand(
        road_wheel_rad=wheel.value,
        throttle=throttle.value,
        brake=brake.value,
        clutch=clutch.value,
        handbrake=handbrake.value,
        gear=gear.value,
        automatic=automatic,
        target_speed_mps=target.speed_mps,
        target_x_m=target.x_m,
        target_y_m=target.y_m,
        target_yaw_rad=target.yaw_rad,
        turn_indicators=turn.value,
        hazard_lights=hazard.value,
        gate_active=float(active),
        gate_active_ticks=_counted(before.gate_active_ticks, active),
        anti_lock_off=_switched(before.anti_lock_off, events, Event.TOGGLE_ANTI_LOCK),
        traction_off=_switched(before.traction_off, events, Event.TOGGLE_TRACTION),
        stability_off=_switched(before.stability_off, events, Event.TOGGLE_STABILITY),
        target_yaw_rate_radps=target.yaw_rate_radps,
    )


@kernel
def _switched(before: float, events: float, bit: int) -> float:
    """Return the other position of a switch in a tick with its event. A reset puts every switch back on (0)."""
    if int(events) & Event.RESET:
        return 0.0
    off = 1.0 if before > 0.0 else 0.0
    return 1.0 - off if int(events) & bit else off


@kernel
def _counted(before_ticks: float, active: int) -> float:
    """Return for how many ticks of the drive the gate has changed something."""
    ticks = clip(finite_or(before_ticks, 0.0), 0.0, NEVER_TICKS)
    return ticks + 1.0 if active != 0 else ticks


@kernel
def _at_least(first: float, second: float, threshold: float) -> bool:
    return first >= threshold or second >= threshold


@kernel
def _road_wheel(
    wanted_rad: float,
    before_rad: float,
    vehicle: VehicleState,
    limits: Limits,
    settings: ControlSettings,
    tick_s: float,
) -> Passed:
    active = 0
    wanted = wanted_rad
    if not is_finite(wanted):
        wanted = before_rad
        active = GateLimit.NON_FINITE
    ranged = clip(wanted, -limits.road_wheel_rad, limits.road_wheel_rad)
    if ranged != wanted:
        active |= GateLimit.RANGE
    gentle = limited_angle(ranged, limits.lateral_accel_mps2, vehicle, settings)
    if gentle != ranged:
        active |= GateLimit.LATERAL_ACCELERATION
    step = limits.road_wheel_radps * tick_s
    smooth_step = limited_step(before_rad, step, limits.lateral_jerk_mps3, vehicle, settings, tick_s)
    moved = approach(before_rad, gentle, smooth_step)
    if moved != gentle:
        active |= GateLimit.LATERAL_JERK if smooth_step < step else GateLimit.RATE
    return Passed(clip(moved, -settings.max_road_wheel_rad, settings.max_road_wheel_rad), active)


@kernel
def _pedal(wanted: float, safe: float, before: float, up: float, down: float) -> Passed:
    if is_finite(wanted):
        ranged = clip(wanted, 0.0, 1.0)
        active = 0 if ranged == wanted else GateLimit.RANGE
    else:
        ranged = safe
        active = GateLimit.NON_FINITE
    held = clip(finite_or(before, safe), 0.0, 1.0)
    moved = approach(held, ranged, up if ranged > held else down)
    if moved != ranged:
        active |= GateLimit.RATE
    return Passed(moved, active)


@kernel
def _brake(
    wanted: float, foot: float, before: float, limits: Limits, settings: ControlSettings, tick_s: float
) -> Passed:
    """Return the brake; where the person's foot asks for more of it, no mode's rate holds the foot back."""
    up, down = limits.brake_slew_per_s, limits.brake_slew_per_s
    if foot >= wanted and foot > before:
        up = max(up, settings.manual_pedal_slew_per_s)
    return _pedal(wanted, _SAFE_BRAKE, before, up * tick_s, down * tick_s)


@kernel
def _throttle(
    wanted: float, before: float, cut: bool, limits: Limits, settings: ControlSettings, tick_s: float
) -> Passed:
    passed = _pedal(wanted, 0.0, before, limits.throttle_slew_per_s * tick_s, settings.manual_pedal_slew_per_s * tick_s)
    if not cut:
        return passed
    over = GateLimit.BRAKE_OVER_THROTTLE if passed.value > 0.0 else 0
    return Passed(0.0, (passed.active & GateLimit.NON_FINITE) | over)


@kernel
def _gear(wanted: float, before: float, automatic: float, vehicle: VehicleState, settings: ControlSettings) -> Passed:
    """Refuse what is no gear, and a change of direction while rolling the other way; neutral is always allowed."""
    lowest = -1.0
    highest = 1.0 if automatic > 0.0 else settings.gear_max
    if not is_finite(wanted):
        return Passed(clip(before, lowest, highest), GateLimit.NON_FINITE)
    if wanted < lowest or wanted > highest or float(int(wanted)) != wanted:
        return Passed(clip(before, lowest, highest), GateLimit.GEAR)
    speed = finite_or(vehicle.vx_mps, 0.0)
    against = wanted * speed < 0.0 and abs(speed) > settings.reverse_speed_max_mps
    if against and wanted * before <= 0.0:
        return Passed(clip(before, lowest, highest), GateLimit.GEAR)
    return Passed(wanted, 0)


@kernel
def _switch(wanted: float, before: float, two_sided: bool) -> Passed:
    """Pass a switch's position, fully to one side or off (0); one that is not finite stays where it was."""
    active = 0
    value = wanted
    if not is_finite(wanted):
        value = finite_or(before, 0.0)
        active = GateLimit.NON_FINITE
    position = 1.0 if value > 0.0 else 0.0
    if two_sided and value < 0.0:
        position = -1.0
    if position != value:
        active |= GateLimit.RANGE
    return Passed(position, active)


@kernel
def _target(
    remote: RemoteCommand,
    mode: float,
    before: VehicleCommand,
    vehicle: VehicleState,
    limits: Limits,
    settings: ControlSettings,
    tick_s: float,
) -> Target:
    """Pass a desired speed and pose while the remote side drives by them; else the speed falls to 0.

    The pose holds during a stop (the way ahead is kept) and follows the vehicle while a person drives.
    """
    before_mps = clip(
        finite_or(before.target_speed_mps, 0.0), -settings.target_speed_max_mps, settings.target_speed_max_mps
    )
    step = limits.target_accel_mps2 * tick_s
    driven = mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.SHARED)
    if driven and remote.kind == RemoteKind.POSE:
        return _pose_target(remote, before, before_mps, step, settings)
    wanted = remote.speed_mps if driven else 0.0
    active = 0
    if not is_finite(wanted):
        wanted = 0.0
        active = GateLimit.NON_FINITE
    wanted = clip(wanted, -settings.target_speed_max_mps, settings.target_speed_max_mps)
    speed = approach(before_mps, wanted, step)
    if mode >= Mode.MINIMAL_RISK:
        pose = _finite_pose(before.target_x_m, before.target_y_m, before.target_yaw_rad, before, settings)
    else:
        pose = _finite_pose(vehicle.x_m, vehicle.y_m, vehicle.yaw_rad, before, settings)
    turn = _turn(remote, driven)
    return Target(
        speed_mps=speed,
        x_m=pose.x_m,
        y_m=pose.y_m,
        yaw_rad=pose.yaw_rad,
        yaw_rate_radps=turn.value,
        active=active | pose.active | turn.active,
    )


@kernel
def _turn(remote: RemoteCommand, driven: bool) -> Passed:
    """Pass the yaw rate of a twist while the remote side drives; the platform's own acceleration limits smooth it."""
    if not driven or remote.kind != RemoteKind.TWIST:
        return Passed(0.0, 0)
    if not is_finite(remote.yaw_rate_radps):
        return Passed(0.0, GateLimit.NON_FINITE)
    ranged = clip(remote.yaw_rate_radps, -_MOST_YAW_RADPS, _MOST_YAW_RADPS)
    active = 0 if ranged == remote.yaw_rate_radps else GateLimit.RANGE
    return Passed(ranged, active)


@kernel
def _pose_target(
    remote: RemoteCommand, before: VehicleCommand, before_mps: float, step: float, settings: ControlSettings
) -> Target:
    pose = _finite_pose(remote.x_m, remote.y_m, remote.yaw_rad, before, settings)
    most = settings.target_speed_max_mps
    active = pose.active
    wanted = remote.speed_mps
    if not is_finite(wanted):
        wanted = 0.0
        active |= GateLimit.NON_FINITE
    ranged = clip(wanted, -most, most)
    if ranged != wanted:
        active |= GateLimit.RANGE
    speed = approach(before_mps, ranged, step)
    if speed != ranged:
        active |= GateLimit.RATE
    return Target(speed_mps=speed, x_m=pose.x_m, y_m=pose.y_m, yaw_rad=pose.yaw_rad, yaw_rate_radps=0.0, active=active)


@kernel
def _finite_pose(x_m: float, y_m: float, yaw_rad: float, before: VehicleCommand, settings: ControlSettings) -> Pose:
    """Return the pose, or as a whole the one before if any part is not finite or out of range."""
    most = settings.target_position_max_m
    if is_finite(x_m) and is_finite(y_m) and is_finite(yaw_rad):
        if abs(x_m) <= most and abs(y_m) <= most and abs(yaw_rad) <= _MOST_YAW_RAD:
            return Pose(x_m, y_m, yaw_rad, 0)
        active = GateLimit.RANGE
    else:
        active = GateLimit.NON_FINITE
    x = clip(finite_or(before.target_x_m, 0.0), -most, most)
    y = clip(finite_or(before.target_y_m, 0.0), -most, most)
    yaw = clip(finite_or(before.target_yaw_rad, 0.0), -_MOST_YAW_RAD, _MOST_YAW_RAD)
    return Pose(x, y, yaw, active)
