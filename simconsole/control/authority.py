"""How much authority each side has, what each asks for, and the blend of both."""

from typing import NamedTuple

from simconsole.control.lights import Lights
from simconsole.control.modes.decision import Decision
from simconsole.control.requests.angles import lateral_apart, limited_angle, limited_step
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import Person
from simconsole.control.requests.remote import RemoteRequest
from simconsole.control.requests.stops import safe_stop, stop_start
from simconsole.control.requests.tick_context import TickContext
from simconsole.values.kernels import approach, clip, kernel
from simconsole.values.signals import Arbitration, DriverInput, Link, Mode, Reason, Request, VehicleCommand


class Shares(NamedTuple):
    """The remote side's authority, 0 to 1; the person has the rest."""

    lateral: float
    longitudinal: float
    guidance: float  # over the wheel's motor in SHARED


class RemoteSide(NamedTuple):
    """What the remote side asks for, and its memory for the next tick."""

    road_wheel_rad: float
    throttle: float
    brake: float
    direction: float
    speed_integral_mps2: float
    stop_accel_mps2: float
    hold_road_wheel_rad: float


class Transmission(NamedTuple):
    """Clutch, lever, and whether the car operates them itself."""

    clutch: float
    gear: float
    automatic: float


@kernel
def shares_of(
    mode: float, throttle_override: float, shared_lateral: float, before: Arbitration, settings: ControlSettings
) -> Shares:
    """Move authority by at most one step of the fade; the console's own stops have it at once: they start bumpless.

    Args:
        mode: Of this tick.
        throttle_override: 1 while the person's accelerator overrides.
        shared_lateral: What the rule for SHARED gives the controller now.
        before: Authority of the tick before.
        settings: Of this drive.
    """
    guidance = 0.0
    if mode == Mode.MANUAL:
        lateral = 0.0
        longitudinal = 0.0
    elif mode == Mode.SHARED:
        lateral = 0.0 if settings.shared_haptic > 0.0 else shared_lateral
        guidance = shared_lateral
        longitudinal = settings.shared_longitudinal
    elif mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED):
        lateral = 1.0
        longitudinal = 1.0 - throttle_override
    else:
        return Shares(1.0, 1.0, 0.0)
    step = settings.fade_per_tick
    return Shares(
        approach(before.remote_lateral, lateral, step),
        approach(before.remote_longitudinal, longitudinal, step),
        approach(before.remote_guidance, guidance, step),
    )


@kernel
def remote_side(
    now: TickContext,
    decision: Decision,
    shares: Shares,
    offered: RemoteRequest,
    link: Link,
    person: Person,
    steered: bool,
) -> RemoteSide:
    """Return what the remote side asks for: the controller or, where it does not drive, the console's own stop.

    While its authority fades out in MANUAL, what it asked for last is held; with none left it is shown for information.

    Args:
        now: This tick.
        decision: The mode, and whether it was entered in this tick.
        shares: Authority of this tick.
        offered: What the controller's command means.
        link: Whether that command counts.
        person: The person's side.
        steered: Whether the controller steers a safe stop (`steered_stop`).
    """
    mode = decision.mode
    entered = decision.changed > 0.0
    hold = now.command_before.road_wheel_rad if entered else now.memory.hold_road_wheel_rad
    if mode == Mode.MANUAL and (shares.lateral > 0.0 or shares.longitudinal > 0.0):
        return _fading_side(entered, hold, person, now.before, now.command_before)
    if mode in (Mode.MANUAL, Mode.SHARED, Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED):
        if link.fresh == 0.0:
            return RemoteSide(
                road_wheel_rad=now.command_before.road_wheel_rad,
                throttle=0.0,
                brake=0.0,
                direction=0.0,
                speed_integral_mps2=0.0,
                stop_accel_mps2=0.0,
                hold_road_wheel_rad=hold,
            )
        if mode == Mode.SHARED:
            offered = _held_back(now, offered)
        integral = offered.speed_integral_mps2 if mode != Mode.MANUAL and shares.longitudinal >= 1.0 else 0.0
        return RemoteSide(
            road_wheel_rad=offered.road_wheel_rad,
            throttle=offered.throttle,
            brake=offered.brake,
            direction=offered.direction,
            speed_integral_mps2=integral,
            stop_accel_mps2=0.0,
            hold_road_wheel_rad=hold,
        )
    if mode == Mode.MINIMAL_RISK:
        return _safe_side(now, entered, hold, offered.road_wheel_rad, steered)
    brake = now.settings.emergency_brake if mode == Mode.EMERGENCY_STOP else now.settings.hold_brake
    return RemoteSide(
        road_wheel_rad=hold,
        throttle=0.0,
        brake=brake,
        direction=0.0,
        speed_integral_mps2=0.0,
        stop_accel_mps2=0.0,
        hold_road_wheel_rad=hold,
    )


