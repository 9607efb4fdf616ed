"""A scene on ground with height: meshes follow it, without gaps, in their layers."""

import numpy as np
import pytest

from simconsole.hud.driver_view.hills import LAYER_M, LONGEST_M, SUNK_M, divided, draped, heights, land, lifted, stood
from simconsole.hud.driver_view.mesh import Box, Material, box, quads
from simconsole.hud.driver_view.road import flat
from simconsole.hud.driver_view.scene import view_scene, world_parts
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.profiles.files.world_files import load_world
from simconsole.values.height_field import HeightField
from simconsole.world.drawing import Drawing
from simconsole.world.kinds.worlds import open_world
from tests.values.test_height_field import field, places

GREY = (90, 90, 90)
SIZE = Size(3.99, 1.75, 1.45, 0.75, 2.5)


@pytest.fixture(scope="module")
def hill() -> HeightField:
    x, y = places()
    return field(3.0 * np.sin(0.1 * x) + 0.05 * y)


@pytest.fixture(scope="module")
def drawing() -> Drawing:
    return open_world(load_world("country")).drawing


def test_a_divided_mesh_covers_the_same_with_short_edges_and_shared_corners() -> None:
    square = quads(np.array([((0.0, 0.0, 0.0), (30.0, 0.0, 0.0), (30.0, 7.0, 0.0), (0.0, 7.0, 0.0))]), GREY)
    small = divided(square, LONGEST_M)
    corners = small["position"].reshape(-1, 3, 3)
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    assert edges.max() <= LONGEST_M
    area = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    assert area.min() > 0.0, "each still faces up"
    assert area.sum() == pytest.approx(210.0, rel=1e-5)
    sides = np.sort(np.round(np.stack((corners, np.roll(corners, 1, axis=1)), axis=2).reshape(-1, 2, 3), 4), axis=1)
    inner = sides[~(np.isin(sides[..., 0], (0.0, 30.0)).all(axis=1) | np.isin(sides[..., 1], (0.0, 7.0)).all(axis=1))]
    _, counts = np.unique(inner.reshape(-1, 6), axis=0, return_counts=True)
    assert (counts == 2).all(), "every inner edge belongs to two triangles: no gaps"


def test_a_draped_road_lies_on_the_ground_and_leans_with_it(hill: HeightField) -> None:
    road = flat(np.array(((-20.0, -3.0), (20.0, -3.0), (20.0, 3.0), (-20.0, 3.0))), GREY, Material.ROAD)
    found = draped(road, hill, 0.02)
    points = found["position"].astype(float)
    assert points[:, 2] == pytest.approx(heights(hill, points) + 0.02, abs=1e-5)
    middles = points.reshape(-1, 3, 3).mean(axis=1)
    assert middles[:, 2] == pytest.approx(heights(hill, middles) + 0.02, abs=0.03 * LONGEST_M**2 / 8.0)
    normals = (found["normal"][:, :3].astype(float) - 128.0) / 127.0
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0, abs=0.02)
    assert normals[:, 2].min() > 0.9
    assert np.abs(normals[:, 0]).max() > 0.2


def test_what_stands_is_lifted_and_a_house_stays_upright(hill: HeightField) -> None:
    place = Box(x_m=5.0, y_m=0.0, z_m=0.0, half_length_m=4.0, half_width_m=3.0, height_m=6.0)
    house = box(place, GREY)
    up = stood(house, hill)["position"][:, 2] - house["position"][:, 2]
    assert np.ptp(up) < 1e-5
    assert up[0] == pytest.approx(heights(hill, house["position"].astype(float)).min(), abs=1e-5)
    assert stood(house, None) is house
    assert np.ptp(lifted(house, hill)["position"][:, 2] - house["position"][:, 2]) > 0.1


def test_the_land_is_the_field_and_goes_on_around_it(hill: HeightField) -> None:
    points = land(hill, GREY)["position"].astype(float)
    inside = np.abs(points[:, :2]).max(axis=1) < 39.0
    assert points[inside][:, 2] == pytest.approx(heights(hill, points[inside]) - SUNK_M, abs=1e-4)
    assert points[:, 0].min() < -2000.0


def test_everything_of_the_hilly_road_is_on_its_ground(drawing: Drawing) -> None:
    """Asphalt, paint and kerbs lie on the field, the land below them, and posts stand on it."""
    ground = drawing.ground
    assert ground is not None
    parts = {part.name: part for part in world_parts(drawing, ((0.0, 50.0),))}
    parts["verges"] = next(part for part in world_parts(drawing, ((0.0, 80.0),)) if part.name == "verges")
    bounds = (("asphalt", 0.0, 0.02), ("verges", 0.0, 0.05), ("markings", 0.0, 0.05), ("kerbs", -0.01, 0.13))
    for name, low, high in bounds:
        points = parts[name].mesh["position"].astype(float)
        above = points[:, 2] - heights(ground, points)
        assert low - 1e-3 <= above.min() <= above.max() <= high + 1e-3
    asphalt = parts["asphalt"].mesh["position"].reshape(-1, 3, 3).astype(float).mean(axis=1)
    assert np.abs(asphalt[:, 2] - LAYER_M - heights(ground, asphalt)).max() < 0.02, "between its corners, too"
    land_corners = parts["land"].mesh["position"].reshape(-1, 3, 3).astype(float)
    assert np.ptp(land_corners[:, :, 2]) > 35.0
    assert covered(land_corners, asphalt[::7]) < -0.05, "nowhere does the land cover the road"


def covered(triangles: np.ndarray, points: np.ndarray) -> float:
    """Return by how much the land is above points [N, 3] at the worst."""
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    worst = -np.inf
    for x, y, z in points.tolist():
        around = triangles[(low[:, 0] <= x) & (x <= high[:, 0]) & (low[:, 1] <= y) & (y <= high[:, 1])]
        for a, b, c in around:
            share = np.linalg.solve(np.column_stack((b[:2] - a[:2], c[:2] - a[:2])), np.array((x, y)) - a[:2])
            if share.min() >= 0.0 and share.sum() <= 1.0:
                worst = max(worst, a[2] + share @ np.array((b[2] - a[2], c[2] - a[2])) - z)
    return float(worst)


def test_other_vehicles_are_told_how_high_the_ground_is(drawing: Drawing) -> None:
    scene = view_scene(drawing, ((0.0, 80.0),), SIZE)
    x, y = drawing.path[len(drawing.path) // 3]
    assert drawing.ground is not None
    assert scene.height_m(x, y) == pytest.approx(float(heights(drawing.ground, drawing.path)[len(drawing.path) // 3]))
    assert view_scene(None, (), SIZE).height_m(x, y) == 0.0
