"""Who goes first where robots come near each other: one of two drives, the other one stands until it is past."""

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

from simconsole.values.platform import Pose

NEAR_M: Final = 0.6
"""Between the poses of two robots: nearer, only one of them drives."""
APART_M: Final = 0.75
"""From here on they are no longer near each other."""
TURN_S: Final = 8.0
"""So long one of them goes first, then the other one: whoever stands may be in the way."""


class Place(NamedTuple):
    """Where a robot is, and whether it is on its way to a goal."""

    pose: Pose
    is_under_way: bool


class RightOfWay:
    """Decides between robots by their poses."""

    def __init__(self) -> None:
        """Start with all of them apart."""
        self._near_since_s: dict[tuple[int, int], float] = {}

    def yields(self, me: int, time_s: float, places: Sequence[Place | None]) -> bool:
        """Return whether robot `me` stands for another one; None is the place of one that is not known yet."""
        return any(
            self._yields_to(me, other, time_s, places) for other in range(len(places)) if other != me and places[other]
        )

    def _yields_to(self, me: int, other: int, time_s: float, places: Sequence[Place | None]) -> bool:
        mine, theirs = places[me], places[other]
        if mine is None or theirs is None:
            return False
        pair = (min(me, other), max(me, other))
        apart_m = math.hypot(theirs.pose.x_m - mine.pose.x_m, theirs.pose.y_m - mine.pose.y_m)
        if apart_m > APART_M:
            self._near_since_s.pop(pair, None)
        if apart_m > NEAR_M and pair not in self._near_since_s:
            return False
        since_s = self._near_since_s.setdefault(pair, time_s)
        goes_first = pair[int((time_s - since_s) / TURN_S) % 2]
        return goes_first == other and theirs.is_under_way