@kernel
def _fading_side(
    entered: bool, hold_rad: float, person: Person, before: Arbitration, command_before: VehicleCommand
) -> RemoteSide:
    """Hold what the remote side contributed to the command in force at the hand-over, while its share fades out."""
    if not entered:
        return RemoteSide(
            road_wheel_rad=before.remote_road_wheel_rad,
            throttle=before.remote_throttle,
            brake=before.remote_brake,
            direction=0.0,
            speed_integral_mps2=0.0,
            stop_accel_mps2=0.0,
            hold_road_wheel_rad=hold_rad,
        )
    return RemoteSide(
        road_wheel_rad=_contribution(
            before.remote_road_wheel_rad, command_before.road_wheel_rad, person.road_wheel_rad, before.remote_lateral
        ),
        throttle=_contribution(
            before.remote_throttle, command_before.throttle, person.throttle, before.remote_longitudinal
        ),
        brake=_contribution(before.remote_brake, command_before.brake, person.brake, before.remote_longitudinal),
        direction=0.0,
        speed_integral_mps2=0.0,
        stop_accel_mps2=0.0,
        hold_road_wheel_rad=hold_rad,
    )


@kernel
def _contribution(asked: float, in_force: float, person: float, share: float) -> float:
    """Return the remote value that explains the command in force: the gate may have held back what was asked for.

    From share * remote + (1 - share) * person = in_force, kept between what was asked and what is in force.
    """
    if share <= 0.0:
        return in_force
    remote = person + (in_force - person) / share
    return clip(remote, asked, in_force) if asked <= in_force else clip(remote, in_force, asked)


@kernel
def _held_back(now: TickContext, offered: RemoteRequest) -> RemoteRequest:
    """Limit the controller's part of a shared command as in AUTONOMOUS: the gate must leave the person's hands free."""
    before, settings, tick_s = now.before, now.settings, now.tick_s
    most = settings.automatic_road_wheel_rad
    gentle = limited_angle(
        clip(offered.road_wheel_rad, -most, most), settings.automatic_lateral_accel_mps2, now.vehicle, settings
    )
    step = limited_step(
        before.remote_road_wheel_rad,
        settings.automatic_road_wheel_radps * tick_s,
        settings.automatic_lateral_jerk_mps3,
        now.vehicle,
        settings,
        tick_s,
    )
    return RemoteRequest(
        approach(before.remote_road_wheel_rad, gentle, step),
        approach(before.remote_throttle, offered.throttle, settings.automatic_throttle_slew_per_s * tick_s),
        approach(before.remote_brake, offered.brake, settings.automatic_brake_slew_per_s * tick_s),
        offered.direction,
        offered.speed_integral_mps2,
    )


@kernel
def steered_stop(now: TickContext, decision: Decision, offered: RemoteRequest, link: Link, lost: bool) -> float:
    """Return 1 while the controller steers a safe stop: nothing is wrong with it, and never was during this stop.

    If it drove, it goes on: a car whose person did not react, or whose loop stood still, stops in its lane. If a person
    drove (their wheel is lost, or the loop stood still), it steers if it is steady and asks for about what they did.
    One that is `lost` in this tick (it left or did not answer) steers no more, however young its last command is.
    """
    if decision.mode != Mode.MINIMAL_RISK or link.fresh == 0.0 or link.invalid > 0.0 or lost:
        return 0.0
    if decision.changed == 0.0:
        return now.memory.stop_steered
    if now.before.mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED):
        return 1.0 if decision.reason in (Reason.NO_REACTION, Reason.LOOP_STALL) else 0.0
    apart = lateral_apart(offered.road_wheel_rad, now.command_before.road_wheel_rad, now.vehicle, now.settings)
    steady = link.fresh_ticks >= now.settings.engage_stable_ticks
    return 1.0 if steady and apart <= now.settings.stop_steering_apart_mps2 else 0.0


