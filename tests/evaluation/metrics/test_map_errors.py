import numpy as np
import pytest

from simconsole.evaluation.metrics.map_errors import map_errors
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import ArenaProfile
from simconsole.world.arena.occupancy import FREE, OCCUPIED, Grid, grid_of
from simconsole.world.arena.outlines import Outlines, outlines_of

WALL = Outlines(np.array([(0.0, 0.52, 2.0, 0.52)]), np.empty((0, 3)))


def grid(rows: list[int], columns: range = range(40)) -> Grid:
    cells = np.full((20, 40), FREE, dtype=np.int8)
    for row in rows:
        cells[row, list(columns)] = OCCUPIED
    return Grid(cells, 0.05, 0.0, 0.0)


def test_a_true_map_is_without_errors() -> None:
    errors = map_errors(grid([10]), WALL)
    assert (errors.precision, errors.recall) == (1.0, 1.0)
    assert errors.wall_m == pytest.approx(0.005, abs=1e-6)


def test_a_neighbouring_cell_is_near_enough_and_the_one_behind_it_is_not() -> None:
    assert map_errors(grid([11]), WALL)[:2] == (1.0, 1.0)
    assert map_errors(grid([12]), WALL)[:2] == (0.0, 0.0)
    assert map_errors(grid([10, 15]), WALL).precision == 0.5


def test_half_a_wall_is_half_found_and_what_lies_outside_the_map_is_missed() -> None:
    assert map_errors(grid([10], range(19)), WALL).recall == pytest.approx(0.5, abs=0.03)
    far = Outlines(np.array([(0.0, 0.52, 4.0, 0.52)]), np.empty((0, 3)))
    assert map_errors(grid([10]), far).recall == pytest.approx(0.5, abs=0.03)


def test_pillars_are_their_rims() -> None:
    errors = map_errors(grid([10]), Outlines(np.empty((0, 4)), np.array([(1.0, 0.5, 0.3)])))
    assert errors.precision < 0.2
    assert 0.1 < errors.wall_m < 0.4


def test_the_shipped_arena_as_a_map_is_true_and_an_empty_map_is_refused() -> None:
    profile = load_world("arena")
    assert isinstance(profile, ArenaProfile)
    errors = map_errors(grid_of(profile, 0.05), outlines_of(profile))
    assert errors.recall == 1.0
    assert errors.precision > 0.95, "but for the insides of pillars"
    with pytest.raises(ValueError, match="without an occupied cell"):
        map_errors(grid([]), WALL)
