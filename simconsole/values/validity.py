"""The states of an input as numbers of the kernels, and which of them may command. Pure kernel."""

from typing import Final

from simconsole.values.kernels import kernel
from simconsole.values.signals import Validity

UNKNOWN: Final = float(Validity.UNKNOWN)
ARMED: Final = float(Validity.ARMED)
LIVE: Final = float(Validity.LIVE)
STALE: Final = float(Validity.STALE)
LOST: Final = float(Validity.LOST)


@kernel
def is_trusted(validity: float) -> bool:
    """Return whether an input with this validity may command anything: armed or live."""
    return validity in (ARMED, LIVE)
