"""Who drives in this tick: the mode, the authority of each side, and the one request that follows from both.

Hand-overs are bumpless: authority moves over the fade time, from the command in force. What the remote side asked for
last is held while its authority fades out, so that nothing jumps whatever it sends (or no longer sends) meanwhile.
The person's brake is never faded down: it counts in full in every mode.
"""

from typing import NamedTuple

from simconsole.control.authority import (
    RemoteSide,
    Shares,
    blend,
    remote_side,
    shares_of,
    steered_stop,
    transmission_of,
)
from simconsole.control.lights import Lights, lights_of, switched
from simconsole.control.modes.decision import Decision, decide, takeover_stage
from simconsole.control.modes.restart import Restart, restart_of
from simconsole.control.modes.takeover import (
    WheelWatch,
    steering_taken,
    throttle_held,
    throttle_overrides,
    watch_wheel,
)
from simconsole.control.modes.triggers import link_lost
from simconsole.control.requests.commander import Controllers, assess
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import Person, person_of
from simconsole.control.requests.stops import stands
from simconsole.control.requests.tick_context import TickContext
from simconsole.control.shared import shared_authority
from simconsole.values.kernels import kernel
from simconsole.values.signals import ArbiterMemory, Arbitration, Link, Mode, Notice, Request
from simconsole.values.validity import wilful_torque


class Observed(NamedTuple):
    """What the sources say in this tick."""

    person: Person
    controllers: Controllers
    watch: WheelWatch
    throttle_override: float
    standstill_ticks: float


@kernel
def arbitrate(now: TickContext) -> tuple[ArbiterMemory, Link, Link, Arbitration, Request]:
    """Decide who drives, and what is asked of the vehicle.

    Returns:
        What to remember, the links of the ROS side and of the ECU, who had which authority, and the request for the
        gate (which may still be out of limits).
    """
    seen = _observe(now)
    controllers = seen.controllers
    decision = decide(
        now,
        seen.person,
        controllers,
        steering_taken(seen.watch, now.settings),
        seen.standstill_ticks >= now.settings.standstill_ticks,
    )
    restart = restart_of(now, seen.person)
    if restart.refusal > 0.0:
        decision = Decision(
            mode=decision.mode,
            reason=decision.reason,
            changed=decision.changed,
            refusal=restart.refusal,
            refusal_ticks=0.0,
            wait_begins=decision.wait_begins,
        )
    held_ticks = throttle_held(now.memory.throttle_held_ticks, seen.throttle_override, decision.mode)
    mode_ticks = 0.0 if decision.wait_begins > 0.0 else now.memory.mode_ticks + 1.0
    shared = shared_authority(now, seen.person.road_wheel_rad, controllers.offered.road_wheel_rad)
    shares = shares_of(decision.mode, seen.throttle_override, shared.lateral, now.before, now.settings)
    steered = steered_stop(now, decision, controllers.offered, controllers.link, link_lost(controllers.events))
    side = remote_side(now, decision, shares, controllers.offered, controllers.link, seen.person, steered > 0.0)
    transmission = transmission_of(now, decision.mode, side.direction)
    stalk = switched(now.driver, now.memory)
    lights = lights_of(decision.mode, stalk, controllers.remote, controllers.link)
    return (
        _memory(seen, decision, side, mode_ticks, shared.trade, steered, stalk, held_ticks, restart.ticks),
        controllers.ros_link,
        controllers.ecu_link,
        _arbitration(
            decision,
            shares,
            seen.person,
            side,
            controllers,
            takeover_stage(decision.mode, mode_ticks, now.settings),
            restart,
            _notice(restart, held_ticks, now.settings),
        ),
        blend(decision.mode, shares, side, seen.person, transmission, lights, now.driver),
    )


@kernel
def watched(mode: float) -> bool:
    """Return whether a person can take over from `mode` by moving the wheel."""
    return mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.MINIMAL_RISK)


@kernel
def _observe(now: TickContext) -> Observed:
    person = person_of(now.driver, now.command_before.road_wheel_rad, now.settings)
    watch = watch_wheel(
        WheelWatch(now.memory.engage_hand_wheel_rad, now.memory.steering_ticks),
        now.driver.hand_wheel_rad,
        now.driver.hand_wheel_radps - now.explained_radps,
        now.explained_rad,
        wilful_torque(now.human_nm, now.hand_wheel_radps2) - now.carried_nm,
        watched(now.before.mode),
        person.wheel_trusted > 0.0,
        now.settings,
    )
    return Observed(
        person,
        assess(now),
        watch,
        throttle_overrides(now.memory.throttle_override, person.throttle, now.settings),
        now.memory.standstill_ticks + 1.0 if stands(now.vehicle, now.settings) else 0.0,
    )


@kernel
def _notice(restart: Restart, throttle_held_ticks: float, settings: ControlSettings) -> float:
    if restart.notice > 0.0:
        return restart.notice
    return Notice.THROTTLE_HELD if throttle_held_ticks > settings.throttle_held_ticks else 0.0


@kernel
def _memory(
    seen: Observed,
    decision: Decision,
    side: RemoteSide,
    mode_ticks: float,
    trade: float,
    stop_steered: float,
    stalk: Lights,
    throttle_held_ticks: float,
    restart_ticks: float,
) -> ArbiterMemory:
    return ArbiterMemory(
        mode_ticks=mode_ticks,
        engage_hand_wheel_rad=seen.watch.reference_rad,
        steering_ticks=seen.watch.past_ticks,
        throttle_override=seen.throttle_override,
        refusal_ticks=decision.refusal_ticks,
        standstill_ticks=seen.standstill_ticks,
        speed_integral_mps2=side.speed_integral_mps2,
        stop_accel_mps2=side.stop_accel_mps2,
        hold_road_wheel_rad=side.hold_road_wheel_rad,
        stop_steered=stop_steered,
        shared_trade=trade if decision.mode == Mode.SHARED else 1.0,
        stalk=stalk.turn_indicators,
        hazard_switch=stalk.hazard_lights,
        throttle_held_ticks=throttle_held_ticks,
        restart_ticks=restart_ticks,
    )


@kernel
def _arbitration(
    decision: Decision,
    shares: Shares,
    person: Person,
    side: RemoteSide,
    controllers: Controllers,
    stage: float,
    restart: Restart,
    notice: float,
) -> Arbitration:
    return Arbitration(
        mode=decision.mode,
        reason=decision.reason,
        refusal=decision.refusal,
        remote_lateral=shares.lateral,
        remote_longitudinal=shares.longitudinal,
        person_road_wheel_rad=person.road_wheel_rad,
        person_throttle=person.throttle,
        person_brake=person.brake,
        remote_road_wheel_rad=side.road_wheel_rad,
        remote_throttle=side.throttle,
        remote_brake=side.brake,
        takeover_stage=stage,
        remote_guidance=shares.guidance,
        commander=controllers.commander,
        ros_road_wheel_rad=controllers.ros_offered.road_wheel_rad,
        ros_throttle=controllers.ros_offered.throttle,
        ros_brake=controllers.ros_offered.brake,
        ecu_road_wheel_rad=controllers.ecu_offered.road_wheel_rad,
        ecu_throttle=controllers.ecu_offered.throttle,
        ecu_brake=controllers.ecu_offered.brake,
        restarted=restart.granted,
        notice=notice,
    )