@kernel
def _safe_side(now: TickContext, entered: bool, hold_rad: float, offered_rad: float, steered: bool) -> RemoteSide:
    accel = stop_start(now.vehicle, now.settings) if entered else now.memory.stop_accel_mps2
    integral = 0.0 if entered else now.memory.speed_integral_mps2
    stop = safe_stop(accel, integral, steered, now.vehicle, now.settings, now.tick_s)
    road_wheel_rad = offered_rad
    if not steered:
        road_wheel_rad = approach(hold_rad, 0.0, now.settings.stop_road_wheel_decay_radps * now.tick_s)
    return RemoteSide(
        road_wheel_rad=road_wheel_rad,
        throttle=0.0,
        brake=stop.brake,
        direction=0.0,
        speed_integral_mps2=stop.integral_mps2,
        stop_accel_mps2=stop.stop_accel_mps2,
        hold_road_wheel_rad=road_wheel_rad,
    )


@kernel
def transmission_of(now: TickContext, mode: float, direction: float) -> Transmission:
    """Return who operates clutch and gears; `direction` is what the remote side asks for.

    After autonomy the car goes on doing it until the person takes over by the clutch: the lever may be in any gear.
    """
    driver, command_before, settings = now.driver, now.command_before, now.settings
    if mode == Mode.PARKED:
        return Transmission(0.0, 0.0, 0.0)
    if mode == Mode.STOPPED:
        return Transmission(0.0, 0.0, 1.0)
    if mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED):
        return Transmission(0.0, direction, 1.0)
    if mode in (Mode.MINIMAL_RISK, Mode.EMERGENCY_STOP):
        gear = command_before.gear if command_before.automatic > 0.0 else _sign(now.vehicle.gear)
        return Transmission(0.0, gear, 1.0)
    if mode == Mode.SHARED and settings.shared_longitudinal > 0.0:
        return Transmission(0.0, direction, 1.0)
    if settings.manual_automatic > 0.0:
        return Transmission(0.0, _sign(driver.gear), 1.0)
    if command_before.automatic > 0.0 and driver.clutch < settings.clutch_pressed:
        return Transmission(0.0, command_before.gear, 1.0)
    return Transmission(driver.clutch, driver.gear, 0.0)


@kernel
def _sign(value: float) -> float:
    if value > 0.0:
        return 1.0
    return -1.0 if value < 0.0 else 0.0


@kernel
def blend(
    mode: float,
    shares: Shares,
    side: RemoteSide,
    person: Person,
    transmission: Transmission,
    lights: Lights,
    driver: DriverInput,
) -> Request:
    """Return the two sides' requests weighted by their shares; the person's brake counts in full."""
    road_wheel_rad = shares.lateral * side.road_wheel_rad + (1.0 - shares.lateral) * person.road_wheel_rad
    throttle = shares.longitudinal * side.throttle + (1.0 - shares.longitudinal) * person.throttle
    brake = shares.longitudinal * side.brake + (1.0 - shares.longitudinal) * person.brake
    if person.brake > brake:
        brake = person.brake
    handbrake = 0.0
    if mode in (Mode.PARKED, Mode.STOPPED):
        handbrake = 1.0
    elif mode in (Mode.MANUAL, Mode.SHARED):
        handbrake = driver.handbrake
    return Request(
        road_wheel_rad=road_wheel_rad,
        throttle=throttle,
        brake=brake,
        clutch=transmission.clutch,
        handbrake=handbrake,
        gear=transmission.gear,
        automatic=transmission.automatic,
        turn_indicators=lights.turn_indicators,
        hazard_lights=lights.hazard_lights,
    )
