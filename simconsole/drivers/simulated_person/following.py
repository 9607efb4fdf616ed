"""How a person drives up to a line, and how close behind others. Pure.

They follow as of `drivers/car_following.py`. A line to stop at is a standing vehicle. At amber a driver stops who can
do so gently enough: the deceleration of the dilemma zone, Gazis, Herman and Maradudin, "The problem of the amber signal
light in traffic flow", Operations Research 8 (1960) 112-132.
"""

import math
from typing import Final

from simconsole.drivers.car_following import Following
from simconsole.drivers.simulated_person.situation import Light, Situation
from simconsole.profiles.person import RoadHabits
from simconsole.world.traffic.following import NEAREST_M

AMBER_MPS2: Final = 3.0
"""Who would have to brake harder than this for amber drives on."""
HARDEST_MPS2: Final = 8.0


def following(road: RoadHabits) -> Following:
    """Return how a person of these habits follows."""
    return Following(
        gap_m=road.gap_m,
        headway_s=road.headway_s,
        accelerate_mps2=road.accelerate_mps2,
        brake_mps2=road.brake_mps2,
        hardest_mps2=HARDEST_MPS2,
    )


def stopping_mps2(line_m: float, speed_mps: float, road: RoadHabits) -> float:
    """Return the acceleration with which to stop `gap_m` before a line; at most accelerate_mps2.

    As behind a standing vehicle, but without a headway: nobody keeps one to a line.
    """
    if line_m == math.inf:
        return road.accelerate_mps2
    left_m = line_m - road.gap_m
    if left_m <= NEAREST_M:
        return -road.brake_mps2 if speed_mps < 1.0 else -HARDEST_MPS2
    needed_mps2 = speed_mps * speed_mps / (2.0 * left_m)
    if needed_mps2 >= road.brake_mps2:
        return -min(HARDEST_MPS2, needed_mps2)
    near = math.sqrt(2.0 * road.brake_mps2 * left_m)
    return min(road.accelerate_mps2, 0.5 * (near - speed_mps))


class Obedience:
    """Whether the person stops at the next signal: at amber they decide once."""

    def __init__(self) -> None:
        self._passes_amber = False

    def must_stop(self, seen: Situation, speed_mps: float) -> bool:
        """Return whether the light ahead has to be stopped at."""
        if seen.light == Light.RED:
            return True
        if seen.light != Light.AMBER:
            self._passes_amber = False
            return False
        if not self._passes_amber and seen.line_m < math.inf:
            self._passes_amber = speed_mps * speed_mps > 2.0 * AMBER_MPS2 * max(seen.line_m, NEAREST_M)
        return not self._passes_amber
