"""What the oracle counts with: its own names for modes, triggers and edges, and the settings that decide."""

import math
from typing import Final, NamedTuple

from simconsole.profiles.control import ControlProfile
from simconsole.values.signals import (
    Button,
    Commander,
    Event,
    Mode,
    Reason,
    RemoteKind,
    Validity,
)

PARKED, MANUAL, SHARED, AUTONOMOUS, TAKEOVER, MINIMAL, STOPPED, EMERGENCY_STOP = map(float, Mode)
NOBODY, ROS, ECU = map(float, Commander)
TRIGGERS: Final = (
    *("EMERGENCY", "BRAKE", "STEERING", "MANUAL_ASKED", "LOOP_STALL", "DEVICE_LOST", "COMMANDER_LOST"),
    *("COMMAND_STALE", "COMMAND_INVALID", "TAKEOVER_ASKED", "NO_REACTION", "STANDSTILL", "RESET"),
    *("AUTONOMOUS_ASKED", "SHARED_ASKED", "PERSON_READY"),
)
EMERGENCY, BRAKE, STEERING, MANUAL_ASKED, LOOP_STALL, DEVICE_LOST, COMMANDER_LOST = range(7)
COMMAND_STALE, COMMAND_INVALID, TAKEOVER_ASKED, NO_REACTION, STANDSTILL, RESET = range(7, 13)
AUTONOMOUS_ASKED, SHARED_ASKED, PERSON_READY = range(13, 16)
COUNT: Final = len(TRIGGERS)

E_STOP, E_RESET, E_MANUAL, E_AUTONOMOUS, E_TAKEOVER, E_SHARED, E_LEFT, E_STALL, E_NO_ANSWER, E_RESTART = (
    float(event)
    for event in (
        *(Event.EMERGENCY_STOP, Event.RESET, Event.REQUEST_MANUAL, Event.REQUEST_AUTONOMOUS, Event.REQUEST_TAKEOVER),
        *(Event.REQUEST_SHARED, Event.COMMANDER_LOST, Event.LOOP_STALL, Event.NO_ANSWER, Event.RESTART),
    )
)
B_STOP, B_RESET, B_MANUAL, B_AUTONOMOUS, B_TAKEOVER, B_SHARED, B_RESTART = (
    float(button)
    for button in (
        *(Button.EMERGENCY_STOP, Button.RESET, Button.MANUAL, Button.AUTONOMOUS, Button.TAKEOVER, Button.SHARED),
        Button.RESTART,
    )
)
ARMED, LIVE = float(Validity.ARMED), float(Validity.LIVE)
SPEED_KIND, TWIST_KIND = float(RemoteKind.SPEED), float(RemoteKind.TWIST)
LAST_KIND: Final = float(max(RemoteKind))

# What the oracle remembers: a block for each controller, then the rest.
SEEN, REFUSED, RUN, AGE, RECEIVED, STEADY, QUIET, FRESH, INVALID, STALE, WILD, GOOD = range(12)
BLOCK: Final = 12
ROS_AT, ECU_AT = 0, BLOCK
MODE, SINCE, WAIT, BY_REQUEST, REFERENCE, REFERRED, TURNED, STANDING, WHO, EFFECT, ASKED = range(
    2 * BLOCK, 2 * BLOCK + 11
)
BACK, BY_LOSS, TOLD_STOP, TOLD_RESET, TOLD_TAKEOVER = range(2 * BLOCK + 11, 2 * BLOCK + 16)
WIDTH: Final = 2 * BLOCK + 16


