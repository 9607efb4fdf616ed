"""The plan of whoever drives over ROS, as lines and places for the operators. Pure arrays, no rerun."""

from collections.abc import Iterable
from typing import Final, NamedTuple

import numpy as np

from simconsole.scene.entities import Array, raised
from simconsole.values.planned_path import PlannedPath
from simconsole.values.units import NS_PER_S

KEPT_NS: Final = NS_PER_S
"""Simulated time for which a plan is shown that no other follows: who made it may be gone."""
LIFT_M: Final = 0.3
NOTHING: Final[Array] = np.empty((0, 3))


class PlanShapes(NamedTuple):
    """Plans one after the other; one without places takes the one before away."""

    times_ns: list[int]
    points: list[Array]  # each [N, 3] m


class Plans:
    """Follows the plans through a drive."""

    def __init__(self) -> None:
        self._shown_ns: int | None = None  # when the plan that is shown was made

    def until(self, t_ns: int, plans: Iterable[PlannedPath]) -> PlanShapes:
        """Return what changes up to `t_ns`, when `plans` are those since the last call in their order."""
        found = PlanShapes([], [])
        for plan in plans:
            self._end(plan.t_ns, found)
            found.times_ns.append(plan.t_ns)
            found.points.append(raised(plan.places[:, 1:], LIFT_M))
            self._shown_ns = plan.t_ns if len(plan.places) else None
        self._end(t_ns, found)
        return found

    def _end(self, t_ns: int, found: PlanShapes) -> None:
        if self._shown_ns is not None and t_ns > self._shown_ns + KEPT_NS:
            found.times_ns.append(self._shown_ns + KEPT_NS)
            found.points.append(NOTHING)
            self._shown_ns = None
