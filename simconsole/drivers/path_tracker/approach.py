"""The way back to the path: from an offset that is too large to correct at once, a smooth line that ends on it.

Where it would lead too far from the path, or the car heads elsewhere, no command is given (`why_not`).
"""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.kernels import clip
from simconsole.values.numerics.array_functions import exponential
from simconsole.values.units import RAD_PER_DEG

Array = NDArray[np.float64]

_SHORTEST_M: Final = 3.0
_TIME_S: Final = 0.7
_LATERAL_MPS2: Final = 1.0
_LATERAL_JERK_MPS3: Final = 2.0
_STEEPEST: Final = 0.5
_STANDING_MPS: Final = 2.0
"""Slower than this the wheels turn faster than the car moves: the line need not begin with the car's own curvature."""
FURTHEST_M: Final = 1.3
"""No way back is begun that leads further than this from the path."""
MOST_HEADING_RAD: Final = 25.0 * RAD_PER_DEG
"""Nor one that begins with a larger angle: from a standstill the car could not keep to it."""
_OVER_LENGTHS: Final = 40.0
"""Of an offset of a metre a few femtometres are left here, less than any position is rounded by."""
LEFT_M: Final = 3.0
"""A car that is driven and finds itself further away than this has not been brought there by its own commands."""
_LOOK_LENGTHS: Final = tuple(0.25 * part for part in range(1, 17))


class Approach(NamedTuple):
    """An offset from the path that decays over distance with a triple pole: (p + q x + r x^2) exp(-x / length).

    Offset, slope and curvature are continuous from where the car was, how it was heading and how it was turning.
    """

    start_m: float  # position along the path
    length_m: float
    offset_m: float  # p
    rate: float  # q, in m per m
    bend_1pm: float = 0.0  # r

    def at(self, s_m: float) -> tuple[float, float]:
        """Return (offset in m, slope against the path) at `s_m`."""
        x = max(s_m - self.start_m, 0.0)
        decay = math.exp(-x / self.length_m)
        bracket = self.offset_m + (self.rate + self.bend_1pm * x) * x
        return bracket * decay, (self.rate + 2.0 * self.bend_1pm * x - bracket / self.length_m) * decay

    def is_over(self, s_m: float) -> bool:
        """Return whether nothing of the line is left at `s_m` and after it."""
        return s_m - self.start_m > _OVER_LENGTHS * self.length_m or (
            self.offset_m == 0.0 and self.rate == 0.0 and self.bend_1pm == 0.0
        )

    @property
    def furthest_m(self) -> float:
        """How far the line gets from the path (m)."""
        places = (self.start_m + self.length_m * lengths for lengths in _LOOK_LENGTHS)
        return max(abs(self.offset_m), *(abs(self.at(place)[0]) for place in places))

    def curvature(self, s_m: Array) -> Array:
        """Return the curvature (1/m) that the line adds to the path's at `s_m` [N], small slopes assumed."""
        x = np.maximum(s_m - self.start_m, 0.0)
        bracket = self.offset_m + (self.rate + self.bend_1pm * x) * x
        slope = self.rate + 2.0 * self.bend_1pm * x
        added = 2.0 * self.bend_1pm - 2.0 * slope / self.length_m + bracket / self.length_m**2
        return np.asarray(added * exponential(-x / self.length_m))


ON_PATH: Final = Approach(0.0, _SHORTEST_M, 0.0, 0.0)


def approach_from(
    s_m: float, offset_m: float, heading_rad: float, speed_mps: float, curvature_1pm: float = 0.0
) -> Approach:
    """Return the line from a pose beside the path; it asks for about 1 m/s2 and 2 m/s3 at most, and for at least 3 m.

    `curvature_1pm` is what the car drives now, less the path's.
    """
    slope = math.tan(clip(heading_rad, -_STEEPEST, _STEEPEST))
    bend = speed_mps * math.sqrt(0.25 * abs(offset_m) / _LATERAL_MPS2)  # 0.23 p / length^2: the most of f''
    twist = speed_mps * math.cbrt(abs(offset_m) / _LATERAL_JERK_MPS3)  # p / length^3: f''' at the start
    length = max(_SHORTEST_M, _TIME_S * speed_mps, bend, twist)
    rate = slope + offset_m / length
    if speed_mps < _STANDING_MPS:
        return Approach(s_m, length, offset_m, rate)
    curved = 0.5 * (curvature_1pm + 2.0 * rate / length - offset_m / length**2)
    return Approach(s_m, length, offset_m, rate, curved)


def why_not(offset_m: float, heading_rad: float, speed_mps: float, engaged: bool) -> str:
    """Return why the car is not to be led back to the path from here, in words; empty where it is.

    Args:
        offset_m: left of the path.
        heading_rad: turned left of the path.
        speed_mps: forward.
        engaged: whether the car is being driven already: then it is on its way back.
    """
    if engaged:
        if abs(offset_m) > LEFT_M:
            return f"the car is {abs(offset_m):.1f} m beside the course, at most {LEFT_M:g} m"
        return ""
    if abs(heading_rad) > MOST_HEADING_RAD:
        turned_deg, most_deg = abs(heading_rad) / RAD_PER_DEG, MOST_HEADING_RAD / RAD_PER_DEG
        return f"the car is turned {turned_deg:.0f} deg from the course, at most {most_deg:g} deg"
    furthest_m = approach_from(0.0, offset_m, heading_rad, max(speed_mps, 0.0)).furthest_m
    if furthest_m > FURTHEST_M:
        return f"the way back leads {furthest_m:.1f} m from the course, at most {FURTHEST_M:g} m"
    return ""
