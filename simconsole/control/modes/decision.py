"""The mode of this tick, and why: guards, the mode table, refusals shown for a while."""

import math
from typing import NamedTuple

from simconsole.control.modes.engage import GRANTED, engage_refusal
from simconsole.control.modes.mode_table import Trigger, outcome, reason_of
from simconsole.control.modes.triggers import (
    Asked,
    asked_of,
    asked_triggers,
    fault_triggers,
    manual_refusal,
    person_triggers,
    refusal_of,
    reset_refusal,
)
from simconsole.control.requests.commander import Controllers
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import Person
from simconsole.control.requests.tick_context import TickContext
from simconsole.values.kernels import kernel
from simconsole.values.signals import MOTOR_UNKNOWN, Link, Mode, Reason


class Decision(NamedTuple):
    """The mode of this tick."""

    mode: float
    reason: float
    changed: float  # 1: entered in this tick
    refusal: float
    refusal_ticks: float
    wait_begins: float  # 1: the wait for the person's reaction, or for a lost cockpit to be back, begins in this tick


@kernel
def decide(now: TickContext, person: Person, controllers: Controllers, steering: bool, standing: bool) -> Decision:
    """Decide the mode of this tick.

    Args:
        now: This tick.
        person: The person's side of it.
        controllers: The controllers' side of it.
        steering: Whether the person has taken the wheel.
        standing: Whether the vehicle has stood for long enough.
    """
    mode = now.before.mode
    settings = now.settings
    link = controllers.link
    asked = asked_of(now.driver, controllers.events)
    manual = manual_refusal(mode, person, settings)
    reset = reset_refusal(asked, standing)
    engage = engage_refusal(
        mode,
        person,
        link,
        controllers.remote,
        controllers.offered.road_wheel_rad,
        now.command_before.road_wheel_rad,
        now.vehicle,
        settings,
    )
    shared = engage if engage != GRANTED else manual
    if engage == GRANTED and now.wheel_motor == MOTOR_UNKNOWN:
        engage = float(Reason.REFUSED_WHEEL_UNKNOWN)
    waited = mode == Mode.TAKEOVER_REQUESTED and now.memory.mode_ticks + 1.0 >= settings.minimal_risk_ticks
    # A lost cockpit that is back ends the wait, not the request: autonomy needs an act of a person or an operator.
    no_reaction = waited and not (now.before.reason == Reason.DEVICE_LOST and person.trusted > 0.0)
    lost = mode == Mode.MINIMAL_RISK and now.before.reason == Reason.DEVICE_LOST
    back_ticks = now.memory.mode_ticks + 1.0 if lost else math.inf
    present = person_triggers(mode, person, steering, back_ticks, settings)
    present |= fault_triggers(link, controllers.events, no_reaction, standing)
    present |= asked_triggers(asked, manual, reset, engage, shared)
    after, trigger = outcome(mode, present)
    refusal = refusal_of(mode, after, asked, manual, reset, engage, shared)
    if refusal == GRANTED and controllers.unheard:
        refusal = Reason.REFUSED_NOT_COMMANDER
    if trigger >= 0:
        return Decision(
            mode=after,
            reason=_reason(after, trigger, asked),
            changed=1.0,
            refusal=refusal,
            refusal_ticks=0.0,
            wait_begins=1.0,
        )
    return _unchanged(now, person, asked, link, lost, refusal)


@kernel
def _unchanged(now: TickContext, person: Person, asked: Asked, link: Link, lost: bool, refusal: float) -> Decision:
    """Return the mode as it was, with its reason, and the refusal of this tick or the one that is still shown."""
    mode = now.before.mode
    settings = now.settings
    reason = now.before.reason
    wait_begins = 1.0 if lost and person.trusted == 0.0 else 0.0  # until the cockpit is back for good
    if mode == Mode.TAKEOVER_REQUESTED and asked.takeover > 0.0 and reason == Reason.DEVICE_LOST:
        # A take-over was requested again: then the request does not end with its first cause. Where that was a lost
        # cockpit that is back by now, the first wait has ended, and the new request begins a wait of its own.
        wait_begins = 1.0 if person.trusted > 0.0 else 0.0
        reason = asked.takeover_reason
    driven = mode in (Mode.SHARED, Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED)
    if refusal == GRANTED and link.implausible_ticks > 0.0 and driven:
        refusal = Reason.REFUSED_IMPLAUSIBLE
    if refusal != GRANTED:
        return Decision(
            mode=mode, reason=reason, changed=0.0, refusal=refusal, refusal_ticks=0.0, wait_begins=wait_begins
        )
    shown = now.memory.refusal_ticks + 1.0 < settings.refusal_ticks
    if now.before.refusal != GRANTED and shown:
        return Decision(
            mode=mode,
            reason=reason,
            changed=0.0,
            refusal=now.before.refusal,
            refusal_ticks=now.memory.refusal_ticks + 1.0,
            wait_begins=wait_begins,
        )
    return Decision(mode=mode, reason=reason, changed=0.0, refusal=GRANTED, refusal_ticks=0.0, wait_begins=wait_begins)


@kernel
def _reason(after: float, trigger: int, asked: Asked) -> float:
    requested = after == Mode.TAKEOVER_REQUESTED and asked.takeover > 0.0
    if requested or trigger == Trigger.TAKEOVER_ASKED:
        return asked.takeover_reason  # not a loss in the same tick: the request stays when that is over
    if trigger == Trigger.EMERGENCY:
        return asked.emergency_reason
    if trigger == Trigger.RESET:
        return asked.reset_reason
    reason = reason_of(trigger)
    return Reason.OPERATOR_ASKED if reason == Reason.PERSON_ASKED and asked.by_person == 0.0 else reason


@kernel
def takeover_stage(mode: float, mode_ticks: float, settings: ControlSettings) -> float:
    """Return how urgently the person is asked to take over: 0 not, 1 asked, 2 escalated."""
    if mode != Mode.TAKEOVER_REQUESTED:
        return 0.0
    return 2.0 if mode_ticks >= settings.escalation_ticks else 1.0
