"""What happened in this tick, as the mask of triggers that the mode table understands, and why an ask was refused."""

from typing import Final, NamedTuple

from simconsole.control.modes.engage import GRANTED
from simconsole.control.modes.mode_table import Trigger, reacts
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import Person, mask
from simconsole.values.kernels import kernel
from simconsole.values.signals import Button, DriverInput, Event, Link, Mode, Reason

_PARKED: Final = float(Mode.PARKED)
_MANUAL: Final = float(Mode.MANUAL)
_SHARED: Final = float(Mode.SHARED)
_AUTONOMOUS: Final = float(Mode.AUTONOMOUS)
_STOPPED: Final = float(Mode.STOPPED)
_EMERGENCY_STOP: Final = float(Mode.EMERGENCY_STOP)

_EVENT_EMERGENCY: Final = int(Event.EMERGENCY_STOP)
_EVENT_RESET: Final = int(Event.RESET)
_EVENT_MANUAL: Final = int(Event.REQUEST_MANUAL)
_EVENT_AUTONOMOUS: Final = int(Event.REQUEST_AUTONOMOUS)
_EVENT_TAKEOVER: Final = int(Event.REQUEST_TAKEOVER)
_EVENT_SHARED: Final = int(Event.REQUEST_SHARED)
_EVENT_COMMANDER_LOST: Final = int(Event.COMMANDER_LOST)
_EVENT_LOOP_STALL: Final = int(Event.LOOP_STALL)
_EVENT_NO_ANSWER: Final = int(Event.NO_ANSWER)

_BUTTON_EMERGENCY: Final = int(Button.EMERGENCY_STOP)
_BUTTON_RESET: Final = int(Button.RESET)
_BUTTON_MANUAL: Final = int(Button.MANUAL)
_BUTTON_AUTONOMOUS: Final = int(Button.AUTONOMOUS)
_BUTTON_TAKEOVER: Final = int(Button.TAKEOVER)
_BUTTON_SHARED: Final = int(Button.SHARED)

_EMERGENCY: Final = 1 << int(Trigger.EMERGENCY)
_BRAKE: Final = 1 << int(Trigger.BRAKE)
_STEERING: Final = 1 << int(Trigger.STEERING)
_MANUAL_ASKED: Final = 1 << int(Trigger.MANUAL_ASKED)
_LOOP_STALL: Final = 1 << int(Trigger.LOOP_STALL)
_DEVICE_LOST: Final = 1 << int(Trigger.DEVICE_LOST)
_COMMANDER_LOST: Final = 1 << int(Trigger.COMMANDER_LOST)
_COMMAND_STALE: Final = 1 << int(Trigger.COMMAND_STALE)
_COMMAND_INVALID: Final = 1 << int(Trigger.COMMAND_INVALID)
_TAKEOVER_ASKED: Final = 1 << int(Trigger.TAKEOVER_ASKED)
_NO_REACTION: Final = 1 << int(Trigger.NO_REACTION)
_STANDSTILL: Final = 1 << int(Trigger.STANDSTILL)
_RESET: Final = 1 << int(Trigger.RESET)
_AUTONOMOUS_ASKED: Final = 1 << int(Trigger.AUTONOMOUS_ASKED)
_SHARED_ASKED: Final = 1 << int(Trigger.SHARED_ASKED)
_PERSON_READY: Final = 1 << int(Trigger.PERSON_READY)

_REFUSED_EMERGENCY: Final = float(Reason.REFUSED_EMERGENCY)
_REFUSED_MOVING: Final = float(Reason.REFUSED_MOVING)
_REFUSED_NOT_ARMED: Final = float(Reason.REFUSED_NOT_ARMED)
_REFUSED_THROTTLE: Final = float(Reason.REFUSED_THROTTLE_PRESSED)
_REFUSED_MODE: Final = float(Reason.REFUSED_MODE)
_REFUSED_OVERRULED: Final = float(Reason.REFUSED_OVERRULED)
_ASK_MANUAL: Final = int(Trigger.MANUAL_ASKED)
_ASK_RESET: Final = int(Trigger.RESET)
_ASK_AUTONOMOUS: Final = int(Trigger.AUTONOMOUS_ASKED)
_ASK_SHARED: Final = int(Trigger.SHARED_ASKED)


class Asked(NamedTuple):
    """Acts of a person or an operator in this tick, 1 or 0 each."""

    emergency: float
    emergency_held: float  # or its button is still down
    reset: float
    manual: float
    autonomous: float
    takeover: float
    shared: float
    by_person: float  # manual or autonomy was asked by the wheel's button


@kernel
def asked_of(driver: DriverInput, events: int) -> Asked:
    """Return what is asked for, by the wheel's buttons and by events alike."""
    edges = mask(driver.edges)
    emergency = (events & _EVENT_EMERGENCY) | ((edges | mask(driver.pressed)) & _BUTTON_EMERGENCY)
    reset = (events & _EVENT_RESET) | (edges & _BUTTON_RESET)
    manual = (events & _EVENT_MANUAL) | (edges & _BUTTON_MANUAL)
    autonomous = (events & _EVENT_AUTONOMOUS) | (edges & _BUTTON_AUTONOMOUS)
    return Asked(
        emergency=_flag(emergency),
        emergency_held=_flag(mask(driver.pressed) & _BUTTON_EMERGENCY),
        reset=_flag(reset),
        manual=_flag(manual),
        autonomous=_flag(autonomous),
        takeover=_flag((events & _EVENT_TAKEOVER) | (edges & _BUTTON_TAKEOVER)),
        shared=_flag((events & _EVENT_SHARED) | (edges & _BUTTON_SHARED)),
        by_person=_flag(edges & (_BUTTON_MANUAL | _BUTTON_AUTONOMOUS | _BUTTON_SHARED)),
    )


