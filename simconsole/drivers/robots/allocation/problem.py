"""Tasks for robots: what each way costs, and what an allocation costs by two objectives.

Robots start at their places, do their tasks one after the other and stay at the last one.
"""

from collections.abc import Sequence
from enum import Enum
from typing import NamedTuple, TypeAlias

Tours: TypeAlias = tuple[tuple[int, ...], ...]
"""The tasks of each robot, in their order."""


class Objective(Enum):
    """What is made as small as possible."""

    SUM = "sum"  # of all ways: what is driven
    MAKESPAN = "makespan"  # the longest of the ways: when all is done


class Problem(NamedTuple):
    """Costs in m (or s): `start[r][t]` from robot r to task t, `between[a][b]` from task a to task b."""

    start: tuple[tuple[float, ...], ...]
    between: tuple[tuple[float, ...], ...]

    @property
    def robots(self) -> int:
        """How many robots there are."""
        return len(self.start)

    @property
    def tasks(self) -> int:
        """How many tasks there are."""
        return len(self.between)

    def way(self, robot: int, tour: Sequence[int]) -> float:
        """Return what a robot's tour costs, 0 for none."""
        if not tour:
            return 0.0
        cost = self.start[robot][tour[0]]
        for a, b in zip(tour, tour[1:], strict=False):  # noqa: RUF007  pairwise takes longer on these few
            cost += self.between[a][b]
        return cost

    def cost(self, tours: Tours, objective: Objective) -> float:
        """Return what an allocation costs."""
        ways = [self.way(robot, tour) for robot, tour in enumerate(tours)]
        return sum(ways) if objective is Objective.SUM else max(ways)

    def is_complete(self, tours: Tours) -> bool:
        """Return whether every task is done by one robot, once."""
        return len(tours) == self.robots and sorted(task for tour in tours for task in tour) == list(range(self.tasks))

    def without(self, robot: int) -> "Problem":
        """Return the problem that is left when a robot has failed; the others' numbers close up."""
        return self._replace(start=(*self.start[:robot], *self.start[robot + 1 :]))


class Allocation(NamedTuple):
    """What a method found."""

    tours: Tours
    cost: float


def problem_of(robots: Sequence[tuple[float, float]], tasks: Sequence[tuple[float, float]]) -> Problem:
    """Return a problem whose ways are straight lines between places (x, y in m)."""
    return Problem(
        start=tuple(tuple(_apart(robot, task) for task in tasks) for robot in robots),
        between=tuple(tuple(_apart(a, b) for b in tasks) for a in tasks),
    )


def _apart(a: tuple[float, float], b: tuple[float, float]) -> float:
    return float(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5)
