"""How far a reading may be trusted: range, age, and the way from unknown over armed to live. Pure kernels."""

from typing import Final

from simconsole.values.kernels import is_finite, kernel
from simconsole.values.signals import NEVER_TICKS
from simconsole.values.validity import ARMED, LIVE, LOST, STALE, UNKNOWN

RAW_LIMIT: Final = 1.01
"""Largest |raw axis| that is taken: pygame's event scale overshoots to 1.00003 (pygame 2.6.1, measured)."""
MASK_LIMIT: Final = 16_777_216.0
"""Button masks are whole numbers below 2**24."""


@kernel
def axis_good(raw: float) -> bool:
    """Return whether a raw axis may be used. Finiteness first: NaN passes every comparison."""
    if not is_finite(raw):
        return False
    return -RAW_LIMIT <= raw <= RAW_LIMIT


@kernel
def mask_good(mask: float) -> bool:
    """Return whether a button mask is a whole number in range."""
    if not is_finite(mask):
        return False
    if mask < 0.0 or mask >= MASK_LIMIT:
        return False
    return float(int(mask)) == mask


@kernel
def heard(age_ticks: float, stale_ticks: float) -> bool:
    """Return whether a device has answered lately; False for an age that is not finite."""
    if not is_finite(age_ticks):
        return False
    return 0.0 <= age_ticks <= stale_ticks


@kernel
def next_validity(previous: float, age_ticks: float, refused_ticks: float, stale_ticks: float, at_rest: bool) -> float:
    """Return how far one input may be trusted after this tick.

    unknown -> armed (seen at rest) -> live; held beyond `stale_ticks` -> stale; device gone -> lost. From unknown
    and lost only rest leads on, so that a device that comes back pressed commands nothing.

    Args:
        previous: Validity before.
        age_ticks: Since the last successful poll; NEVER_TICKS: the device is gone.
        refused_ticks: Ticks in a row in which this reading was refused, 0 if it is good now.
        stale_ticks: How long a value is held.
        at_rest: The reading is good and at rest.
    """
    usable = previous in (ARMED, LIVE, STALE)
    if not is_finite(age_ticks) or age_ticks < 0.0 or age_ticks >= NEVER_TICKS:
        return UNKNOWN if previous == UNKNOWN else LOST
    if age_ticks > stale_ticks or refused_ticks > stale_ticks:
        return STALE if usable else previous
    if refused_ticks > 0.0:
        return previous
    if usable:
        return LIVE
    return ARMED if at_rest else UNKNOWN
