"""How a vehicle keeps its distance: the Intelligent Driver Model.

Treiber, Hennecke, Helbing: Congested traffic states in empirical observations and microscopic simulations, Physical
Review E 62 (2000), 1805-1824, equations 3 and 4. Its parameters for towns are those of Treiber and Kesting: Traffic
Flow Dynamics, Springer 2013, table 11.2: 1 m/s2, 1.5 m/s2, 2 m, 1 s; time gap and desired speed differ by vehicle.
"""

import math
from typing import Final

from simconsole.values.kernels import kernel

ACCELERATION_MPS2: Final = 1.0
BRAKING_MPS2: Final = 1.5
STANDING_GAP_M: Final = 2.0
EMERGENCY_MPS2: Final = 8.0
_TWICE_ROOT: Final = 2.0 * 1.224744871391589  # 2 sqrt(ACCELERATION_MPS2 * BRAKING_MPS2)
_SLOWING_MPS2: Final = 2.5  # a lower limit alone makes nobody brake harder
NEAREST_M: Final = 0.1
FAR_M: Final = 1e6


@kernel
def acceleration(speed_mps: float, desired_mps: float, gap_m: float, leader_mps: float, time_gap_s: float) -> float:
    """Return the acceleration (m/s2) behind a leader `gap_m` ahead, FAR_M for none; at least -EMERGENCY_MPS2."""
    ratio = speed_mps / desired_mps
    free = ACCELERATION_MPS2 * (1.0 - ratio * ratio * ratio * ratio)
    if free < -_SLOWING_MPS2:
        free = -_SLOWING_MPS2
    if gap_m >= FAR_M:
        return free
    share = gap_share(gap_m, speed_mps, leader_mps, STANDING_GAP_M, time_gap_s, _TWICE_ROOT)
    found = free - ACCELERATION_MPS2 * share * share
    if found < -EMERGENCY_MPS2:
        found = -EMERGENCY_MPS2
    return found


@kernel
def gap_share(
    gap_m: float, speed_mps: float, leader_mps: float, standing_m: float, time_gap_s: float, twice_root_mps2: float
) -> float:
    """Return the gap that is wanted behind a leader, as a share of the one there is.

    Args:
        gap_m: bumper to bumper.
        speed_mps: the own speed.
        leader_mps: the leader's along the own way.
        standing_m: the gap to a leader that stands.
        time_gap_s: what is added to it at a constant speed.
        twice_root_mps2: twice the root of the product of acceleration and comfortable deceleration.
    """
    dynamic = speed_mps * time_gap_s + speed_mps * (speed_mps - leader_mps) / twice_root_mps2
    if dynamic < 0.0:
        dynamic = 0.0
    gap = gap_m
    if gap < NEAREST_M:
        gap = NEAREST_M
    return (standing_m + dynamic) / gap


@kernel
def clearing_s(speed_mps: float, way_m: float) -> float:
    """Return how long a vehicle takes for a way at ACCELERATION_MPS2."""
    a = ACCELERATION_MPS2
    return (math.sqrt(speed_mps * speed_mps + 2.0 * a * way_m) - speed_mps) / a
