"""How whoever drives keeps behind the vehicle ahead. Pure.

The Intelligent Driver Model, as of traffic (`world/traffic/following.py`), without its free-road term, which the speed
plan of the road takes the place of.
"""

import math
from typing import NamedTuple

from simconsole.world.traffic.following import gap_share


class Following(NamedTuple):
    """How somebody follows."""

    gap_m: float  # to a vehicle that stands
    headway_s: float
    accelerate_mps2: float
    brake_mps2: float  # what counts as comfortable
    hardest_mps2: float


def following_mps2(gap_m: float, lead_mps: float, speed_mps: float, how: Following) -> float:
    """Return the acceleration that a vehicle ahead allows, from -hardest_mps2 to accelerate_mps2.

    Args:
        gap_m: bumper to bumper; infinite where nobody is ahead.
        lead_mps: its speed along the own way.
        speed_mps: the own speed.
        how: what is kept.
    """
    if gap_m == math.inf:
        return how.accelerate_mps2
    twice_root = 2.0 * math.sqrt(how.accelerate_mps2 * how.brake_mps2)
    share = gap_share(gap_m, speed_mps, lead_mps, how.gap_m, how.headway_s, twice_root)
    return max(-how.hardest_mps2, how.accelerate_mps2 * (1.0 - share * share))
