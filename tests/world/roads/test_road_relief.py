"""The ground of the shipped hilly road: it follows the map's heights, smoothly, and banks in its bends."""

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.values.height_field import HeightField, spline_at
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_world import roads_of
from simconsole.world.world import World


@pytest.fixture(scope="module")
def country() -> World:
    return open_world(load_world("country"))


@pytest.fixture(scope="module")
def ground(country: World) -> HeightField:
    assert country.ground is not None
    return country.ground


def test_the_road_is_as_high_as_the_map_says(country: World, ground: HeightField) -> None:
    roads = roads_of(country)
    assert roads is not None
    lanes = [lane for lane in roads.road_map.lanes if lane.drivable and lane.length_m > 100.0]
    away = [np.abs(spline_at(ground, 0, lane.line[:, 0], lane.line[:, 1]) - lane.line[:, 2]) for lane in lanes]
    # 40 m vertical curves cut the tops of the hills' short waves; a bank of 5 % turns a lane by 8 cm about the axis.
    assert max(part.max() for part in away) < 0.25
    heights = spline_at(ground, 0, country.route.x, country.route.y)
    assert np.ptp(heights) > 35.0


def test_grades_change_gently_along_the_route_and_it_lies_on_the_road(country: World, ground: HeightField) -> None:
    points = np.array([country.route.at(s)[:2] for s in np.arange(0.0, country.route.length_m, 1.0).tolist()])
    heights = spline_at(ground, 0, *points.T)
    assert 0.08 < np.abs(np.diff(heights)).max() < 0.13
    assert np.abs(np.diff(heights, 2)).max() < 0.005
    assert spline_at(ground, 1, *points.T).max() < -1.0


def test_bends_are_banked_to_the_inside(country: World, ground: HeightField) -> None:
    route = country.route
    bend = [s for s in np.arange(60.0, route.length_m - 60.0, 10.0).tolist() if abs(route.curvature_at(s)) > 0.004]
    assert len(bend) > 30
    shares = []
    for s in bend:
        x, y, yaw, curvature = route.at(s)
        left = np.array((-np.sin(yaw), np.cos(yaw)))
        places = np.array((x, y)) + np.array((1.0, -1.0))[:, None] * left
        high = spline_at(ground, 0, *places.T)
        shares.append(-np.sign(curvature) * (high[0] - high[1]) / 2.0)
    assert np.median(shares) == pytest.approx(0.05, abs=0.003)


def test_a_map_without_ground_is_flat() -> None:
    assert open_world(load_world("motorway")).ground is None
