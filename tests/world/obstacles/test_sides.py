"""Outlines as sides in a grid: all of those that a vehicle may touch lie in the cell of its base_link."""

import numpy as np
import pytest

from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.values.platform import Ground, Pose
from simconsole.vehicle.platforms import build
from simconsole.world.obstacles.sides import CELL_M, CONE_KG, Body, FixedThings, body_of, fixed_things
from simconsole.world.roads.road_map import BUILDING, CONE, WALL, Array, Obstacle
from tests.samples import Sample
from tests.world.nets import straight_map

BODY = Body(half_length_m=2.2, half_width_m=0.9, middle_ahead_m=1.4, cg_ahead_m=1.3, per_kg=7e-4, per_kgm2=5e-4)
REACH_M = float(np.hypot(3.6, 0.9))
LANES = straight_map().lanes
FLAT = Ground(friction=1.0, slope_x=0.0, slope_y=0.0)


def thing(*corners: tuple[float, float], kind: str = BUILDING) -> Obstacle:
    return Obstacle(kind, np.array(corners))


def cell_of(things: FixedThings, x_m: float, y_m: float) -> list[int]:
    column, row = ((value - low) // CELL_M for value, low in zip((x_m, y_m), things.grid[:2], strict=True))
    if not (0 <= column < things.grid[2] and 0 <= row < things.grid[3]):
        return []
    cell = int(row * things.grid[2] + column)
    found: list[int] = things.items[things.starts[cell] : things.starts[cell + 1]].tolist()
    return found


def away(sides: Array, x_m: float, y_m: float) -> Array:
    to = np.array((x_m, y_m)) - sides[:, :2]
    along = np.clip((to * sides[:, 2:4]).sum(axis=1), 0.0, sides[:, 4])
    return np.asarray(np.hypot(*(to - along[:, None] * sides[:, 2:4]).T))


@pytest.mark.parametrize("turned", [1, -1])
def test_things_lie_to_the_left_of_their_sides_however_they_are_written(turned: int) -> None:
    square = thing(*((0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (0.0, 0.0))[::turned])
    sides = fixed_things([square], LANES).sides
    assert len(sides) == 4
    assert sorted(sides[:, 4]) == [3.0, 3.0, 4.0, 4.0]
    middles = sides[:, :2] + 0.5 * sides[:, 2:4] * sides[:, 4:5]
    left = np.stack((-sides[:, 3], sides[:, 2]), axis=1)
    assert ((np.array((2.0, 1.5)) - middles) * left).sum(axis=1) == pytest.approx(0.5 * (7.0 - sides[:, 4]))


def test_a_line_has_two_sides_and_only_cones_move() -> None:
    things = fixed_things([thing((0.0, 5.0), (9.0, 5.0), kind=WALL), thing((0, 1), (1, 1), (1, 2), kind=CONE)], LANES)
    assert things.sides[:2, 2].tolist() == [1.0, -1.0]
    assert things.sides[:, 5].tolist() == [0.0, 0.0, 1.0, 1.0, 1.0]
    assert things.sides[:, 6].tolist() == [0.0, 0.0, *(1.0 / CONE_KG,) * 3]


def test_long_sides_are_cut_and_what_is_far_from_the_roads_is_left_out() -> None:
    things = fixed_things([thing((-5000.0, 5.0), (5000.0, 5.0), (0.0, 9000.0))], LANES)
    assert things.sides[:, 4].max() <= CELL_M
    assert things.sides[:, 0].min() > -260.0
    assert things.sides[:, :2].max() < 460.0
    assert things.sides[:, 4].sum() == pytest.approx(things.sides[:, 0].max() + CELL_M - things.sides[:, 0].min())
    assert len(fixed_things([thing((0, 5000), (9, 5000), (9, 5009))], LANES).sides) == 0


def test_a_cell_has_all_sides_that_a_vehicle_there_may_touch(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    some = [
        Obstacle(BUILDING, rng.uniform((-50.0, -80.0), (250.0, 80.0)) + rng.normal(0.0, rng.uniform(1.0, 30.0), (5, 2)))
        for _ in range(60)
    ]
    things = fixed_things(some, LANES, BODY)
    for x_m, y_m in rng.uniform((-150.0, -200.0), (350.0, 200.0), (sample.of(500, 20_000), 2)).tolist():
        found = cell_of(things, x_m, y_m)
        assert set(np.flatnonzero(away(things.sides, x_m, y_m) <= REACH_M).tolist()) <= set(found)
        assert found == sorted(found), "thing by thing"


def test_a_vehicle_that_is_longer_than_its_grid_allows_is_refused() -> None:
    with pytest.raises(ValueError, match=r"a corner is 18\.0 m from base_link: at most 12\.5 m"):
        fixed_things([], LANES, BODY._replace(half_length_m=16.6))


def test_a_car_has_its_size_and_mass_and_a_ball_none() -> None:
    car, ball = (build(load_vehicle(name), Pose(0.0, 0.0, 0.0), FLAT) for name in ("hatchback", "ball"))
    body = body_of(car)
    assert car.solid is not None
    assert 2.0 * body.half_length_m == car.length_m
    assert body.middle_ahead_m + body.half_length_m == pytest.approx(car.length_m - car.rear_overhang_m)
    assert 1.0 / body.per_kg == pytest.approx(car.solid.mass_kg)
    assert (body_of(ball).per_kg, body_of(ball).per_kgm2) == (0.0, 0.0)
