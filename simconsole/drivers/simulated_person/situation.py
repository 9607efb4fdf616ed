"""What a person sees of other road users and signals ahead on their way. Pure."""

import math
from collections.abc import Callable
from enum import IntEnum
from typing import Final, NamedTuple

from simconsole.values.state_vector import Snapshot


class Light(IntEnum):
    """What the next signal on the way shows."""

    NONE = 0
    GREEN = 1
    AMBER = 2
    RED = 3


class Situation(NamedTuple):
    """What is ahead; distances are from the front of one's own car, infinite where there is nothing."""

    lead_gap_m: float = math.inf  # to the rear of the vehicle ahead in the lane
    lead_speed_mps: float = 0.0
    light: float = float(Light.NONE)
    line_m: float = math.inf  # to the line at which the light is obeyed
    yield_m: float = math.inf  # to where to wait for somebody with right of way; infinite while nobody has it


NOTHING_AHEAD: Final = Situation()

Look = Callable[[Snapshot], Situation]
"""What is ahead in a snapshot."""


def empty_road(snapshot: Snapshot) -> Situation:
    """Return a situation with nobody ahead: that of a world without traffic and signals."""
    return NOTHING_AHEAD
