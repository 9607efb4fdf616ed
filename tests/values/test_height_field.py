"""Heights between the nodes of a field: smooth, never outside of what lies around, equal in both executions."""

import math
import random

import numpy as np
import pytest

from simconsole.values.ground import GROUND, NODES_AT, Ground, ground_row
from simconsole.values.height_field import RAMP_M, Grid, HeightField, Spot, spline_at, spot_at
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import Row
from simconsole.values.layout import read
from tests.samples import Sample

CELL_M = 2.0


def field(heights: object, edges: object = None, kerb_m: float = 0.0, off_road_share: float = 1.0) -> HeightField:
    """Return a field about the origin."""
    high = np.asarray(heights, dtype=np.float64)
    away = np.full(high.shape, -3.0) if edges is None else np.asarray(edges, dtype=np.float64)
    rows, columns = high.shape
    grid = Grid(
        -CELL_M * (columns // 2), -CELL_M * (rows // 2), CELL_M, 1.0 / CELL_M, columns, rows, kerb_m, off_road_share
    )
    return HeightField(grid, np.stack((high, away), axis=-1))


def places(count: int = 41) -> tuple[np.ndarray, np.ndarray]:
    axis = CELL_M * (np.arange(count) - count // 2)
    x, y = np.meshgrid(axis, axis)
    return x, y


def array(of: HeightField) -> Row:
    return ground_row(Ground(1.0, 0.0, 0.0, field=of))


def at(row: Row, x_m: float, y_m: float) -> Spot:
    return spot_at(row, NODES_AT, read(row, GROUND.grid), x_m, y_m)


def test_a_plane_comes_back_exactly_and_a_bend_nearly() -> None:
    x, y = places()
    row = array(field(5.0 + 0.1 * x - 0.02 * y))
    for place in ((0.3, -7.7), (11.0, 0.0), (-20.9, 19.1)):
        found = at(row, *place)
        assert found.height_m == pytest.approx(5.0 + 0.1 * place[0] - 0.02 * place[1], abs=1e-12)
        assert (found.slope_x, found.slope_y) == pytest.approx((0.1, -0.02), abs=1e-12)
    row = array(field(x * x / 1000.0))
    assert at(row, 13.0, 2.0).slope_x == pytest.approx(2.0 * 13.0 / 1000.0, abs=1e-12)
    assert at(row, 13.0, 2.0).height_m == pytest.approx(0.169, abs=0.002)


def test_heights_and_slopes_are_continuous_and_slopes_are_those_of_the_heights() -> None:
    rng = np.random.default_rng(7)
    row = array(field(rng.uniform(0.0, 1.0, (41, 41)), rng.uniform(-1.0, 1.0, (41, 41)), kerb_m=0.12))
    way = np.arange(-30.0, 30.0, 0.001)
    found = [at(row, s, 0.37 * s + 0.11) for s in way.tolist()]
    heights = np.array([spot.height_m for spot in found])
    slopes = np.array([spot.slope_x + 0.37 * spot.slope_y for spot in found])
    assert heights.min() >= 0.0, "never beyond the nodes around"
    assert heights.max() <= 1.12
    assert np.abs(np.diff(slopes)).max() < 0.025, "no step in the slope"
    assert np.gradient(heights, 0.001)[1:-1] == pytest.approx(slopes[1:-1], abs=0.015)


def test_a_kerb_rises_where_the_road_ends_wherever_the_nodes_lie() -> None:
    x, y = places()
    for turn in (0.0, 0.3, 1.1):
        for edge_m in (0.0, 0.71, 1.33):
            away = math.cos(turn) * x + math.sin(turn) * y - edge_m
            row = array(field(0.0 * x, away, kerb_m=0.1, off_road_share=0.5))

            def beside(metres: float) -> Spot:
                s = edge_m + metres  # noqa: B023
                return at(row, s * math.cos(turn), s * math.sin(turn))  # noqa: B023

            assert (beside(-0.01).height_m, beside(-0.01).friction_share) == (0.0, 1.0)
            assert beside(0.5 * RAMP_M).height_m == pytest.approx(0.05, abs=1e-9)
            assert beside(0.5 * RAMP_M).friction_share == pytest.approx(0.75, abs=1e-9)
            assert beside(RAMP_M + 0.01) == pytest.approx(Spot(0.1, 0.0, 0.0, 0.5), abs=1e-12)


def test_the_ground_goes_on_level_beyond_the_grid_and_where_no_number_is() -> None:
    x, _ = places()
    row = array(field(0.1 * x))
    rim = at(row, 1e6, 0.0)
    assert (rim.slope_x, rim.slope_y) == (0.0, 0.0)
    assert rim.height_m == pytest.approx(0.1 * CELL_M * 19, abs=1e-9)
    for bad in (math.nan, math.inf, -math.inf, 1e300):
        assert math.isfinite(at(row, bad, bad).height_m)


def test_both_executions_and_the_arrays_for_drawing_agree(sample: Sample) -> None:
    rng = random.Random(sample.seed)
    draw = np.random.default_rng(sample.seed)
    rough = field(draw.uniform(-5.0, 5.0, (31, 41)), draw.uniform(-3.0, 3.0, (31, 41)), kerb_m=0.0)
    row = array(rough)
    fast = compiled(spot_at)
    spots = [(rng.uniform(-60.0, 60.0), rng.uniform(-60.0, 60.0)) for _ in range(sample.of(300, 20_000))]
    grid = read(row, GROUND.grid)
    for place in spots:
        assert at(row, *place) == fast(row, NODES_AT, grid, *place)
    x, y = np.array(spots).T
    assert spline_at(rough, 0, x, y) == pytest.approx([at(row, *place).height_m for place in spots], abs=1e-12)
