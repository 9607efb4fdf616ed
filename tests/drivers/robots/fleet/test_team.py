"""A team without a console: who goes where, on a map that is known."""

import math

import numpy as np
import pytest

from simconsole.drivers.robots.allocation.problem import Objective
from simconsole.drivers.robots.fleet.team import GONE_S, Circle, Team, without_robots
from simconsole.drivers.robots.navigation.mission import Target
from simconsole.drivers.robots.navigation.navigator import Navigator, Progress
from simconsole.drivers.robots.navigation.robot_shape import shape_of
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
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
    (shared,) = team.shares
    assert team.explored_s == 1.0
    tours = shared.allocation.tours
    assert shared.problem.is_complete(tours)
    assert shared.allocation.cost == pytest.approx(shared.problem.cost(tours, objective))
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
    assert not team.shares


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
    cleared = without_robots(grid, [Circle(3.5, 3.2, 0.18)])
    assert int((cleared.cells == OCCUPIED).sum()) == walls
    assert grid.cells[row, column] == OCCUPIED, "the map itself stays"


def heard(team: Team, time_s: float, *silent: int) -> None:
    for member in team.members:
        team.hear(member.number, time_s, obeys=member.number not in silent)


def gone_to(team: Team, number: int) -> None:
    """Put a robot on its goal, and let it notice."""
    member = team.members[number]
    goal = member.navigator.goal
    assert goal is not None
    place = Pose(goal.x_m, goal.y_m, goal.yaw_rad or 0.0)
    member.navigator.steer(9.0, place, NOTHING)
    member.step(9.0, place, NOTHING)


@pytest.mark.parametrize("objective", Objective)
def test_what_a_robot_leaves_undone_that_fails_the_others_share_out(objective: Objective) -> None:
    team = team_of(objective)
    heard(team, 0.5)
    step(team, 1.0)
    step(team, 3.1)
    lost = max((member.number for member in team.members), key=lambda number: len(team.shares[0].tour(number)))
    assert len(team.shares[0].tour(lost)) >= 2
    gone_to(team, lost)
    done = team.members[lost].visits
    assert [visit.reached for visit in done] == [True]
    heard(team, 5.0)
    heard(team, 9.0)
    heard(team, 9.0 + GONE_S, lost)
    assert len(team.living) == 3, "not yet"
    heard(team, 9.1 + GONE_S, lost)
    assert [member.number for member in team.living] == [number for number in range(3) if number != lost]
    assert team.members[lost].failed_s == 9.1 + GONE_S
    assert team.members[lost].navigator.goal is None, "it stands, should it hear"
    step(team, 10.0 + GONE_S)
    assert len(team.shares) == 2, "once"
    again = team.shares[1]
    names = {TARGETS[task].name for task in again.tasks}
    assert names == {target.name for target in TARGETS} - {visit.name for visit in done}
    assert again.tour(lost) == []
    assert sorted(task for member in team.living for task in again.tour(member.number)) == sorted(again.tasks)
    assert again.problem.is_complete(again.allocation.tours)
    assert again.allocation.cost == pytest.approx(again.problem.cost(again.allocation.tours, objective))
    planned_m = sum(again.planned_m(number) for number in range(3))
    assert planned_m == pytest.approx(again.problem.cost(again.allocation.tours, Objective.SUM))


def test_a_robot_that_fails_before_the_map_is_known_gets_no_target() -> None:
    team = team_of(Objective.SUM)
    heard(team, 0.5)
    heard(team, 4.0, 1)
    heard(team, 0.6 + GONE_S, 1)
    step(team, 6.0)
    assert team.shares[0].robots == (0, 2)
    assert sorted(team.shares[0].tour(0) + team.shares[0].tour(2)) == list(range(len(TARGETS)))
    assert team.shares[0].tour(1) == []


def test_a_team_of_which_no_robot_is_left_is_done_without_its_tasks() -> None:
    team = team_of(Objective.SUM)
    heard(team, 0.5)
    assert not team.is_done
    heard(team, 0.6 + GONE_S, 0, 1, 2)
    assert team.is_done
    assert team.tasks_done == 0


def test_ways_are_those_of_each_robots_own_body() -> None:
    narrow = team_of(Objective.SUM)
    step(narrow, 1.0)
    waffle = load_vehicle("turtlebot3_waffle")
    assert isinstance(waffle, TurtlebotProfile)
    shapes = (burger(), shape_of(waffle), burger())
    mixed = Team([Navigator(shape, compiled) for shape in shapes], TARGETS, Objective.SUM)
    for member in mixed.members:
        member.navigator.see_map(grid_of(arena(), 0.05))
    step(mixed, 1.0)
    small, wide = narrow.shares[0].problem, mixed.shares[0].problem
    assert wide.start[0] == small.start[0], "a Burger's own plans"
    assert wide.start[1] != small.start[1]
    assert wide.between != small.between, "any robot may be asked to go there"
