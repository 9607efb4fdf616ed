"""The mode table: (mode, trigger) -> mode, in this file and nowhere else. docs/modes.md is generated from it.

Triggers stand in the order of their strength. Those that take authority from automation (EMERGENCY to NO_REACTION) all
take effect in their tick, strongest first, each on the mode that results from the one before: none is lost. A request
for more automation, and every other step back towards driving, is granted only in a tick without such an effect, and
only if no trigger of the tick would take authority in the mode that it leads to; else it is refused and not kept.
EMERGENCY_STOP and STOPPED latch: only an act of a person or an operator leaves them, and autonomy is only ever entered
by such an act (AUTONOMOUS_ASKED, SHARED_ASKED).
"""

from enum import IntEnum
from typing import Final, NamedTuple

from simconsole.values.kernels import kernel
from simconsole.values.signals import Mode, Reason


class Trigger(IntEnum):
    """What can change the mode, strongest first. Guards (who may ask when) are in modes/triggers.py."""

    EMERGENCY = 0
    BRAKE = 1
    STEERING = 2
    MANUAL_ASKED = 3
    LOOP_STALL = 4
    DEVICE_LOST = 5
    COMMANDER_LOST = 6
    COMMAND_STALE = 7
    COMMAND_INVALID = 8
    TAKEOVER_ASKED = 9
    NO_REACTION = 10
    STANDSTILL = 11
    RESET = 12
    AUTONOMOUS_ASKED = 13
    SHARED_ASKED = 14
    PERSON_READY = 15


MEANING: Final[dict[Trigger, str]] = {
    Trigger.EMERGENCY: "emergency stop by the person's button or an operator",
    Trigger.BRAKE: "the person presses the brake while wheel and pedals are trusted",
    Trigger.STEERING: "the person has moved the hand wheel since engagement, or turns it fast, for long enough",
    Trigger.MANUAL_ASKED: "the person's button or an operator asks for manual, wheel and pedals are trusted; "
    "from PARKED and STOPPED also the accelerator is released",
    Trigger.LOOP_STALL: "the control loop stood still for more than 100 ms",
    Trigger.DEVICE_LOST: "wheel or pedals are not trusted (any more) and a person is needed",
    Trigger.COMMANDER_LOST: "the controller's connection closed",
    Trigger.COMMAND_STALE: "no command for 200 ms, or no answer in lockstep",
    Trigger.COMMAND_INVALID: "five commands in a row that were refused or steer too hard to be meant at the speed, "
    "no plausible one for 200 ms, or one that is not finite",
    Trigger.TAKEOVER_ASKED: "the controller or an operator asks the person to take over",
    Trigger.NO_REACTION: "ten seconds after a take-over request nobody has reacted; where it was made because wheel or "
    "pedals were lost, only as long as they are not back; a request by somebody after that begins a wait of its own",
    Trigger.STANDSTILL: "the vehicle stands",
    Trigger.RESET: "the person's button or an operator resets; the vehicle stands and the emergency stop is released",
    Trigger.AUTONOMOUS_ASKED: "the person's button or an operator asks for autonomy and every engage condition holds",
    Trigger.SHARED_ASKED: "an operator asks for shared control, every engage condition holds, "
    "wheel and pedals are trusted",
    Trigger.PERSON_READY: "wheel and pedals are trusted and the accelerator is released",
}

REACTIONS: Final[dict[Mode, dict[Trigger, Mode]]] = {
    Mode.PARKED: {
        Trigger.EMERGENCY: Mode.EMERGENCY_STOP,
        Trigger.MANUAL_ASKED: Mode.MANUAL,
        Trigger.AUTONOMOUS_ASKED: Mode.AUTONOMOUS,
        Trigger.PERSON_READY: Mode.MANUAL,
    },
    Mode.MANUAL: {
        Trigger.EMERGENCY: Mode.EMERGENCY_STOP,
        Trigger.LOOP_STALL: Mode.MINIMAL_RISK,
        Trigger.DEVICE_LOST: Mode.MINIMAL_RISK,
        Trigger.AUTONOMOUS_ASKED: Mode.AUTONOMOUS,
        Trigger.SHARED_ASKED: Mode.SHARED,
    },
    Mode.SHARED: {
        Trigger.EMERGENCY: Mode.EMERGENCY_STOP,
        Trigger.MANUAL_ASKED: Mode.MANUAL,
        Trigger.LOOP_STALL: Mode.MINIMAL_RISK,
        Trigger.DEVICE_LOST: Mode.MINIMAL_RISK,
        Trigger.COMMANDER_LOST: Mode.MANUAL,
        Trigger.COMMAND_STALE: Mode.MANUAL,
        Trigger.COMMAND_INVALID: Mode.MANUAL,
        Trigger.TAKEOVER_ASKED: Mode.MANUAL,
        Trigger.AUTONOMOUS_ASKED: Mode.AUTONOMOUS,
    },
    Mode.AUTONOMOUS: {
        Trigger.EMERGENCY: Mode.EMERGENCY_STOP,
        Trigger.BRAKE: Mode.MANUAL,
        Trigger.STEERING: Mode.MANUAL,
        Trigger.MANUAL_ASKED: Mode.MANUAL,
        Trigger.LOOP_STALL: Mode.MINIMAL_RISK,
        Trigger.DEVICE_LOST: Mode.TAKEOVER_REQUESTED,
        Trigger.COMMANDER_LOST: Mode.MINIMAL_RISK,
        Trigger.COMMAND_STALE: Mode.MINIMAL_RISK,
        Trigger.COMMAND_INVALID: Mode.MINIMAL_RISK,
        Trigger.TAKEOVER_ASKED: Mode.TAKEOVER_REQUESTED,
        Trigger.SHARED_ASKED: Mode.SHARED,
    },
    Mode.TAKEOVER_REQUESTED: {
        Trigger.EMERGENCY: Mode.EMERGENCY_STOP,
        Trigger.BRAKE: Mode.MANUAL,
        Trigger.STEERING: Mode.MANUAL,
        Trigger.MANUAL_ASKED: Mode.MANUAL,
        Trigger.LOOP_STALL: Mode.MINIMAL_RISK,
        Trigger.COMMANDER_LOST: Mode.MINIMAL_RISK,
        Trigger.COMMAND_STALE: Mode.MINIMAL_RISK,
        Trigger.COMMAND_INVALID: Mode.MINIMAL_RISK,
        Trigger.NO_REACTION: Mode.MINIMAL_RISK,
        Trigger.AUTONOMOUS_ASKED: Mode.AUTONOMOUS,
    },
    Mode.MINIMAL_RISK: {
        Trigger.EMERGENCY: Mode.EMERGENCY_STOP,
        Trigger.BRAKE: Mode.MANUAL,
        Trigger.STEERING: Mode.MANUAL,
        Trigger.MANUAL_ASKED: Mode.MANUAL,
        Trigger.STANDSTILL: Mode.STOPPED,
    },
    Mode.STOPPED: {
        Trigger.EMERGENCY: Mode.EMERGENCY_STOP,
        Trigger.MANUAL_ASKED: Mode.MANUAL,
        Trigger.RESET: Mode.PARKED,
        Trigger.AUTONOMOUS_ASKED: Mode.AUTONOMOUS,
    },
    Mode.EMERGENCY_STOP: {
        Trigger.RESET: Mode.PARKED,
    },
}
"""By mode and trigger; a trigger that is not listed leaves the mode unchanged."""

