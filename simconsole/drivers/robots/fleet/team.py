"""Several robots with one task: they make the whole map known, share out the targets, and go to them.

Where a robot fails, the others share out what it has left undone.
"""

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np

from simconsole.drivers.robots.allocation.exact import optimum
from simconsole.drivers.robots.allocation.problem import Allocation, Objective, Problem
from simconsole.drivers.robots.fleet.right_of_way import Place, RightOfWay
from simconsole.drivers.robots.navigation import planner as planning
from simconsole.drivers.robots.navigation.mission import Mission, Target, Visit, ways_m
from simconsole.drivers.robots.navigation.navigator import Navigator
from simconsole.drivers.robots.navigation.planner import Surface
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.values.platform import Pose
from simconsole.world.arena.occupancy import FREE, OCCUPIED, Grid

TRACE_M: Final = 0.03
"""Around a robot that stands: what others have seen of it is in the map, and nothing else can be so near."""
GONE_S: Final = 5.0
"""A robot that has not driven by commands for so long, or has told nothing, has failed."""
NOTHING: Final[Array] = np.empty((0, 2))


class Circle(NamedTuple):
    """What a robot that stands takes of the map."""

    x_m: float
    y_m: float
    radius_m: float


class Shared(NamedTuple):
    """How the open targets were shared out."""

    time_s: float
    robots: tuple[int, ...]  # who took part; the problem counts them from 0
    tasks: tuple[int, ...]  # the open ones, likewise
    problem: Problem
    allocation: Allocation  # proven to be the best

    def tour(self, number: int) -> list[int]:
        """Return the tasks of a robot, none for one that took no part."""
        if number not in self.robots:
            return []
        return [self.tasks[task] for task in self.allocation.tours[self.robots.index(number)]]

    def planned_m(self, number: int) -> float:
        """Return the length of a robot's tour."""
        if number not in self.robots:
            return 0.0
        place = self.robots.index(number)
        return self.problem.way(place, self.allocation.tours[place])


class Team:
    """The robots of one program.

    Attributes:
        members: one for each navigator, in their order.
        shares: how the targets were shared out, and each time again when a robot had failed.
    """

    def __init__(
        self, navigators: Sequence[Navigator], targets: Sequence[Target], objective: Objective = Objective.SUM
    ) -> None:
        """Send the robots round; `objective` is what the allocation makes as small as possible."""
        self.shares: list[Shared] = []
        self.targets = list(targets)
        self._objective = objective
        self._way = RightOfWay()
        self.members = [Member(self, number, navigator) for number, navigator in enumerate(navigators)]

    @property
    def explored_s(self) -> float | None:
        """When the map was complete; None before."""
        return self.shares[0].time_s if self.shares else None

    @property
    def living(self) -> "list[Member]":
        """The robots that have not failed."""
        return [member for member in self.members if member.failed_s is None]

    @property
    def is_done(self) -> bool:
        """Whether all targets have been gone to, or no robot is left."""
        living = self.living
        done = all(member.mission.is_done for member in living)
        return not living or (bool(self.shares) and done and not self._must_share())

    @property
    def tasks_done(self) -> int:
        """How many targets have been gone to."""
        return sum(len(member.visits) for member in self.members)

    def hear(self, number: int, time_s: float, obeys: bool) -> None:
        """Take that a robot has told of itself, and whether it drives by commands; find out who has failed."""
        for member in self.members:
            if member.heard_s is None or (obeys and member.number == number):
                member.heard_s = time_s
            elif member.failed_s is None and time_s > member.heard_s + GONE_S:
                member.fail(time_s)

    def yields(self, number: int, time_s: float, pose: Pose) -> bool:
        """Return whether a robot stands for another one."""
        self.members[number].pose = pose
        return self._way.yields(number, time_s, [member.place for member in self.members])

    def frontiers_beside(self, number: int) -> list[planning.Place]:
        """Return the frontiers that the other robots are on their way to."""
        found = (member.mission.frontier for member in self.living if member.number != number)
        return [frontier for frontier in found if frontier is not None]

    def share_out(self, time_s: float, surface: Callable[[], Surface | None]) -> None:
        """Share the open targets out: once all have explored, and where one has failed with some left undone."""
        living = self.living
        poses = [member.pose for member in living]
        if not self._must_share() or None in poses or (ground := surface()) is None:
            return
        tasks = tuple(range(len(self.targets))) if not self.shares else tuple(self._open())
        problem = _problem(living, ground.grid, [self.targets[task] for task in tasks])
        robots = tuple(member.number for member in living)
        shared = Shared(time_s, robots, tasks, problem, optimum(problem, self._objective))
        self.shares.append(shared)
        for member in living:
            member.go([self.targets[task] for task in shared.tour(member.number)])

    def _must_share(self) -> bool:
        if not self.shares:
            return all(member.mission.is_done for member in self.living)
        failed = (member.number for member in self.members if member.failed_s is not None)
        left = set(self._open())
        return any(task in left for number in failed for task in self.shares[-1].tour(number))

    def _open(self) -> list[int]:
        """Return the targets that nobody has gone to."""
        gone_to = {visit.name for member in self.members for visit in member.visits}
        return [task for task, target in enumerate(self.targets) if target.name not in gone_to]


