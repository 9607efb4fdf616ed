import numpy as np
import pytest

from simconsole.hud.driver_view.occupancy import MARGIN_M, Occupancy
from simconsole.world.triangles import triangulate

SQUARE = np.array(((0.0, 0.0), (20.0, 0.0), (20.0, 10.0), (0.0, 10.0)))


@pytest.fixture
def road() -> Occupancy:
    grid = Occupancy(SQUARE.min(axis=0), SQUARE.max(axis=0))
    grid.add(SQUARE, triangulate(SQUARE))
    return grid


def test_ground_under_triangles_is_taken_whichever_way_they_turn(road: Occupancy) -> None:
    inside = np.array(((10.0, 5.0), (1.0, 1.0), (19.0, 9.0)))
    outside = np.array(((-2.0, 5.0), (22.0, 5.0), (10.0, 12.0), (10.0, -2.0)))
    assert road.is_taken(inside).all()
    assert not road.is_taken(outside).any()
    mirrored = Occupancy(SQUARE.min(axis=0), SQUARE.max(axis=0))
    mirrored.add(SQUARE[::-1], triangulate(SQUARE[::-1]))
    assert mirrored.is_taken(inside).all()


def test_a_disc_is_taken_once_and_only_where_all_is_free(road: Occupancy) -> None:
    assert not road.take_disc(10.0, 12.0, 4.0)
    assert road.take_disc(10.0, 18.0, 4.0)
    assert not road.take_disc(12.0, 18.0, 4.0)


def test_nothing_stands_beyond_the_grid(road: Occupancy) -> None:
    assert not road.take_disc(20.0 + MARGIN_M, 5.0, 4.0)
    assert not road.is_taken(np.array([(1e6, -1e6)])).any()
