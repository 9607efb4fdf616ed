"""From where a sound comes to how loud each of six loudspeakers plays it.

Columns are SDL's order of 5.1: front left, front right, centre, low frequencies, surround left, surround right. The
loudspeakers stand as ITU-R BS.775 has them. Gains of a direction have a sum of squares of 1 (amplitude panning between
the two loudspeakers beside it), so a sound that moves keeps its loudness.
"""

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

Samples = NDArray[np.float32]

CHANNELS: Final = 6
NAMES: Final = ("front left", "front right", "centre", "low frequencies", "surround left", "surround right")
FRONT_LEFT, FRONT_RIGHT, CENTRE, LOW, BACK_LEFT, BACK_RIGHT = range(CHANNELS)
_RING: Final = ((-110.0, BACK_RIGHT), (-30.0, FRONT_RIGHT), (0.0, CENTRE), (30.0, FRONT_LEFT), (110.0, BACK_LEFT))
"""Bearings in degrees, left-positive, and the loudspeaker that stands there; behind the driver stands none."""
FOLD: Final = math.sqrt(0.5)
"""What centre and surrounds have of left and right in two loudspeakers (ITU-R BS.775, table 2)."""


def samples(values: NDArray[np.float64]) -> Samples:
    """Return numbers as samples."""
    return values.astype(np.float32)


def gains(bearing_rad: float) -> tuple[float, ...]:
    """Return the six gains of a sound from `bearing_rad` (0 ahead, left-positive)."""
    bearing_deg = math.degrees(math.remainder(bearing_rad, 2.0 * math.pi))
    found = [0.0] * CHANNELS
    for place, (left_of_deg, first) in enumerate(_RING):
        next_deg, second = _RING[(place + 1) % len(_RING)]
        width_deg = (next_deg - left_of_deg) % 360.0
        offset_deg = (bearing_deg - left_of_deg) % 360.0
        if offset_deg < width_deg:
            share = 0.5 * math.pi * offset_deg / width_deg
            found[first], found[second] = math.cos(share), math.sin(share)
            break
    return tuple(found)


def to_stereo(block: Samples) -> Samples:
    """Return six columns as two: centre and surrounds folded in, low frequencies left out."""
    centre = FOLD * block[:, CENTRE]
    left = block[:, FRONT_LEFT] + centre + FOLD * block[:, BACK_LEFT]
    right = block[:, FRONT_RIGHT] + centre + FOLD * block[:, BACK_RIGHT]
    return np.stack((left, right), axis=1)
