"""The ground's array: every part in its place."""

import math

import pytest

from simconsole.values.ground import (
    GROUND,
    LEAST_FRICTION,
    MOST_PATCHES,
    NO_PATCH,
    NODES_AT,
    Ground,
    Patch,
    ground_row,
)
from simconsole.values.layout import read
from simconsole.values.units import STANDARD_GRAVITY_MPS2
from tests.values.test_height_field import field

ICE = Patch(0.0, 1.0, 0.0, 1.0, 0.5)


def test_a_plane_is_a_short_array_with_what_follows_from_its_slope() -> None:
    row = ground_row(Ground(0.8, 0.3, 0.4, right_share=0.25, wind_x_mps=3.0, patches=(ICE,)))
    plane = read(row, GROUND.plane)
    assert len(row) == NODES_AT
    assert plane.gravity_mps2 == pytest.approx(STANDARD_GRAVITY_MPS2 / math.sqrt(1.25))
    assert (plane.friction, plane.right_share, plane.wind_x_mps) == (0.8, 0.25, 3.0)
    assert math.hypot(plane.rise_x, plane.rise_y) == pytest.approx(0.5 / math.sqrt(1.25)), "per metre along the plane"
    assert [read(row, part) for part in GROUND[1:5]] == [ICE, NO_PATCH, NO_PATCH, NO_PATCH]


def test_the_field_follows_with_its_grid() -> None:
    of = field([[float(10 * row + column) for column in range(5)] for row in range(4)])
    row = ground_row(Ground(1.0, 0.0, 0.0, field=of))
    assert read(row, GROUND.grid) == of.grid
    assert row[NODES_AT::2].tolist() == of.nodes[:, :, 0].ravel().tolist()


def test_there_is_always_a_little_friction_for_a_tyre_divides_by_it() -> None:
    plane = read(ground_row(Ground(0.0, 0.0, 0.0, right_share=0.0)), GROUND.plane)
    assert plane.friction == plane.right_share == LEAST_FRICTION


def test_more_patches_than_there_is_room_for_are_refused() -> None:
    with pytest.raises(ValueError, match="at most 4"):
        ground_row(Ground(1.0, 0.0, 0.0, patches=(ICE,) * (MOST_PATCHES + 1)))


def test_no_place_lies_on_the_patch_that_is_none() -> None:
    assert NO_PATCH.from_x_m > NO_PATCH.to_x_m
    assert NO_PATCH.from_y_m > NO_PATCH.to_y_m
