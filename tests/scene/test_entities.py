import subprocess
import sys

import numpy as np
import pytest

from simconsole.scene.entities import (
    DASH_M,
    GAP_M,
    LAND_SUNK_M,
    MODE_COLOURS,
    Array,
    Dimensions,
    Mesh,
    car_solids,
    dashes,
    mesh,
    on_map,
    raised,
    world_shapes,
)
from simconsole.values.height_field import spline_at
from simconsole.values.signals import Mode
from simconsole.world.drawing import Drawing
from simconsole.world.drawing_layers import Light
from tests.values.test_height_field import field, places

SQUARE = np.array(((0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)))


def area(shape: Mesh) -> float:
    a, b, c = (shape.vertices[shape.triangles[:, corner], :2] for corner in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    return float(0.5 * np.abs(ux * vy - uy * vx).sum())


def test_a_mesh_covers_its_polygons() -> None:
    shape = mesh((SQUARE, SQUARE + 10.0), 0.25)
    assert area(shape) == pytest.approx(24.0)
    assert shape.vertices.shape == (8, 3)
    assert (shape.vertices[:, 2] == 0.25).all()
    assert set(shape.triangles[:2].ravel()) == set(range(4))
    assert set(shape.triangles[2:].ravel()) == set(range(4, 8))


def test_no_polygon_is_an_empty_mesh() -> None:
    shape = mesh((), 0.0)
    assert shape.vertices.shape == (0, 3)
    assert shape.triangles.shape == (0, 3)


def test_dashes_are_painted_along_the_line() -> None:
    line = np.column_stack((np.arange(0.0, 30.1, 1.0), np.zeros(31)))
    found = dashes(line)
    assert [float(dash[0, 0]) for dash in found] == pytest.approx(np.arange(0.0, 29.0, DASH_M + GAP_M).tolist())
    assert all(dash[-1, 0] - dash[0, 0] <= DASH_M + 1e-9 for dash in found)
    assert found[0][-1, 0] == pytest.approx(DASH_M)


def test_north_stays_up_on_the_map() -> None:
    flat = on_map(np.array(((1.0, 2.0, 5.0), (3.0, -4.0, 5.0))))
    assert flat.tolist() == [[1.0, -2.0], [3.0, 4.0]]
    assert raised(np.zeros((2, 3)), 0.5).tolist() == [[0.0, 0.0, 0.5]] * 2


def test_the_car_box_is_the_car_around_base_link() -> None:
    size = Dimensions(length_m=4.2, width_m=1.8, height_m=1.5, rear_overhang_m=0.8)
    solids = car_solids(size)
    low = np.min([np.subtract(solid.centre, solid.half_size) for solid in solids], axis=0)
    high = np.max([np.add(solid.centre, solid.half_size) for solid in solids], axis=0)
    assert low[:2] == pytest.approx((-0.8, -0.9))
    assert high == pytest.approx((3.4, 0.9, 1.5))
    assert 0.0 < low[2] < 0.3


def test_a_ball_is_a_ball_and_seen_from_near() -> None:
    ball = Dimensions(1.0, 1.0, 1.0, 0.5)
    assert ball.is_ball
    assert ball.scale == pytest.approx(0.25)
    car = Dimensions(4.25, 1.8, 1.5, 0.8)
    assert not car.is_ball
    assert car.scale == 1.0


def drawing() -> Drawing:
    line: Array = np.column_stack((np.arange(0.0, 101.0), np.zeros(101)))
    left = np.add(line, (0.0, 5.0))
    return Drawing(
        surfaces=(SQUARE, SQUARE + 4.0),
        islands=(),
        edges=(np.subtract(line, (0.0, 2.0)), left),
        centre_lines=(np.add(line, (0.0, 1.5)),),
        zebras=(SQUARE,),
        stop_lines=(SQUARE + 20.0,),
        lights=(Light(10.0, 3.0, 0.0), Light(20.0, 3.0, np.pi)),
        path=line,
    )


def test_a_course_becomes_shapes() -> None:
    shapes = world_shapes(drawing())
    assert area(shapes.surfaces) == pytest.approx(24.0)
    assert area(shapes.paint) == pytest.approx(24.0)
    assert len(shapes.islands.triangles) == 0
    assert [edge.shape for edge in shapes.edges] == [(101, 3), (101, 3)]
    assert len(shapes.centre_dashes) == 15
    assert shapes.path[:, 0].tolist() == list(range(101))
    # Paint over asphalt, the theoretical path over paint, land under all.
    heights = [shapes.ground.vertices, shapes.surfaces.vertices, shapes.paint.vertices, shapes.path]
    assert [float(points[0, 2]) for points in heights] == sorted({float(points[0, 2]) for points in heights})


def test_lamps_look_at_the_traffic_that_comes() -> None:
    shapes = world_shapes(drawing())
    assert shapes.light_lamps.shape == (2, 3, 3)
    offsets = shapes.light_lamps[:, 0, 0] - shapes.light_posts[:, 0]
    assert offsets[0] < 0.0 < offsets[1]
    red, amber, green = shapes.light_lamps[0, :, 2]
    assert red > amber > green > 2.5


def test_a_course_without_lights_has_no_lamps() -> None:
    shapes = world_shapes(drawing()._replace(lights=()))
    assert shapes.light_posts.shape == (0, 3)
    assert shapes.light_lamps.shape == (0, 3, 3)


def test_every_mode_has_a_colour_of_its_own() -> None:
    assert set(MODE_COLOURS) == set(Mode)
    assert len(set(MODE_COLOURS.values())) == len(Mode)
    assert all(max(colour) > 100 for colour in MODE_COLOURS.values())


def test_the_core_loads_no_rerun() -> None:
    program = (
        "import sys; import simconsole.scene.entities, simconsole.scene.timeline, simconsole.scene.viewer.export, "
        "simconsole.scene.viewer.follow; "
        "sys.exit(any(m in sys.modules for m in ('rerun', 'pygame', 'numba', 'matplotlib')))"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_on_ground_with_height_every_shape_lies_on_it() -> None:
    x, y = places()
    hill = field(2.0 + 0.1 * x - 0.05 * y)
    level, raised = world_shapes(drawing()), world_shapes(drawing()._replace(ground=hill))
    pairs = [(level.surfaces.vertices, raised.surfaces.vertices), (level.path, raised.path)]
    pairs += [*zip(level.edges, raised.edges, strict=True), (level.light_posts, raised.light_posts)]
    for flat, high in pairs:
        assert high[:, :2] == pytest.approx(flat[:, :2])
        assert high[:, 2] - flat[:, 2] == pytest.approx(spline_at(hill, 0, flat[:, 0], flat[:, 1]))
    feet = spline_at(hill, 0, level.light_posts[:, 0], level.light_posts[:, 1])
    assert raised.light_lamps[..., 2] - level.light_lamps[..., 2] == pytest.approx(np.tile(feet[:, None], 3))
    land = raised.ground.vertices
    assert land[:, 2] == pytest.approx(spline_at(hill, 0, land[:, 0], land[:, 1]) - LAND_SUNK_M)
    corners = land[raised.ground.triangles]
    assert np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2].min() > 0.0
