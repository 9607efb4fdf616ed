"""What a robot does on its own: it makes the whole map known, then goes to its targets in the cheapest order."""

import math
from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

from simconsole.drivers.robots.allocation.exact import optimum
from simconsole.drivers.robots.allocation.problem import Objective, Problem
from simconsole.drivers.robots.navigation.frontiers import next_view, standing
from simconsole.drivers.robots.navigation.navigator import Goal, Navigator, Progress
from simconsole.drivers.robots.navigation.planner import Place, Planner, Surface, length_m
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.values.platform import Pose

VIEW_M: Final = 0.35
"""How near to a place of exploration is near enough."""
LOOK_S: Final = 2.0
"""How often exploration looks whether its frontier is still one."""


class Target(NamedTuple):
    """A task: a place to be."""

    name: str
    x_m: float
    y_m: float
    yaw_rad: float | None = None


class Visit(NamedTuple):
    """A target that was gone to."""

    name: str
    reached: bool
    time_s: float
    recoveries: int


class Mission:
    """Exploration, then targets.

    Attributes:
        visits: of targets, in their order.
        planned_m: length of the planned way through all targets; 0 before it is known.
        explored_s: when the map was complete; None before.
        is_done: whether all targets have been gone to.
    """

    def __init__(
        self,
        navigator: Navigator,
        targets: Sequence[Target],
        explores: bool = True,
        taken: Callable[[], Sequence[Place]] = tuple,
    ) -> None:
        """Send `navigator` round; `taken` returns the frontiers that other robots are on their way to."""
        self.visits: list[Visit] = []
        self.planned_m = 0.0
        self.explored_s: float | None = None
        self.is_done = False
        self._navigator = navigator
        self._targets = list(targets)
        self._explores = explores
        self._taken = taken
        self._order: list[Target] | None = None
        self._frontier: Place | None = None
        self._given_up: list[Place] = []
        self._looked_s = -LOOK_S

    def step(self, time_s: float, pose: Pose, points_m: Array) -> None:
        """Give the navigator its next goal where it needs one.

        Args:
            time_s: of the pose.
            pose: of the robot's base, in map.
            points_m: [N, 2]: what the lidar sees, in the frame of the base.
        """
        under_way = self._navigator.progress is Progress.UNDER_WAY
        if self.is_done or (under_way and (self._order is not None or time_s < self._looked_s + LOOK_S)):
            return
        self._looked_s = time_s
        if self._order is None:
            surface = self._navigator.surface(pose, points_m)
            if surface is None or (self._explores and self._explored(surface, pose)):
                return
            self.explored_s = time_s
            self._order = self._ordered(surface, pose)
        elif self._order:
            done = self._order.pop(0)
            reached = self._navigator.progress is Progress.REACHED
            self.visits.append(Visit(done.name, reached, time_s, self._navigator.recoveries))
        if self._order:
            target = self._order[0]
            self._navigator.aim(Goal(target.x_m, target.y_m, target.yaw_rad))
        else:
            self._navigator.aim(None)
            self.is_done = True

    @property
    def frontier(self) -> Place | None:
        """The frontier that the robot is on its way to; None: it explores no more, or not yet."""
        return self._frontier if self._order is None else None

    def _explored(self, surface: Surface, pose: Pose) -> bool:
        """Send the robot to the next place of exploration; False where none is left."""
        start, navigator = (pose.x_m, pose.y_m), self._navigator
        if navigator.progress in (Progress.REACHED, Progress.FAILED) and self._frontier is not None:
            self._given_up.append(self._frontier)
        chosen = next_view(navigator.planner, surface, start, [*self._given_up, *self._taken()])
        if chosen is None:
            return False
        self._frontier = chosen
        x_m, y_m = standing(navigator.planner, surface, start, chosen)
        before = navigator.goal
        if before is None or abs(before.x_m - x_m) + abs(before.y_m - y_m) > VIEW_M:
            navigator.aim(Goal(x_m, y_m, None, VIEW_M))
        return True

    def _ordered(self, surface: Surface, pose: Pose) -> list[Target]:
        """Return the targets in the cheapest order."""
        if not self._targets:
            return []
        places = [(target.x_m, target.y_m) for target in self._targets]
        found = optimum(problem_by(self._navigator.planner, surface, [(pose.x_m, pose.y_m)], places), Objective.SUM)
        self.planned_m = found.cost
        return [self._targets[task] for task in found.tours[0]]


def problem_by(planner: Planner, surface: Surface, robots: Sequence[Place], tasks: Sequence[Place]) -> Problem:
    """Return the problem whose costs are the lengths in m of the plans that robots would follow; no way: infinite."""
    starts = (ways_m(planner, surface, robot, tasks) for robot in robots)
    return Problem(tuple(starts), tuple(ways_m(planner, surface, task, tasks) for task in tasks))


def ways_m(planner: Planner, surface: Surface, start: Place, tasks: Sequence[Place]) -> tuple[float, ...]:
    """Return the lengths in m of the plans from a place to each task; no way: infinite."""
    paths = [planner.path(surface, start, task) for task in tasks]
    return tuple(math.inf if path is None else length_m(path) for path in paths)
