"""The way back to the path: from an offset that is too large to correct at once, a smooth line that ends on it."""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.kernels import clip

Array = NDArray[np.float64]

_SHORTEST_M: Final = 8.0
_TIME_S: Final = 1.0
_LATERAL_MPS2: Final = 1.0
_STEEPEST: Final = 0.5


class Approach(NamedTuple):
    """An offset from the path that decays over distance like a critically damped system: (p + q x) exp(-x / length).

    Offset, slope and curvature are continuous from where the car was and how it was heading.
    """

    start_m: float  # position along the path
    length_m: float
    offset_m: float  # p
    rate: float  # q, in m per m

    def at(self, s_m: float) -> tuple[float, float]:
        """Return (offset in m, slope against the path) at `s_m`."""
        x = max(s_m - self.start_m, 0.0)
        decay = math.exp(-x / self.length_m)
        bracket = self.offset_m + self.rate * x
        return bracket * decay, (self.rate - bracket / self.length_m) * decay

    def curvature(self, s_m: Array) -> Array:
        """Return the curvature (1/m) that the line adds to the path's at `s_m` [N], small slopes assumed."""
        x = np.maximum(s_m - self.start_m, 0.0)
        bracket = self.offset_m + self.rate * x
        return np.asarray((bracket / self.length_m - 2.0 * self.rate) / self.length_m * np.exp(-x / self.length_m))


ON_PATH: Final = Approach(0.0, _SHORTEST_M, 0.0, 0.0)


def approach_from(s_m: float, offset_m: float, heading_rad: float, speed_mps: float) -> Approach:
    """Return the line from a pose beside the path; it asks for about 1 m/s2 at most and for at least 8 m."""
    bend = speed_mps * math.sqrt(abs(offset_m) / _LATERAL_MPS2)
    length = max(_SHORTEST_M, _TIME_S * speed_mps, bend)
    slope = math.tan(clip(heading_rad, -_STEEPEST, _STEEPEST))
    return Approach(s_m, length, offset_m, slope + offset_m / length)
