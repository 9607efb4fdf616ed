"""Several robots with one task: they make the whole map known, share out the targets, and go to them."""

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np

from simconsole.drivers.robots.allocation.exact import optimum
from simconsole.drivers.robots.allocation.problem import Allocation, Objective, Problem
from simconsole.drivers.robots.fleet.right_of_way import Place, RightOfWay
from simconsole.drivers.robots.navigation import planner as planning
from simconsole.drivers.robots.navigation.mission import Mission, Target, Visit, problem_by
from simconsole.drivers.robots.navigation.navigator import Navigator
from simconsole.drivers.robots.navigation.planner import Surface
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.values.platform import Pose
from simconsole.world.arena.occupancy import FREE, OCCUPIED, Grid

TRACE_M: Final = 0.03
"""Around a robot that stands: what others have seen of it is in the map, and nothing else can be so near."""
NOTHING: Final[Array] = np.empty((0, 2))


class Shared(NamedTuple):
    """How the targets were shared out."""

    problem: Problem
    allocation: Allocation  # proven to be the best


class Team:
    """The robots of one program.

    Attributes:
        members: one for each navigator, in their order.
        explored_s: when the map was complete; None before.
        shared: how the targets were shared out; None before.
    """

    def __init__(
        self, navigators: Sequence[Navigator], targets: Sequence[Target], objective: Objective = Objective.SUM
    ) -> None:
        """Send the robots round; `objective` is what the allocation makes as small as possible."""
        self.explored_s: float | None = None
        self.shared: Shared | None = None
        self.targets = list(targets)
        self._objective = objective
        self._way = RightOfWay()
        self.members = [Member(self, number, navigator) for number, navigator in enumerate(navigators)]

    @property
    def is_done(self) -> bool:
        """Whether all targets have been gone to."""
        return self.shared is not None and all(member.mission.is_done for member in self.members)

    @property
    def tasks_done(self) -> int:
        """How many targets have been gone to."""
        return sum(len(member.visits) for member in self.members)

    def yields(self, number: int, time_s: float, pose: Pose) -> bool:
        """Return whether a robot stands for another one."""
        self.members[number].pose = pose
        return self._way.yields(number, time_s, [member.place for member in self.members])

    def frontiers_beside(self, number: int) -> list[planning.Place]:
        """Return the frontiers that the other robots are on their way to."""
        found = (member.mission.frontier for member in self.members if member.number != number)
        return [frontier for frontier in found if frontier is not None]

    def share_out(self, time_s: float, surface: Callable[[], Surface | None]) -> None:
        """Share the targets out once all have explored."""
        if self.shared is not None or not all(member.mission.is_done for member in self.members):
            return
        ground, starts = surface(), [member.pose for member in self.members]
        if ground is None or None in starts:
            return
        places = [(pose.x_m, pose.y_m) for pose in starts if pose is not None]
        tasks = [(target.x_m, target.y_m) for target in self.targets]
        planner = self.members[0].navigator.planner
        empty = planner.surface(without_robots(ground.grid, places, planner.touch_m + TRACE_M), NOTHING)
        problem = problem_by(planner, empty, places, tasks)
        self.explored_s = time_s
        self.shared = Shared(problem, optimum(problem, self._objective))
        for member, tour in zip(self.members, self.shared.allocation.tours, strict=True):
            member.go([self.targets[task] for task in tour])


class Member:
    """One robot of a team: gives its navigator goals as `Mission` does."""

    def __init__(self, team: Team, number: int, navigator: Navigator) -> None:
        """Begin with exploring."""
        self.number = number
        self.navigator = navigator
        self.pose: Pose | None = None
        self.mission = Mission(navigator, (), taken=lambda: team.frontiers_beside(number))
        self._team = team

    @property
    def place(self) -> Place | None:
        """Where it is; None: not known yet."""
        return None if self.pose is None else Place(self.pose, self.navigator.goal is not None)

    @property
    def visits(self) -> list[Visit]:
        """The targets that it has gone to."""
        return self.mission.visits if self._team.shared is not None else []

    def go(self, targets: Sequence[Target]) -> None:
        """Go to these targets, in the cheapest order."""
        self.mission = Mission(self.navigator, targets, explores=False)

    def step(self, time_s: float, pose: Pose, points_m: Array) -> None:
        """Give the navigator its next goal where it needs one (`Mission.step`)."""
        self.pose = pose
        self.mission.step(time_s, pose, points_m)
        # By the map alone: where the others stand now they will not stand when somebody drives there.
        self._team.share_out(time_s, lambda: self.navigator.surface(pose, points_m[:0]))


def without_robots(grid: Grid, places: Sequence[planning.Place], radius_m: float) -> Grid:
    """Return a map whose cells within `radius_m` of these places, where robots stand, are free."""
    rows, columns = np.indices(grid.cells.shape)
    x_m = grid.x_m + (columns + 0.5) * grid.resolution_m
    y_m = grid.y_m + (rows + 0.5) * grid.resolution_m
    cells = grid.cells.copy()
    for x, y in places:
        cells[(np.hypot(x_m - x, y_m - y) < radius_m) & (cells == OCCUPIED)] = FREE
    return grid._replace(cells=cells)
