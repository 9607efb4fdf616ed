import numpy as np
import pytest

from simconsole.values.errors import ProfileError
from simconsole.world.arena.occupancy import FREE, OCCUPIED, UNKNOWN, Grid, arena_of_grid, grid_of
from simconsole.world.arena.outlines import outlines_of
from simconsole.world.arena.raycast import cast, ray_grid
from tests.world.arena.shipped_arena import arena

CELL_M = 0.05


def test_free_is_what_robots_reach_and_walls_leave_no_gap() -> None:
    grid = grid_of(arena(), CELL_M)
    assert set(np.unique(grid.cells).tolist()) == {UNKNOWN, FREE, OCCUPIED}
    assert grid.cells[0, 0] == UNKNOWN, "outside"

    def at(x_m: float, y_m: float) -> int:
        return int(grid.cells[int((y_m - grid.y_m) / CELL_M), int((x_m - grid.x_m) / CELL_M)])

    assert at(3.0, 1.0) == at(4.5, 4.9) == OCCUPIED
    assert at(1.45, 3.1) == UNKNOWN, "inside of a box"
    assert at(8.5, 1.0) == FREE, "the furthest room"
    area_m2 = float((grid.cells == FREE).sum()) * CELL_M**2
    assert 6.0 * 9.0 - 3.0 < area_m2 < 6.0 * 9.0 - 0.8


def test_ranges_in_an_arena_that_was_a_grid_are_those_of_the_first_within_two_cells() -> None:
    first = arena()
    second = arena_of_grid(grid_of(first, CELL_M), "again")
    before, after, nobody = ray_grid(outlines_of(first)), ray_grid(outlines_of(second)), np.empty((0, 3))
    rng, apart = np.random.default_rng(1), []
    for spot in (*first.starts, *first.targets):
        for turn in rng.uniform(0.0, 6.28, 60):
            ray = (spot.x_m, spot.y_m, float(np.cos(turn)), float(np.sin(turn)), 12.0)
            apart.append(cast(*ray, before, nobody) - cast(*ray, after, nobody))
    assert np.median(np.abs(apart)) < CELL_M
    assert np.mean(np.abs(apart) < 3.0 * CELL_M) > 0.95, "but for rays along a wall and past a corner"


def test_walls_of_a_grid_are_the_borders_of_its_cells_in_one_piece() -> None:
    cells = np.zeros((6, 8), dtype=np.int8)
    cells[2:4, 3:6] = OCCUPIED
    arena = arena_of_grid(Grid(cells, 0.5, -1.0, -2.0), "box")
    sides = {tuple((point.x_m, point.y_m) for point in wall.points) for wall in arena.walls}
    assert sides == {
        ((0.5, -1.0), (2.0, -1.0)),
        ((0.5, 0.0), (2.0, 0.0)),
        ((0.5, -1.0), (0.5, 0.0)),
        ((2.0, -1.0), (2.0, 0.0)),
    }


def test_robots_start_where_there_is_most_room() -> None:
    cells = np.full((20, 20), OCCUPIED, dtype=np.int8)
    cells[1:3, 1:19] = FREE
    cells[8:15, 8:15] = FREE
    (start,) = arena_of_grid(Grid(cells, 1.0, 0.0, 0.0), "t").starts
    assert (start.x_m, start.y_m) == (11.5, 11.5)


@pytest.mark.parametrize("state", [FREE, OCCUPIED])
def test_a_grid_of_one_kind_is_no_arena(state: int) -> None:
    with pytest.raises(ProfileError, match="occupied"):
        arena_of_grid(Grid(np.full((4, 4), state, dtype=np.int8), 1.0, 0.0, 0.0), "t")


def test_a_grid_of_too_many_cells_is_refused() -> None:
    with pytest.raises(ProfileError, match="cells"):
        grid_of(arena(), 0.001)
