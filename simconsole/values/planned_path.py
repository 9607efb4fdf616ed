"""What a controller plans for the next seconds: places in `map`, each with its time."""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.units import NS_PER_S

Array = NDArray[np.float64]

FIELDS: Final = 4
"""Of a place: how long after the plan (s), then x, y and z (m)."""
MOST_PLACES: Final = 64
ENCODING: Final = f"float64[1+{FIELDS}n]"
"""Of a plan as a message: little-endian float64, its time in s, then its places."""
MOST_BYTES: Final = 8 * (1 + FIELDS * MOST_PLACES)


class PlannedPath(NamedTuple):
    """One plan; a controller that has none says so by one without places."""

    t_ns: int  # simulated time at which it was told
    places: Array  # [N, FIELDS], N at most MOST_PLACES


def to_bytes(plan: PlannedPath) -> bytes:
    """Return a plan as a message."""
    return np.concatenate(((plan.t_ns / NS_PER_S,), plan.places.ravel())).astype("<f8").tobytes()


def from_bytes(content: bytes) -> PlannedPath:
    """Return the plan of a message.

    Raises:
        ValueError: it is none.
    """
    if len(content) % 8 or len(content) > MOST_BYTES or len(content) // 8 % FIELDS != 1:
        raise ValueError(f"{len(content)} bytes: {ENCODING} of at most {MOST_PLACES} places")
    values = np.frombuffer(content, "<f8").astype(np.float64)
    if not np.isfinite(values).all():
        raise ValueError("a value is not finite")
    return PlannedPath(round(float(values[0]) * NS_PER_S), values[1:].reshape(-1, FIELDS))