@kernel
def _flag(bits: int) -> float:
    return 1.0 if bits != 0 else 0.0


@kernel
def manual_refusal(mode: float, person: Person, settings: ControlSettings) -> float:
    """Return 0 if the person may have manual control in `mode`, else the `Reason` that refuses it."""
    if mode == _EMERGENCY_STOP:
        return _REFUSED_EMERGENCY
    if person.trusted == 0.0:
        return _REFUSED_NOT_ARMED
    if (mode in (_STOPPED, _PARKED)) and person.accelerator >= settings.throttle_override:
        return _REFUSED_THROTTLE
    return GRANTED


@kernel
def reset_refusal(asked: Asked, standing: bool) -> float:
    """Return 0 if a latched stop may be reset, else the `Reason` that refuses it."""
    if asked.emergency > 0.0 or asked.emergency_held > 0.0:
        return _REFUSED_EMERGENCY
    return GRANTED if standing else _REFUSED_MOVING


@kernel
def person_triggers(mode: float, person: Person, steering: bool, settings: ControlSettings) -> int:
    """Return the triggers that come from the cockpit alone."""
    if person.trusted == 0.0:
        needed = settings.person_required > 0.0 or mode in (_MANUAL, _SHARED)
        return _DEVICE_LOST if needed else 0
    present = _BRAKE if person.brake >= settings.brake_override else 0
    if person.accelerator < settings.throttle_override:
        present |= _PERSON_READY
    if steering:
        present |= _STEERING
    return present


@kernel
def fault_triggers(link: Link, events: int, no_reaction: bool, standing: bool) -> int:
    """Return the triggers that nobody asked for."""
    present = _LOOP_STALL if events & _EVENT_LOOP_STALL != 0 else 0
    if events & _EVENT_COMMANDER_LOST != 0:
        present |= _COMMANDER_LOST
    if link.invalid > 0.0:
        present |= _COMMAND_INVALID
    elif link.fresh == 0.0 or events & _EVENT_NO_ANSWER != 0:
        present |= _COMMAND_STALE
    if no_reaction:
        present |= _NO_REACTION
    if standing:
        present |= _STANDSTILL
    return present


@kernel
def link_lost(events: int) -> bool:
    """Return whether the commander left, or did not answer, in this tick."""
    return events & (_EVENT_COMMANDER_LOST | _EVENT_NO_ANSWER) != 0


@kernel
def asked_triggers(asked: Asked, manual: float, reset: float, engage: float, shared: float) -> int:
    """Return the triggers of what was asked for and is not refused (refusals: 0 or a `Reason`)."""
    present = _EMERGENCY if asked.emergency > 0.0 else 0
    if asked.takeover > 0.0:
        present |= _TAKEOVER_ASKED
    if asked.manual > 0.0 and manual == GRANTED:
        present |= _MANUAL_ASKED
    if asked.reset > 0.0 and reset == GRANTED:
        present |= _RESET
    if asked.autonomous > 0.0 and engage == GRANTED:
        present |= _AUTONOMOUS_ASKED
    if asked.shared > 0.0 and shared == GRANTED:
        present |= _SHARED_ASKED
    return present


@kernel
def refusal_of(
    mode: float, after: float, asked: Asked, manual: float, reset: float, engage: float, shared: float
) -> float:
    """Return why an ask of this tick was refused; 0 if none was, or what it asks for is in force.

    Args:
        mode: before this tick.
        after: after it: an ask may have met something stronger.
        asked: what was asked for.
        manual: 0, or the `Reason` against manual control in `mode`.
        reset: The same against a reset.
        engage: The same against autonomy.
        shared: The same against shared control.
    """
    if asked.manual > 0.0 and after != _MANUAL:
        return _unmet(mode, after, manual, _ASK_MANUAL)
    latched = mode in (_EMERGENCY_STOP, _STOPPED) or after in (_EMERGENCY_STOP, _STOPPED)
    if asked.reset > 0.0 and latched and after != _PARKED:
        return reset if reset != GRANTED else _unmet(mode, after, reset, _ASK_RESET)
    if asked.autonomous > 0.0 and after != _AUTONOMOUS:
        return _unmet(mode, after, engage, _ASK_AUTONOMOUS)
    if asked.shared > 0.0 and after != _SHARED:
        return _unmet(mode, after, shared, _ASK_SHARED)
    return GRANTED


@kernel
def _unmet(mode: float, after: float, refusal: float, trigger: int) -> float:
    """Return why an ask was not met: a latched emergency stop, its own refusal, something stronger, or the mode."""
    if after == _EMERGENCY_STOP:
        return _REFUSED_EMERGENCY
    if refusal != GRANTED:
        return refusal
    return _REFUSED_OVERRULED if reacts(mode, trigger) else _REFUSED_MODE