REASONS: Final[dict[Trigger, Reason]] = {
    Trigger.EMERGENCY: Reason.EMERGENCY,
    Trigger.BRAKE: Reason.BRAKE_OVERRIDE,
    Trigger.STEERING: Reason.STEERING_OVERRIDE,
    Trigger.MANUAL_ASKED: Reason.PERSON_ASKED,
    Trigger.LOOP_STALL: Reason.LOOP_STALL,
    Trigger.DEVICE_LOST: Reason.DEVICE_LOST,
    Trigger.COMMANDER_LOST: Reason.COMMANDER_LOST,
    Trigger.COMMAND_STALE: Reason.COMMAND_STALE,
    Trigger.COMMAND_INVALID: Reason.COMMAND_INVALID,
    Trigger.TAKEOVER_ASKED: Reason.REMOTE_ASKED,
    Trigger.NO_REACTION: Reason.NO_REACTION,
    Trigger.STANDSTILL: Reason.STANDSTILL,
    Trigger.RESET: Reason.RESET,
    Trigger.AUTONOMOUS_ASKED: Reason.PERSON_ASKED,
    Trigger.SHARED_ASKED: Reason.OPERATOR_ASKED,
    Trigger.PERSON_READY: Reason.ARMED,
}

MODES: Final = len(Mode)
TRIGGERS: Final = len(Trigger)
_TABLE: Final = tuple(tuple(float(REACTIONS[mode].get(trigger, mode)) for trigger in Trigger) for mode in Mode)
_REASONS: Final = tuple(float(REASONS[trigger]) for trigger in Trigger)
_TAKERS: Final = int(Trigger.NO_REACTION) + 1
"""The triggers below this one take authority from automation."""


class Outcome(NamedTuple):
    """The mode after the triggers of one tick."""

    mode: float
    trigger: int  # the last `Trigger` that took effect; -1: none


@kernel
def outcome(mode: float, present: int) -> Outcome:
    """Return the mode that follows `mode` in one tick under the triggers of the mask `present` (bit n: `Trigger` n)."""
    after = mode
    decisive = -1
    for trigger in range(_TAKERS):
        if (present >> trigger) & 1 and takes(after, trigger):
            after = _TABLE[int(after)][trigger]
            decisive = trigger
    if decisive >= 0:
        return Outcome(after, decisive)
    for trigger in range(TRIGGERS):
        if (present >> trigger) & 1 and reacts(mode, trigger) and _withstands(_TABLE[int(mode)][trigger], present):
            return Outcome(_TABLE[int(mode)][trigger], trigger)
    return Outcome(mode, -1)


@kernel
def reacts(mode: float, trigger: int) -> bool:
    """Return whether `trigger` alone changes `mode`."""
    return _TABLE[int(mode)][trigger] != mode


@kernel
def takes(mode: float, trigger: int) -> bool:
    """Return whether `trigger` changes `mode` by taking authority from automation or from a person who lost it.

    Manual control that is asked for in a car that stands parked or stopped takes nothing: it is a step towards driving.
    """
    if trigger == Trigger.MANUAL_ASKED and mode in (Mode.PARKED, Mode.STOPPED):
        return False
    return trigger < _TAKERS and reacts(mode, trigger)


@kernel
def _withstands(mode: float, present: int) -> bool:
    for trigger in range(_TAKERS):  # noqa: SIM110  (numba has no `all`)
        if (present >> trigger) & 1 and takes(mode, trigger):
            return False
    return True


@kernel
def reason_of(trigger: int) -> float:
    """Return the `Reason` that `trigger` (0 or more) gives for a change."""
    return _REASONS[trigger]
