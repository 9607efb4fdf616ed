"""What happened in this tick, as the mask of triggers that the mode table understands, and why one was refused."""

from typing import NamedTuple

from simconsole.control.modes.engage import GRANTED
from simconsole.control.modes.mode_table import Trigger, reacts
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import Person, mask
from simconsole.values.kernels import kernel
from simconsole.values.signals import Button, DriverInput, Event, Link, Mode, Reason


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
    emergency_reason: float  # `Reason`: whose act it is
    reset_reason: float
    takeover_reason: float


@kernel
def asked_of(driver: DriverInput, events: int) -> Asked:
    """Return what is asked for, by the wheel's buttons and by events alike."""
    edges = mask(driver.edges)
    stop_button = (edges | mask(driver.pressed)) & Button.EMERGENCY_STOP
    emergency = (events & Event.EMERGENCY_STOP) | stop_button
    reset = (events & Event.RESET) | (edges & Button.RESET)
    manual = (events & Event.REQUEST_MANUAL) | (edges & Button.MANUAL)
    autonomous = (events & Event.REQUEST_AUTONOMOUS) | (edges & Button.AUTONOMOUS)
    operator = events & Event.OPERATOR != 0
    emergency_reason = Reason.OPERATOR_EMERGENCY if operator and stop_button == 0 else Reason.EMERGENCY
    reset_reason = Reason.OPERATOR_RESET if operator and edges & Button.RESET == 0 else Reason.RESET
    takeover_reason = Reason.OPERATOR_ASKED if operator else Reason.REMOTE_ASKED
    if edges & Button.TAKEOVER != 0:
        takeover_reason = Reason.PERSON_ASKED
    return Asked(
        emergency=_flag(emergency),
        emergency_held=_flag(mask(driver.pressed) & Button.EMERGENCY_STOP),
        reset=_flag(reset),
        manual=_flag(manual),
        autonomous=_flag(autonomous),
        takeover=_flag((events & Event.REQUEST_TAKEOVER) | (edges & Button.TAKEOVER)),
        shared=_flag((events & Event.REQUEST_SHARED) | (edges & Button.SHARED)),
        by_person=_flag(edges & (Button.MANUAL | Button.AUTONOMOUS | Button.SHARED)),
        emergency_reason=emergency_reason,
        reset_reason=reset_reason,
        takeover_reason=takeover_reason,
    )


@kernel
def bit(trigger: float) -> int:
    """Return the mask of one `Trigger`."""
    return 1 << int(trigger)


@kernel
def _flag(bits: int) -> float:
    return 1.0 if bits != 0 else 0.0


@kernel
def manual_refusal(mode: float, person: Person, settings: ControlSettings) -> float:
    """Return 0 if the person may have manual control in `mode`, else the `Reason` that refuses it."""
    if mode == Mode.EMERGENCY_STOP:
        return Reason.REFUSED_EMERGENCY
    if person.trusted == 0.0:
        return Reason.REFUSED_NOT_ARMED
    if mode in (Mode.STOPPED, Mode.PARKED) and person.accelerator >= settings.throttle_override:
        return Reason.REFUSED_THROTTLE_PRESSED
    return GRANTED


@kernel
def reset_refusal(asked: Asked, standing: bool) -> float:
    """Return 0 if a latched stop may be reset, else the `Reason` that refuses it."""
    if asked.emergency > 0.0 or asked.emergency_held > 0.0:
        return Reason.REFUSED_EMERGENCY
    return GRANTED if standing else Reason.REFUSED_MOVING


@kernel
def person_triggers(mode: float, person: Person, steering: bool, back_ticks: float, settings: ControlSettings) -> int:
    """Return the triggers that come from the cockpit alone.

    Args:
        mode: Before this tick.
        person: The person's side of it.
        steering: Whether they have taken the wheel.
        back_ticks: For how long a cockpit whose loss began this stop has been back, else infinite: one that comes and
            goes must not hand the car to and fro, so hands and feet take over only when it has been back for a while.
        settings: Thresholds.
    """
    if person.trusted == 0.0:
        needed = settings.person_required > 0.0 or mode in (Mode.MANUAL, Mode.SHARED)
        return bit(Trigger.DEVICE_LOST) if needed else 0
    present = bit(Trigger.PERSON_READY) if person.accelerator < settings.throttle_override else 0
    if back_ticks < settings.device_back_ticks:
        return present
    if person.brake >= settings.brake_override:
        present |= bit(Trigger.BRAKE)
    if steering:
        present |= bit(Trigger.STEERING)
    return present


