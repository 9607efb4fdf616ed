import math

import numpy as np
import pytest

from simconsole.drivers.robots.navigation.navigator import MOST_RECOVERIES, Goal, Navigator, Progress
from simconsole.drivers.robots.navigation.path_following import STOP
from simconsole.drivers.robots.slam.rays import Turn
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from simconsole.world.arena.occupancy import grid_of
from simconsole.world.arena.outlines import Outlines
from tests.drivers.robots.arena_robot import MOUNT, RAYS, STEP_S, STOPPED, ArenaRobot, burger
from tests.drivers.robots.navigation.rooms import two_rooms
from tests.samples import Sample
from tests.world.arena.shipped_arena import arena

NOTHING = np.empty((0, 2))


def echoes(turn: Turn) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """The echoes of a scan in the frame of the base, without its motion: a robot that stands, or nearly."""
    angles = np.arange(RAYS) * math.tau / RAYS
    seen = turn.ranges_m >= turn.min_m
    return np.column_stack((np.cos(angles), np.sin(angles)))[seen] * turn.ranges_m[seen, None] + (MOUNT.x_m, 0.0)


def driven(robot: ArenaRobot, navigator: Navigator, most_s: float) -> float:
    """Drive until the goal is no longer under way; return when that was."""
    speeds, points, end_s = STOPPED, NOTHING, robot.time_s + most_s
    while navigator.progress is Progress.UNDER_WAY and robot.time_s < end_s:
        turn = robot.advance(speeds)
        if turn is not None:
            points = echoes(turn)
        if round(robot.time_s / STEP_S) % 5 == 0 and len(points):
            speeds = navigator.steer(robot.time_s, robot.pose, points)
    return robot.time_s


def test_goals_all_over_the_arena_are_reached_with_their_heading(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    robot, navigator = ArenaRobot(rng, scale=1.0, turn=1.0), Navigator(burger(), compiled)
    navigator.see_map(grid_of(arena(), 0.05))
    for target in arena().targets[: sample.of(2, 5)]:
        navigator.aim(Goal(target.x_m, target.y_m, math.radians(target.yaw_deg)))
        driven(robot, navigator, 150.0)
        assert navigator.progress is Progress.REACHED
        assert math.hypot(robot.pose.x_m - target.x_m, robot.pose.y_m - target.y_m) < 0.07
        assert abs(math.remainder(robot.pose.yaw_rad - math.radians(target.yaw_deg), math.tau)) < 0.15
    assert robot.least_m >= 0.05
    assert navigator.recoveries == 0


def test_a_thing_that_is_not_on_the_map_is_kept_away_from(sample: Sample) -> None:
    pillar = np.array([(2.0, 0.8, 0.15)])
    walls = np.array([(0.0, 0.0, 4.0, 0.0), (4.0, 0.0, 4.0, 3.0), (4.0, 3.0, 0.0, 3.0), (0.0, 3.0, 0.0, 0.0)])
    robot = ArenaRobot(np.random.default_rng(sample.seed), outlines=Outlines(walls, pillar))
    navigator = Navigator(burger(), compiled)
    grid = two_rooms()
    cells = grid.cells.copy()
    cells[1:-1, 1:-1] = 0
    navigator.see_map(grid._replace(cells=cells))
    navigator.aim(Goal(3.2, 0.8))
    driven(robot, navigator, 60.0)
    assert navigator.progress is Progress.REACHED
    assert robot.least_m >= 0.05


def test_without_a_way_all_recoveries_are_tried_and_then_it_fails() -> None:
    navigator = Navigator(burger(), compiled)
    navigator.see_map(two_rooms(0.2))
    navigator.aim(Goal(3.4, 0.6))
    time_s, told = 0.0, set()
    while navigator.progress is Progress.UNDER_WAY and time_s < 200.0:
        told.add(navigator.steer(time_s, Pose(0.8, 0.8, 0.0), NOTHING))
        time_s += 0.1
    assert navigator.progress is Progress.FAILED
    assert navigator.recoveries == MOST_RECOVERIES
    assert {(speeds.speed_mps < 0.0, speeds.yaw_rate_radps > 0.0) for speeds in told} == {
        (False, False), (True, False), (False, True)
    }  # fmt: skip
    assert navigator.steer(time_s, Pose(0.8, 0.8, 0.0), NOTHING) == STOP


def test_a_recovery_ends_where_there_is_no_room_for_it() -> None:
    navigator = Navigator(burger(), compiled)
    navigator.see_map(two_rooms(0.2))
    navigator.aim(Goal(3.4, 0.6))
    boxed = np.array([(-0.032 + 0.17 * math.cos(a), 0.17 * math.sin(a)) for a in np.linspace(0.0, math.tau, 60)])
    time_s = 0.0
    while navigator.progress is Progress.UNDER_WAY and time_s < 200.0:
        assert navigator.steer(time_s, Pose(0.8, 0.8, 0.0), boxed) == STOP
        time_s += 0.1
    assert navigator.progress is Progress.FAILED


def test_without_a_goal_or_a_map_it_stands() -> None:
    navigator = Navigator(burger(), compiled)
    navigator.warm_up()
    assert navigator.steer(0.0, Pose(0.0, 0.0, 0.0), NOTHING) == STOP
    assert navigator.progress is Progress.NONE
    navigator.aim(Goal(1.0, 0.0))
    assert navigator.steer(0.0, Pose(0.0, 0.0, 0.0), NOTHING) == STOP
    assert navigator.left_m == math.inf
    navigator.aim(None)
    assert navigator.goal is None


def test_a_new_goal_takes_the_place_of_the_old_one() -> None:
    navigator = Navigator(burger(), compiled)
    navigator.see_map(two_rooms())
    pose = Pose(1.0, 1.0, 0.0)
    navigator.aim(Goal(1.6, 1.0))
    assert navigator.steer(0.0, pose, NOTHING).speed_mps > 0.1
    navigator.aim(Goal(0.4, 1.0))
    assert navigator.steer(0.1, pose, NOTHING).speed_mps == 0.0
    assert navigator.path_m is not None
    assert navigator.path_m[-1] == pytest.approx((0.4, 1.0))
