"""The oracle on whose act it was, on a cockpit that is back after its loss, and on what a number is."""

from typing import Final

import numpy as np

from simconsole.values.kernels import Row, is_finite, kernel
from simconsole.values.signals import Button, Event, Reason, RemoteCommand
from tests.control.oracle_rules import (
    B_RESET,
    B_STOP,
    BACK,
    BY_LOSS,
    DEVICE_LOST,
    EFFECT,
    EMERGENCY,
    MINIMAL,
    MODE,
    REASONS,
    RESET,
    TAKEOVER_ASKED,
    TOLD_RESET,
    TOLD_STOP,
    TOLD_TAKEOVER,
    Rules,
)

_OPERATOR: Final = int(Event.OPERATOR)
_TAKEOVER_BUTTON: Final = int(Button.TAKEOVER)
_REASONS: Final = np.array([float(reason) for reason in REASONS])


@kernel
def all_finite(command: RemoteCommand) -> bool:
    """Return whether every number of a command is one."""
    for value in command:  # noqa: SIM110 - a kernel has no generators
        if not is_finite(value):
            return False
    return True


@kernel
def note_whose(o: Row, mask: float, edges: float, pressed: float) -> None:
    """Remember what each act of this tick would be told as: the person's button goes before the operator's flag."""
    operator = int(mask) & _OPERATOR != 0
    button = int(edges) & int(B_STOP) != 0 or int(pressed) & int(B_STOP) != 0
    o[TOLD_STOP] = float(Reason.OPERATOR_EMERGENCY) if operator and not button else float(Reason.EMERGENCY)
    button = int(edges) & int(B_RESET) != 0
    o[TOLD_RESET] = float(Reason.OPERATOR_RESET) if operator and not button else float(Reason.RESET)
    o[TOLD_TAKEOVER] = float(Reason.OPERATOR_ASKED) if operator else float(Reason.REMOTE_ASKED)
    if int(edges) & _TAKEOVER_BUTTON != 0:
        o[TOLD_TAKEOVER] = float(Reason.PERSON_ASKED)


@kernel
def told_reason(o: Row) -> float:
    """Return the reason that belongs to what took effect in this tick."""
    effect = int(o[EFFECT])
    if effect == EMERGENCY:
        return float(o[TOLD_STOP])
    if effect == RESET:
        return float(o[TOLD_RESET])
    return float(o[TOLD_TAKEOVER]) if effect == TAKEOVER_ASKED else float(_REASONS[effect])


@kernel
def hands_count(o: Row, trusted: bool, r: Rules) -> bool:
    """Return whether brake and wheel may take over: after a loss only once the cockpit is back for good."""
    o[BACK] = o[BACK] + 1.0 if trusted else 0.0
    return bool(o[MODE] != MINIMAL or o[BY_LOSS] == 0.0 or o[BACK] >= r.back_ticks)


@kernel
def note_loss(o: Row) -> None:
    """Remember, where a safe stop begins, whether it began because wheel or pedals were lost."""
    if o[MODE] == MINIMAL and o[EFFECT] >= 0.0:
        o[BY_LOSS] = 1.0 if o[EFFECT] == DEVICE_LOST else 0.0
