"""The states of an input as numbers of the kernels, which of them may command, and what a torque says of a will."""

from typing import Final

from simconsole.values.kernels import kernel
from simconsole.values.signals import Validity

UNKNOWN: Final = float(Validity.UNKNOWN)
ARMED: Final = float(Validity.ARMED)
LIVE: Final = float(Validity.LIVE)
STALE: Final = float(Validity.STALE)
LOST: Final = float(Validity.LOST)
RESTING_HANDS_KGM2: Final = 0.02
"""Moment of inertia of two hands that rest on a rim: each 0.6 % of 75 kg (de Leva 1996), at 0.15 m."""


@kernel
def is_trusted(validity: float) -> bool:
    """Return whether an input with this validity may command anything: armed or live."""
    return validity in (ARMED, LIVE)


@kernel
def wilful_torque(human_nm: float, hand_wheel_radps2: float) -> float:
    """Return how much of a person's torque may be meant, in N m, 0 or more.

    Hands that only rest on the rim have a mass, which a wheel that its motor turns fast speeds up and slows down: that
    torque is theirs and no wish. It is left out where it explains some of what is seen, and never adds to it.

    Args:
        human_nm: The person's torque, estimated, left-positive.
        hand_wheel_radps2: The wheel's angular acceleration.
    """
    size_nm, wilful_nm = abs(human_nm), abs(human_nm + RESTING_HANDS_KGM2 * hand_wheel_radps2)
    return wilful_nm if wilful_nm < size_nm else size_nm
