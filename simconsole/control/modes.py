"""The mode table: (mode, trigger) -> mode, in this file and nowhere else. docs/modes.md is generated from it.

Triggers stand in the order of their strength. Of all that are present in a tick the strongest one to which the mode
reacts decides; weaker ones of the same tick are lost, and those that persist (a pressed pedal, a silent controller)
come again in the next tick. EMERGENCY_STOP and STOPPED latch: only an act of a person or an operator leaves them, and
autonomy is only ever entered by such an act (AUTONOMOUS_ASKED, SHARED_ASKED).
"""

from enum import IntEnum
from typing import Final

from simconsole.kernels import kernel
from simconsole.signals import Mode, Reason


class Trigger(IntEnum):
    """What can change the mode, strongest first. Guards (who may ask when) are in control/triggers.py."""

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
    "nothing else for 200 ms, or one that is not finite",
    Trigger.TAKEOVER_ASKED: "the controller or an operator asks the person to take over",
    Trigger.NO_REACTION: "ten seconds after a take-over request nobody has reacted; where it was made because wheel or "
    "pedals were lost, only as long as they are not back",
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
"""Where a trigger is not named, the mode stays."""

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
_NOBODY: Final = -1


@kernel
def deciding_trigger(mode: float, present: int) -> int:
    """Return the strongest trigger of the mask `present` (bit n: `Trigger` n) that changes `mode`; -1: none."""
    row = _TABLE[int(mode)]
    for trigger in range(TRIGGERS):
        if (present >> trigger) & 1 and row[trigger] != mode:
            return trigger
    return _NOBODY


@kernel
def next_mode(mode: float, trigger: int) -> float:
    """Return the mode after `trigger`; -1 keeps it."""
    if trigger < 0:
        return mode
    return _TABLE[int(mode)][trigger]


@kernel
def reason_of(trigger: int) -> float:
    """Return the `Reason` that `trigger` (0 or more) gives for a change."""
    return _REASONS[trigger]