@kernel
def fault_triggers(link: Link, events: int, no_reaction: bool, standing: bool) -> int:
    """Return the triggers that no request raises: faults, elapsed waits, standstill."""
    present = bit(Trigger.LOOP_STALL) if events & Event.LOOP_STALL != 0 else 0
    if events & Event.COMMANDER_LOST != 0:
        present |= bit(Trigger.COMMANDER_LOST)
    if link.invalid > 0.0:
        present |= bit(Trigger.COMMAND_INVALID)
    elif link.fresh == 0.0 or events & Event.NO_ANSWER != 0:
        present |= bit(Trigger.COMMAND_STALE)
    if no_reaction:
        present |= bit(Trigger.NO_REACTION)
    if standing:
        present |= bit(Trigger.STANDSTILL)
    return present


@kernel
def link_lost(events: int) -> bool:
    """Return whether the commander left, or did not answer, in this tick."""
    return events & (Event.COMMANDER_LOST | Event.NO_ANSWER) != 0


@kernel
def asked_triggers(asked: Asked, manual: float, reset: float, engage: float, shared: float) -> int:
    """Return the triggers of what was asked for and is not refused (refusals: 0 or a `Reason`)."""
    present = bit(Trigger.EMERGENCY) if asked.emergency > 0.0 else 0
    if asked.takeover > 0.0:
        present |= bit(Trigger.TAKEOVER_ASKED)
    if asked.manual > 0.0 and manual == GRANTED:
        present |= bit(Trigger.MANUAL_ASKED)
    if asked.reset > 0.0 and reset == GRANTED:
        present |= bit(Trigger.RESET)
    if asked.autonomous > 0.0 and engage == GRANTED:
        present |= bit(Trigger.AUTONOMOUS_ASKED)
    if asked.shared > 0.0 and shared == GRANTED:
        present |= bit(Trigger.SHARED_ASKED)
    return present


@kernel
def refusal_of(
    mode: float, after: float, asked: Asked, manual: float, reset: float, engage: float, shared: float
) -> float:
    """Return why a request of this tick was refused; 0 if none was, or what it asks for is in force.

    Args:
        mode: before this tick.
        after: after it: a stronger trigger may have overruled the request.
        asked: what was asked for.
        manual: 0, or the `Reason` against manual control in `mode`.
        reset: The same against a reset.
        engage: The same against autonomy.
        shared: The same against shared control.
    """
    if asked.manual > 0.0 and after != Mode.MANUAL:
        return _unmet(mode, after, manual, int(Trigger.MANUAL_ASKED))
    latched = mode in (Mode.EMERGENCY_STOP, Mode.STOPPED) or after in (Mode.EMERGENCY_STOP, Mode.STOPPED)
    if asked.reset > 0.0 and latched and after != Mode.PARKED:
        return reset if reset != GRANTED else _unmet(mode, after, reset, int(Trigger.RESET))
    if asked.autonomous > 0.0 and after != Mode.AUTONOMOUS:
        return _unmet(mode, after, engage, int(Trigger.AUTONOMOUS_ASKED))
    if asked.shared > 0.0 and after != Mode.SHARED:
        return _unmet(mode, after, shared, int(Trigger.SHARED_ASKED))
    return GRANTED


@kernel
def _unmet(mode: float, after: float, refusal: float, trigger: int) -> float:
    """Return why a request failed: a latched emergency stop, its own refusal, a stronger trigger, or the mode."""
    if after == Mode.EMERGENCY_STOP:
        return Reason.REFUSED_EMERGENCY
    if refusal != GRANTED:
        return refusal
    return Reason.REFUSED_OVERRULED if reacts(mode, trigger) else Reason.REFUSED_MODE
