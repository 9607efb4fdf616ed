import math

import numpy as np
import pytest

from simconsole.drivers.robots.navigation.path_search import NEVER
from simconsole.drivers.robots.navigation.planner import STEP_M, Planner, cells_of, length_m
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.values.host.jit import compiled
from simconsole.world.arena.occupancy import OCCUPIED, Grid
from tests.drivers.robots.arena_robot import burger
from tests.drivers.robots.navigation.rooms import half_known, two_rooms

NOTHING = np.empty((0, 2))


def planner() -> Planner:
    return Planner(burger(), compiled)


def to_walls(grid: Grid, points: Array) -> float:
    """The least distance of a line from the middle of an occupied cell."""
    walls = np.argwhere(grid.cells == OCCUPIED)
    middles = np.column_stack((walls[:, 1] + 0.5, walls[:, 0] + 0.5)) * grid.resolution_m
    return float(min(np.hypot(*(middles - point).T).min() for point in points))


def test_a_path_goes_through_the_door_with_room_to_both_sides() -> None:
    plan, grid = planner(), two_rooms()
    path = plan.path(plan.surface(grid, NOTHING), (0.6, 0.6), (3.4, 0.6))
    assert path is not None
    assert path[0] == pytest.approx((0.6, 0.6))
    assert path[-1] == pytest.approx((3.4, 0.6))
    assert np.hypot(*np.diff(path, axis=0).T).max() <= STEP_M + 1e-9
    assert to_walls(grid, path) >= plan.keep_m
    shortest = 2.0 * math.dist((0.6, 0.6), (2.0, 2.2))
    assert shortest < length_m(path) < 1.15 * shortest + 0.4


def test_what_the_lidar_sees_closes_a_way() -> None:
    plan, grid = planner(), two_rooms()
    door = np.column_stack((np.full(40, 2.02), np.linspace(2.2, 2.98, 40)))
    assert plan.path(plan.surface(grid, door), (0.6, 0.6), (3.4, 0.6)) is None
    assert plan.path(plan.surface(grid, NOTHING), (0.6, 0.6), (3.4, 0.6)) is not None


def test_a_door_that_is_too_narrow_is_a_wall() -> None:
    plan = planner()
    assert plan.path(plan.surface(two_rooms(0.3), NOTHING), (0.6, 0.6), (3.4, 0.6)) is None


def test_unknown_ground_may_be_driven_on() -> None:
    plan = planner()
    path = plan.path(plan.surface(half_known(), NOTHING), (0.6, 0.6), (3.4, 2.0))
    assert path is not None


def test_a_robot_that_stands_too_near_to_a_wall_gets_out() -> None:
    plan, grid = planner(), two_rooms()
    surface = plan.surface(grid, NOTHING)
    path = plan.path(surface, (0.16, 1.5), (1.0, 1.5))
    assert path is not None
    row, column = (int(found[0]) for found in cells_of(grid, np.array((0.16, 1.5))))
    assert surface.away_m[row, column] < plan.keep_m
    into = plan.path(surface, (1.0, 1.5), (0.05, 1.5))
    assert into is not None, "as near to the goal as there is room"
    assert into[-1, 0] > 0.1


def test_a_goal_far_within_a_wall_has_no_path() -> None:
    plan, cells = planner(), two_rooms().cells.copy()
    cells[10:40, 50:75] = OCCUPIED
    assert plan.path(plan.surface(Grid(cells, 0.05, 0.0, 0.0), NOTHING), (0.6, 0.6), (3.1, 1.25)) is None


def test_lengths_reach_every_cell_that_can_be_entered() -> None:
    plan, grid = planner(), two_rooms()
    surface = plan.surface(grid, NOTHING)
    lengths = plan.lengths(surface, (0.62, 0.62))
    assert lengths[12, 12] == 0.0
    assert lengths[12, 68] > 1.5 * lengths[12, 30]
    assert lengths[0, 0] == NEVER
