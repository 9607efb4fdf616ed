"""Who drives in this tick: the mode, the authority of each side, and the one request that follows from both.

Hand-overs are bumpless: authority moves over the fade time, from the command in force. What the remote side asked for
last is held while its authority fades out, so that nothing jumps whatever it sends (or no longer sends) meanwhile.
The person's brake is never faded down: it counts in full in every mode.
"""

from typing import Final

from simconsole.control.authority import blend, remote_side, shares_of, transmission_of
from simconsole.control.decision import decide, takeover_stage
from simconsole.control.link import watch_link
from simconsole.control.person import mask, person_of
from simconsole.control.remote import RemoteRequest, command_finite, remote_request
from simconsole.control.settings import ControlSettings
from simconsole.control.stops import slow
from simconsole.control.takeover import WheelWatch, steering_taken, throttle_overrides, watch_wheel
from simconsole.kernels import kernel
from simconsole.signals import (
    ArbiterMemory,
    Arbitration,
    DriverInput,
    EventInput,
    Mode,
    RemoteCommand,
    Request,
    VehicleCommand,
    VehicleState,
)

_AUTONOMOUS: Final = float(Mode.AUTONOMOUS)
_TAKEOVER_REQUESTED: Final = float(Mode.TAKEOVER_REQUESTED)
_MINIMAL_RISK: Final = float(Mode.MINIMAL_RISK)


@kernel
def arbitrate(
    driver: DriverInput,
    remote: RemoteCommand,
    events: EventInput,
    vehicle: VehicleState,
    memory: ArbiterMemory,
    before: Arbitration,
    command_before: VehicleCommand,
    settings: ControlSettings,
    tick_s: float,
    explained_rad: float = 0.0,
    explained_radps: float = 0.0,
) -> tuple[ArbiterMemory, Arbitration, Request]:
    """Decide who drives, and what is asked of the vehicle.

    Args:
        driver: The person, calibrated, in this tick.
        remote: The newest accepted command.
        events: Edges since the last tick.
        vehicle: The vehicle after the tick before.
        memory: From the tick before.
        before: Authority and mode of the tick before.
        command_before: What left the gate in the tick before: hand-overs start from it.
        settings: Of this drive.
        tick_s: Length of a tick in s.
        explained_rad: How far the wheel's motor alone has moved it since engagement; 0 without a motor.
        explained_radps: How fast.

    Returns:
        What to remember, who had which authority, and the request for the gate (which may still be out of limits).
    """
    person = person_of(driver, command_before.road_wheel_rad, settings)
    link = watch_link(remote, memory, settings)
    offered = _offered(remote, memory.speed_integral_mps2, vehicle, command_before, settings, tick_s)
    watch = watch_wheel(
        WheelWatch(memory.engage_hand_wheel_rad, memory.steering_ticks),
        driver.hand_wheel_rad,
        driver.hand_wheel_radps - explained_radps,
        explained_rad,
        watched(before.mode),
        person.wheel_trusted > 0.0,
        settings,
    )
    standstill_ticks = memory.standstill_ticks + 1.0 if slow(vehicle, settings) else 0.0
    decision = decide(
        driver,
        remote,
        mask(events.events),
        vehicle,
        memory,
        before,
        command_before,
        settings,
        person,
        link,
        offered,
        steering_taken(watch, settings),
        standstill_ticks >= settings.standstill_ticks,
    )
    mode_ticks = 0.0 if decision.changed > 0.0 else memory.mode_ticks + 1.0
    throttle_override = throttle_overrides(memory.throttle_override, person.throttle, settings)
    shares = shares_of(decision.mode, throttle_override, before, settings)
    side = remote_side(
        decision, shares, offered, link, person, memory, before, command_before, vehicle, settings, tick_s
    )
    transmission = transmission_of(decision.mode, side.direction, driver, command_before, vehicle, settings)
    request = blend(decision.mode, shares, side, person, transmission, driver)
    return (
        ArbiterMemory(
            mode_ticks,
            watch.reference_rad,
            watch.past_ticks,
            throttle_override,
            link.sequence_seen,
            link.refused_seen,
            link.invalid_run,
            link.fresh_ticks,
            decision.refusal_ticks,
            standstill_ticks,
            side.speed_integral_mps2,
            side.stop_accel_mps2,
            side.hold_road_wheel_rad,
        ),
        Arbitration(
            decision.mode,
            decision.reason,
            decision.refusal,
            shares.lateral,
            shares.longitudinal,
            person.road_wheel_rad,
            person.throttle,
            person.brake,
            side.road_wheel_rad,
            side.throttle,
            side.brake,
            takeover_stage(decision.mode, mode_ticks, settings),
        ),
        request,
    )


@kernel
def watched(mode: float) -> bool:
    """Return whether a person can take over from `mode` by moving the wheel."""
    return mode in (_AUTONOMOUS, _TAKEOVER_REQUESTED, _MINIMAL_RISK)


@kernel
def _offered(
    remote: RemoteCommand,
    integral_mps2: float,
    vehicle: VehicleState,
    command_before: VehicleCommand,
    settings: ControlSettings,
    tick_s: float,
) -> RemoteRequest:
    if not command_finite(remote):
        return RemoteRequest(command_before.road_wheel_rad, 0.0, 0.0, 0.0, 0.0)
    return remote_request(remote, command_before.road_wheel_rad, integral_mps2, vehicle, settings, tick_s)
