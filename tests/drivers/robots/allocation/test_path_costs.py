import math

import numpy as np
import pytest

from simconsole.drivers.robots.allocation.exact import optimum
from simconsole.drivers.robots.allocation.path_costs import PathGrid, problem_on
from simconsole.drivers.robots.allocation.problem import Objective
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import ArenaProfile
from simconsole.world.arena.occupancy import FREE, grid_of


def open_room() -> PathGrid:
    free = np.zeros((62, 82), dtype=bool)
    free[1:-1, 1:-1] = True
    free[1:40, 40] = False  # a wall from below
    return PathGrid(free, 0.1, (0.0, 0.0), 0.15)


def test_a_path_in_the_open_is_straight() -> None:
    (found,) = open_room().lengths_from((0.55, 0.55), [(3.05, 5.55)])
    assert found == pytest.approx(math.dist((0.55, 0.55), (3.05, 5.55)), rel=0.02)


def test_a_path_goes_round_a_wall_with_room_for_the_robot() -> None:
    (found,) = open_room().lengths_from((3.05, 1.05), [(5.05, 1.05)])
    corner = (4.05, 4.0)
    least = math.dist((3.05, 1.05), corner) + math.dist(corner, (5.05, 1.05))
    assert least < found < least + 0.6


def test_where_a_robot_cannot_stand_there_is_no_path() -> None:
    with pytest.raises(ValueError, match="cannot stand"):
        open_room().lengths_from((0.55, 0.55), [(4.05, 1.0)])
    with pytest.raises(ValueError, match="cannot stand"):
        open_room().cell((99.0, 0.0))
    free = np.ones((30, 30), dtype=bool)
    free[:, 15] = False
    assert PathGrid(free, 0.1, (0.0, 0.0), 0.1).lengths_from((0.5, 0.5), [(2.5, 0.5)]) == [math.inf]


def test_paths_in_the_shipped_arena_are_no_shorter_than_straight_lines_and_the_same_back() -> None:
    profile = load_world("arena")
    assert isinstance(profile, ArenaProfile)
    grid = grid_of(profile, 0.05)
    paths = PathGrid(grid.cells == FREE, grid.resolution_m, (grid.x_m, grid.y_m), 0.155)
    robots, tasks = ([(spot.x_m, spot.y_m) for spot in spots] for spots in (profile.starts, profile.targets))
    problem = problem_on(paths, robots, tasks)
    for a, one in enumerate(tasks):
        for b, other in enumerate(tasks):
            assert problem.between[a][b] >= math.dist(one, other) - 0.1
            assert problem.between[a][b] == pytest.approx(problem.between[b][a], rel=0.03, abs=0.05)
    best = optimum(problem, Objective.SUM)
    assert problem.is_complete(best.tours)
    assert 18.0 < best.cost < 24.0
