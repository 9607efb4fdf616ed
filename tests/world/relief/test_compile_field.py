"""From strips to a field: as high as the roads, edges where they end, land between them."""

import numpy as np
import pytest

from simconsole.values.height_field import spline_at
from simconsole.world.relief.compile_field import FAR_M, MOST_NODES, Edges, height_field
from simconsole.world.relief.strips import Array, Strips, strip, together
from tests.bits import difference

BARE = Edges(0.0, 0.6)


def straight(
    y_m: float, grade: float = 0.0, half_m: float = 1.75, bank: float = 0.0, length_m: float = 200.0
) -> Strips:
    x = np.arange(0.0, length_m)
    return strip(np.stack((x, np.full(len(x), y_m), grade * x), axis=1), np.full(len(x), bank), half_m, half_m)


def at(strips: Strips, value: int, x_m: float, y_m: Array) -> Array:
    return spline_at(height_field(strips, strips, BARE), value, np.full(len(y_m), x_m), y_m)


def test_a_road_is_as_high_as_its_line_with_its_grade_and_bank() -> None:
    found = height_field(*(straight(0.0, 0.08, 3.5, -0.05),) * 2, BARE)
    x, y = np.meshgrid(np.linspace(10.0, 190.0, 60), np.linspace(-3.5, 3.5, 9))
    assert spline_at(found, 0, x, y) == pytest.approx(0.08 * x - 0.05 * y, abs=1e-3)
    grade = np.gradient(spline_at(found, 0, np.arange(20.0, 180.0, 0.5), np.zeros(320)), 0.5)
    assert grade == pytest.approx(0.08, abs=1e-4)


def test_an_edge_lies_where_the_road_ends() -> None:
    y = np.linspace(-5.0, 5.0, 21)
    assert at(straight(0.0), 1, 100.0, y)[[0, 4, 6, 14, 16]] == pytest.approx([3.25, 1.25, 0.25, 0.25, 1.25], abs=0.15)


@pytest.mark.parametrize("apart_m", [3.5, 3.2])
def test_between_lanes_side_by_side_there_is_no_edge(apart_m: float) -> None:
    both = together((straight(0.0), straight(apart_m)))
    assert at(both, 1, 100.0, np.array((0.0, 0.5 * apart_m, apart_m))).max() < -1.0
    assert at(both, 1, 100.0, np.array((-1.75, apart_m + 1.75))) == pytest.approx(0.0, abs=0.15)
    apart = together((straight(0.0), straight(12.0)))
    assert at(apart, 1, 100.0, np.array((6.0,)))[0] > 2.0


def test_land_runs_from_road_to_road_and_is_smooth() -> None:
    two = together((straight(0.0), straight(150.0)._replace(height_m=np.full(200, 10.0))))
    across = at(two, 0, 100.0, np.linspace(-10.0, 160.0, 681))
    assert across.min() > -0.5
    assert across.max() < 10.5
    assert np.abs(np.diff(across)).max() / 0.25 < 0.5, "no cliff"
    assert np.abs(np.diff(across, 2)).max() < 0.02


def test_a_large_world_gets_wider_cells_and_no_more_memory() -> None:
    small = height_field(*(straight(0.0),) * 2, BARE)
    large = height_field(*(together((straight(0.0), straight(4000.0, length_m=5000.0))),) * 2, BARE)
    assert small.grid.cell_m == 1.0
    assert large.grid.cell_m > 4.0
    assert large.nodes.shape[0] * large.nodes.shape[1] < 1.05 * MOST_NODES
    assert np.abs(large.nodes[..., 1]).max() == FAR_M


def test_the_same_strips_give_the_same_bits() -> None:
    one, other = (height_field(*(straight(0.0, 0.03),) * 2, BARE) for _ in range(2))
    assert not difference(one.nodes, other.nodes)
