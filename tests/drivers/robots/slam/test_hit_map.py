import numpy as np
import pytest

from simconsole.drivers.robots.slam.hit_map import cell_at, draw, empty_map, grown, occupancy
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.values.host.jit import compiled, plain
from simconsole.world.arena.occupancy import FREE, OCCUPIED, UNKNOWN

CELL_M = 0.05


def fan(count: int, wall_x_m: float) -> Array:
    """Rays from the origin to a wall across x."""
    y = np.linspace(-1.0, 1.0, count)
    return np.column_stack((np.zeros((count, 2)), np.full(count, wall_x_m), y))


def test_echoes_are_occupied_what_lies_before_them_free_the_rest_unknown() -> None:
    field = empty_map(0.0, 0.0, CELL_M)
    compiled(draw)(field, fan(60, 1.01), np.ones(60), 1)
    grid = occupancy(field)

    def cell(x: float, y: float) -> int:
        return int(grid.cells[int((y - grid.y_m) / CELL_M), int((x - grid.x_m) / CELL_M)])

    assert cell(1.01, 0.3) == OCCUPIED
    assert cell(0.5, 0.2) == FREE
    assert cell(0.1, 0.9) == UNKNOWN
    assert (grid.cells == OCCUPIED).sum() in range(38, 44)


def test_rays_that_graze_a_wall_do_not_wipe_it_out() -> None:
    field = empty_map(0.0, 0.0, CELL_M)
    lines = np.column_stack((np.zeros(60), np.full(60, 0.12), np.linspace(0.3, 1.4, 60), np.full(60, 0.02)))
    for number in range(1, 30):
        compiled(draw)(field, lines, np.ones(60), number)
    wall = [field.log_odds[cell_at(field, float(x), 0.02)] for x in np.linspace(0.31, 1.39, 40)]
    assert min(wall) > 0.5


def test_a_wall_that_has_gone_is_forgotten_with_its_echoes() -> None:
    field = empty_map(0.0, 0.0, CELL_M)
    for number in range(1, 6):
        compiled(draw)(field, fan(60, 0.8), np.ones(60), number)
    cell = cell_at(field, 0.8, 0.1)
    assert field.hits[cell, 0] >= 5.0
    for number in range(6, 30):
        compiled(draw)(field, fan(60, 1.4), np.ones(60), number)
    assert field.log_odds[cell] < 0.0
    compiled(draw)(field, fan(60, 0.8), np.ones(60), 30)
    assert field.hits[cell, 0] <= 3.0, "counted anew"


def test_a_ray_without_an_echo_only_frees() -> None:
    field = empty_map(0.0, 0.0, CELL_M)
    compiled(draw)(field, fan(10, 1.0), np.zeros(10), 1)
    assert not (occupancy(field).cells == OCCUPIED).any()


def test_a_map_grows_to_all_sides_and_keeps_what_it_knows() -> None:
    field = empty_map(0.3, -0.2, CELL_M)
    compiled(draw)(field, fan(60, 1.01), np.ones(60), 1)
    larger = grown(field, np.array([(-5.0, 0.0), (0.0, 7.0)]))
    assert larger.columns > field.columns
    assert larger.rows > field.rows
    for x, y in ((1.01, 0.3), (0.5, 0.2), (0.1, 0.9)):
        assert larger.log_odds[cell_at(larger, x, y)] == field.log_odds[cell_at(field, x, y)]
        assert (larger.hits[cell_at(larger, x, y)] == field.hits[cell_at(field, x, y)]).all()
    assert cell_at(larger, -5.0, 7.0) >= 0
    assert cell_at(field, -5.0, 7.0) == -1
    assert grown(larger, np.array([(1.0, 1.0)])) is larger
    assert (occupancy(larger).cells == occupancy(field).cells).all()


def test_a_map_of_nothing_is_one_unknown_cell() -> None:
    assert occupancy(empty_map(0.0, 0.0, CELL_M)).cells.tolist() == [[UNKNOWN]]


def test_both_executions_agree() -> None:
    fields = []
    for execution in (plain, compiled):
        field = empty_map(0.0, 0.0, CELL_M)
        execution(draw)(field, fan(25, 1.01), np.ones(25), 1)
        fields.append(field)
    assert (fields[0].log_odds == fields[1].log_odds).all()
    assert (fields[0].hits == fields[1].hits).all()
    assert fields[0].x_m == pytest.approx(-1.6)