class Member:
    """One robot of a team: gives its navigator goals as `Mission` does.

    Attributes:
        pose: where it was when it was last asked.
        heard_s: when it last drove by commands; None before anybody was heard.
        failed_s: when it was found to have failed; None while it has not.
        visits: the targets that it has gone to.
    """

    def __init__(self, team: Team, number: int, navigator: Navigator) -> None:
        """Begin with exploring."""
        self.number = number
        self.navigator = navigator
        self.pose: Pose | None = None
        self.heard_s: float | None = None
        self.failed_s: float | None = None
        self.mission = Mission(navigator, (), taken=lambda: team.frontiers_beside(number))
        self._before: list[Visit] = []
        self._team = team

    @property
    def place(self) -> Place | None:
        """Where it is; None: not known yet."""
        return None if self.pose is None else Place(self.pose, self.navigator.goal is not None)

    @property
    def visits(self) -> list[Visit]:
        """The targets that it has gone to."""
        return [*self._before, *self.mission.visits]

    def go(self, targets: Sequence[Target]) -> None:
        """Go to these targets, in the cheapest order."""
        self._before = self.visits
        self.mission = Mission(self.navigator, targets, explores=False)

    def fail(self, time_s: float) -> None:
        """Take part no more; stand where it is."""
        self.failed_s = time_s
        self.navigator.aim(None)

    def step(self, time_s: float, pose: Pose, points_m: Array) -> None:
        """Give the navigator its next goal where it needs one (`Mission.step`)."""
        self.pose = pose
        if self.failed_s is not None:
            return
        self.mission.step(time_s, pose, points_m)
        # By the map alone: where the others stand now they will not stand when somebody drives there.
        self._team.share_out(time_s, lambda: self.navigator.surface(pose, points_m[:0]))


def _problem(members: Sequence[Member], grid: Grid, targets: Sequence[Target]) -> Problem:
    """Return what ways cost on a map without these robots: from each of them by its own plans, then by the widest's."""
    places = [(member.pose.x_m, member.pose.y_m) for member in members if member.pose is not None]
    tasks = [(target.x_m, target.y_m) for target in targets]
    planners = [member.navigator.planner for member in members]
    circles = [Circle(*place, planner.touch_m + TRACE_M) for place, planner in zip(places, planners, strict=True)]
    empty = without_robots(grid, circles)
    surfaces = [planner.surface(empty, NOTHING) for planner in planners]
    starts = (ways_m(*each, tasks) for each in zip(planners, surfaces, places, strict=True))
    widest = max(range(len(planners)), key=lambda number: planners[number].keep_m)
    between = (ways_m(planners[widest], surfaces[widest], task, tasks) for task in tasks)
    return Problem(tuple(starts), tuple(between))


def without_robots(grid: Grid, robots: Sequence[Circle]) -> Grid:
    """Return a map whose cells where robots stand are free."""
    rows, columns = np.indices(grid.cells.shape)
    x_m = grid.x_m + (columns + 0.5) * grid.resolution_m
    y_m = grid.y_m + (rows + 0.5) * grid.resolution_m
    cells = grid.cells.copy()
    for robot in robots:
        cells[(np.hypot(x_m - robot.x_m, y_m - robot.y_m) < robot.radius_m) & (cells == OCCUPIED)] = FREE
    return grid._replace(cells=cells)