class Rules(NamedTuple):
    """The settings that decide on modes, in SI and ticks. An age expires rounded down, a while lasts rounded up."""

    person_required: float
    preferred: float
    wheelbase_m: float
    brake: float
    accelerator: float
    moved_rad: float
    moved_still_rad: float
    turned_radps: float
    pulled_nm: float
    turned_ticks: float
    stale_ticks: float
    lease_ticks: float
    invalid_most: float
    wild_mps2: float
    no_reaction_ticks: float
    stands_mps: float
    stands_ticks: float
    steady_ticks: float
    steady_again_ticks: float
    fast_mps: float
    apart_mps: float
    cornering_mps2: float
    apart_rad: float
    apart_above_mps: float
    leaves_ticks: float
    back_ticks: float


def rules(profile: ControlProfile, tick_hz: int, preferred: Commander, wheelbase_m: float) -> Rules:
    """Return what the profile promises at this rate."""

    def within(seconds: float) -> float:
        return float(math.floor(seconds * tick_hz + 1e-9))

    def lasting(seconds: float) -> float:
        return float(math.ceil(seconds * tick_hz - 1e-9))

    p = profile
    return Rules(
        person_required=float(p.person_required),
        preferred=float(preferred),
        wheelbase_m=wheelbase_m,
        brake=p.brake_override,
        accelerator=p.throttle_override,
        moved_rad=math.radians(p.steering_override_deg),
        moved_still_rad=math.radians(p.steering_override_deg - p.steering_override_hysteresis_deg),
        turned_radps=math.radians(p.steering_override_rate_degps),
        pulled_nm=p.steering_override_nm,
        turned_ticks=lasting(p.steering_override_hold_s),
        stale_ticks=within(p.command_stale_s),
        lease_ticks=within(p.commander_lease_s),
        invalid_most=float(p.invalid_commands_max),
        wild_mps2=p.implausible_lateral_accel_ratio * p.automatic_lateral_accel_mps2,
        no_reaction_ticks=lasting(p.minimal_risk_after_s),
        stands_mps=p.standstill_speed_mps,
        stands_ticks=max(1.0, lasting(p.standstill_s)),
        steady_ticks=max(1.0, lasting(p.engage_stable_s)),
        steady_again_ticks=max(1.0, lasting(p.reengage_stable_s)),
        fast_mps=p.engage_speed_max_mps,
        apart_mps=p.engage_speed_deviation_mps,
        cornering_mps2=p.engage_lateral_accel_mps2,
        apart_rad=p.engage_road_wheel_deviation_rad,
        apart_above_mps=p.engage_deviation_speed_mps,
        leaves_ticks=p.command_stale_s * tick_hz + 0.01 * tick_hz + 1.0,
        back_ticks=max(1.0, lasting(p.device_back_s)),
    )


REASONS: Final = (
    *(Reason.EMERGENCY, Reason.BRAKE_OVERRIDE, Reason.STEERING_OVERRIDE, Reason.PERSON_ASKED, Reason.LOOP_STALL),
    *(Reason.DEVICE_LOST, Reason.COMMANDER_LOST, Reason.COMMAND_STALE, Reason.COMMAND_INVALID, Reason.REMOTE_ASKED),
    *(Reason.NO_REACTION, Reason.STANDSTILL, Reason.RESET, Reason.PERSON_ASKED, Reason.OPERATOR_ASKED, Reason.ARMED),
)
"""What each trigger gives as its reason, in the order of TRIGGERS."""


def may_meet(mode: int, one: int, other: int) -> bool:
    """Return whether two triggers can be present in one tick of a mode, by what each of them is."""
    pair = {one, other}
    if NO_REACTION in pair and mode != Mode.TAKEOVER_REQUESTED:
        return False
    if STEERING in pair and mode not in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.MINIMAL_RISK):
        return False
    if DEVICE_LOST in pair and pair & {BRAKE, STEERING, MANUAL_ASKED, SHARED_ASKED, PERSON_READY}:
        return False
    if pair in ({EMERGENCY, RESET}, {COMMAND_STALE, COMMAND_INVALID}):
        return False
    engages = pair & {AUTONOMOUS_ASKED, SHARED_ASKED}
    return not (engages and pair & {BRAKE, COMMAND_INVALID})
