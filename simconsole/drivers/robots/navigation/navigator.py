"""Drives a robot to goals on a map: plans, follows, and gets out where it is stuck. It opens no socket."""

import math
from enum import Enum, auto
from typing import Final, NamedTuple

import numpy as np

from simconsole.drivers.robots.navigation.path_following import STOP, PathFollower, Speeds
from simconsole.drivers.robots.navigation.planner import Place, Planner, Surface, length_m
from simconsole.drivers.robots.navigation.robot_shape import RobotShape
from simconsole.drivers.robots.slam.mapper import Execution
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.drivers.robots.slam.planar import wrapped
from simconsole.values.platform import Pose
from simconsole.world.arena.occupancy import Grid

REPLAN_S: Final = 1.0
STUCK_S: Final = 4.0
"""So long without coming nearer to the goal, along the path."""
NEARER_M: Final = 0.05
MOST_RECOVERIES: Final = 9
_WAIT_S: Final = 1.5
_BACK_S: Final = 2.5
_BACK_MPS: Final = 0.06
_SPIN_S: Final = 3.0
_SPIN_RADPS: Final = 1.0
_YAW_RAD: Final = 0.1


class Goal(NamedTuple):
    """Where a robot shall go."""

    x_m: float
    y_m: float
    yaw_rad: float | None = None  # None: as it comes
    within_m: float = 0.05


class Progress(Enum):
    """What has become of a goal."""

    NONE = auto()  # there was none
    UNDER_WAY = auto()
    REACHED = auto()
    FAILED = auto()


class _Recovery(Enum):
    """What is tried, one after the other, as nav2's behaviours."""

    WAIT = auto()  # for others to go; the plan is made anew
    BACK_UP = auto()
    SPIN = auto()  # to see more, and to come free


_RECOVERIES: Final = tuple(_Recovery)


class _Way(NamedTuple):
    """How far the robot has come with its goal."""

    since_s: float
    left_m: float


class Navigator:
    """Drives one robot.

    Attributes:
        progress: of the newest goal.
        path_m: [N, 2], the plan that is followed; None without one.
        recoveries: for the newest goal.
    """

    def __init__(self, shape: RobotShape, execution: Execution) -> None:
        """Drive a robot of this shape."""
        self.planner = Planner(shape, execution)
        self.progress = Progress.NONE
        self.path_m: Array | None = None
        self.recoveries = 0
        self._follower = PathFollower(shape, execution)
        self._grid: Grid | None = None
        self._goal: Goal | None = None
        self._planned_s = -math.inf
        self._way: _Way | None = None
        self._recovering: tuple[_Recovery, float] | None = None  # until when
        self._arrived = False

    @property
    def goal(self) -> Goal | None:
        """What is under way; None: nothing."""
        return self._goal if self.progress is Progress.UNDER_WAY else None

    @property
    def left_m(self) -> float:
        """Length of the plan, infinite without one."""
        return math.inf if self.path_m is None else length_m(self.path_m)

    def warm_up(self) -> None:
        """Have the kernels compiled now, so that no command waits for it."""
        grid = Grid(np.zeros((8, 8), dtype=np.int8), 0.05, 0.0, 0.0)
        surface = self.planner.surface(grid, np.empty((0, 2)))
        self.planner.lengths(surface, (0.2, 0.2))
        self._follower.is_free(STOP, np.zeros((1, 2)))

    def see_map(self, grid: Grid) -> None:
        """Take a map; it holds for the next plan."""
        self._grid = grid

    def aim(self, goal: Goal | None) -> None:
        """Take a goal in place of the one before it; None: stand still."""
        self._goal = goal
        self.progress = Progress.NONE if goal is None else Progress.UNDER_WAY
        self.path_m, self._way, self._recovering = None, None, None
        self._planned_s, self.recoveries, self._arrived = -math.inf, 0, False

    def surface(self, pose: Pose, points_m: Array) -> Surface | None:
        """Return the map, with what the lidar sees, as it is to the robot; None without a map."""
        if self._grid is None:
            return None
        cosine, sine = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
        turned = points_m @ np.array(((cosine, sine), (-sine, cosine)))
        return self.planner.surface(self._grid, turned + np.array((pose.x_m, pose.y_m)))

    def hold(self) -> Speeds:
        """Return that the robot stands for now: for another one that goes first, which is not to be stuck."""
        self._way = None
        return STOP

    def steer(self, time_s: float, pose: Pose, points_m: Array) -> Speeds:
        """Return the speeds to drive now.

        Args:
            time_s: of the pose.
            pose: of the robot's base, in map.
            points_m: [N, 2]: what the lidar sees, in the frame of the base.
        """
        goal = self.goal
        if goal is None:
            return STOP
        if self._recovering is not None:
            return self._recovered(time_s, points_m)
        if self._arrived or math.hypot(goal.x_m - pose.x_m, goal.y_m - pose.y_m) <= goal.within_m:
            return self._turned(goal, pose, points_m)
        if time_s >= self._planned_s + REPLAN_S or self.path_m is None:
            self._plan(time_s, pose, points_m, (goal.x_m, goal.y_m))
        if self._is_stuck(time_s):
            return self._recover(time_s)
        return STOP if self.path_m is None else self._follower.follow(self.path_m, pose, points_m)

    def _turned(self, goal: Goal, pose: Pose, points_m: Array) -> Speeds:
        """Turn to the goal's heading; done where it is, or where there is no room to."""
        self._arrived = True
        speeds = STOP
        if goal.yaw_rad is not None and abs(wrapped(goal.yaw_rad - pose.yaw_rad)) > _YAW_RAD:
            speeds = self._follower.turn(goal.yaw_rad, pose, points_m)
        if speeds == STOP:
            self.progress = Progress.REACHED
        return speeds

    def _plan(self, time_s: float, pose: Pose, points_m: Array, goal: Place) -> None:
        self._planned_s = time_s
        surface = self.surface(pose, points_m)
        if surface is not None:
            self.path_m = self.planner.path(surface, (pose.x_m, pose.y_m), goal)

    def _is_stuck(self, time_s: float) -> bool:
        left_m = self.left_m
        if self._way is None or left_m < self._way.left_m - NEARER_M:
            self._way = _Way(time_s, left_m)
        return time_s - self._way.since_s > STUCK_S

    def _recover(self, time_s: float) -> Speeds:
        if self.recoveries >= MOST_RECOVERIES:
            self.progress = Progress.FAILED
            return STOP
        kind = _RECOVERIES[self.recoveries % len(_RECOVERIES)]
        lasts_s = {_Recovery.WAIT: _WAIT_S, _Recovery.BACK_UP: _BACK_S, _Recovery.SPIN: _SPIN_S}[kind]
        self.recoveries += 1
        self._recovering = (kind, time_s + lasts_s)
        return STOP

    def _recovered(self, time_s: float, points_m: Array) -> Speeds:
        """Go on with a recovery, as far as there is room for it."""
        assert self._recovering is not None
        kind, until_s = self._recovering
        speeds = STOP
        if kind is _Recovery.BACK_UP:
            speeds = Speeds(-_BACK_MPS, 0.0)
        elif kind is _Recovery.SPIN:
            speeds = Speeds(0.0, _SPIN_RADPS)
        if time_s >= until_s or (speeds != STOP and not self._follower.is_free(speeds, points_m)):
            self._recovering, self._way, self._planned_s = None, None, -math.inf
            return STOP
        return speeds
