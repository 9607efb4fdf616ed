"""A team without a console: who goes where, on a map that is known."""

import math

import numpy as np
import pytest

from simconsole.drivers.robots.allocation.problem import Objective
from simconsole.drivers.robots.fleet.team import Team, without_robots
from simconsole.drivers.robots.navigation.mission import Target
from simconsole.drivers.robots.navigation.navigator import Navigator, Progress
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from simconsole.world.arena.occupancy import OCCUPIED, UNKNOWN, grid_of
from tests.drivers.robots.arena_robot import burger
from tests.world.arena.shipped_arena import arena

TARGETS = [Target(spot.name, spot.x_m, spot.y_m, math.radians(spot.yaw_deg)) for spot in arena().targets]
STARTS = [Pose(spot.x_m, spot.y_m, 0.0) for spot in arena().starts]
NOTHING = np.empty((0, 2))


def team_of(objective: Objective) -> Team:
    team = Team([Navigator(burger(), compiled) for _ in STARTS], TARGETS, objective)
    for member in team.members:
        member.navigator.see_map(grid_of(arena(), 0.05))
    return team


def step(team: Team, time_s: float) -> None:
    for member, pose in zip(team.members, STARTS, strict=True):
        member.step(time_s, pose, NOTHING)


@pytest.mark.parametrize("objective", Objective)
def test_on_a_known_map_the_targets_are_shared_out_by_the_optimum(objective: Objective) -> None:
    team = team_of(objective)
    step(team, 1.0)
    assert team.shared is not None
    assert team.explored_s == 1.0
    tours = team.shared.allocation.tours
    assert team.shared.problem.is_complete(tours)
    assert team.shared.allocation.cost == pytest.approx(team.shared.problem.cost(tours, objective))
    assert not team.is_done
    step(team, 3.1)
    for member, tour in zip(team.members, tours, strict=True):
        assert (member.navigator.progress is Progress.UNDER_WAY) == bool(tour)


def test_robots_explore_different_frontiers() -> None:
    team = team_of(Objective.SUM)
    grid = grid_of(arena(), 0.05)
    rows, columns = np.indices(grid.cells.shape)
    far = (grid.x_m + 0.05 * columns > 2.6) | (grid.y_m + 0.05 * rows > 3.6)
    grid.cells[far] = UNKNOWN
    for member in team.members:
        member.navigator.see_map(grid)
    step(team, 1.0)
    chosen = [member.mission.frontier for member in team.members if member.mission.frontier is not None]
    assert chosen
    assert len(set(chosen)) == len(chosen)
    assert team.shared is None


def test_a_robot_that_is_near_another_one_stands() -> None:
    team = team_of(Objective.MAKESPAN)
    step(team, 1.0)
    step(team, 3.1)
    busy = [member.number for member in team.members if member.navigator.goal is not None]
    first, second = busy[:2]
    assert not team.yields(first, 4.0, STARTS[first])
    beside = Pose(STARTS[first].x_m + 0.3, STARTS[first].y_m, 0.0)
    stands = [team.yields(second, 4.1, beside), team.yields(first, 4.1, STARTS[first])]
    assert stands == [True, False]


def test_tasks_done_counts_what_was_gone_to() -> None:
    team = team_of(Objective.SUM)
    assert team.tasks_done == 0
    assert not team.is_done


def test_robots_that_stand_are_no_walls_of_the_map_that_ways_are_planned_on() -> None:
    grid = grid_of(arena(), 0.05)
    row, column = int((3.2 - grid.y_m) / 0.05), int((3.5 - grid.x_m) / 0.05)
    walls = int((grid.cells == OCCUPIED).sum())
    grid.cells[row - 2 : row + 3, column - 2 : column + 3] = OCCUPIED
    cleared = without_robots(grid, [(3.5, 3.2)], 0.18)
    assert int((cleared.cells == OCCUPIED).sum()) == walls
    assert grid.cells[row, column] == OCCUPIED, "the map itself stays"
