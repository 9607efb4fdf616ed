import numpy as np
import pytest

from simconsole.drivers.robots.navigation.frontiers import frontiers, next_view, standing
from simconsole.drivers.robots.navigation.planner import Planner, Surface
from simconsole.values.host.jit import compiled
from simconsole.world.arena.occupancy import Grid
from tests.drivers.robots.arena_robot import burger
from tests.drivers.robots.navigation.rooms import half_known, two_rooms


def planned(grid: Grid) -> tuple[Planner, Surface]:
    plan = Planner(burger(), compiled)
    return plan, plan.surface(grid, np.empty((0, 2)))


def test_the_door_to_what_is_not_known_is_a_frontier() -> None:
    plan, surface = planned(half_known())
    (place,) = frontiers(surface)
    assert place == pytest.approx((2.0, 2.55), abs=0.1)
    assert next_view(plan, surface, (0.6, 0.6)) == place
    stand = standing(plan, surface, (0.6, 0.6), place)
    assert np.hypot(stand[0] - place[0], stand[1] - place[1]) < 0.3
    assert next_view(plan, surface, (0.6, 0.6), [place]) is None, "given up"


def test_a_known_room_has_no_frontier() -> None:
    plan, surface = planned(two_rooms())
    assert frontiers(surface) == []
    assert next_view(plan, surface, (0.6, 0.6)) is None


def test_of_two_frontiers_the_nearer_one_is_seen_first_and_shadows_are_left_alone() -> None:
    grid = two_rooms()
    cells = grid.cells.copy()
    cells[20:40, 60:79] = -1
    cells[5:8, 5:8] = -1  # what is hidden by a leg of a table
    plan, surface = planned(grid._replace(cells=cells))
    assert len(frontiers(surface)) == 1
    cells[45:59, 1:15] = -1
    plan, surface = planned(grid._replace(cells=cells))
    assert len(frontiers(surface)) == 2
    chosen = next_view(plan, surface, (1.0, 0.6))
    assert chosen is not None
    assert chosen[0] < 1.0
