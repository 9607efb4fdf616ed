import numpy as np
import pytest

from simconsole.hud.driver_view.camera import Camera, Lens, rotation
from simconsole.hud.driver_view.mesh import Box, box, joined
from simconsole.hud.driver_view.scene import ViewScene, in_sight, pieces, view_scene
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.profiles.files.loader import load
from simconsole.profiles.world import CourseProfile
from simconsole.world.course import Course
from simconsole.world.drawing import Drawing, draw
from tests.samples import Sample

SIZE = Size(3.99, 1.75, 1.45, 0.75, 2.5)


@pytest.fixture(scope="module")
def drawing() -> Drawing:
    return draw(Course(load("worlds", "urban", CourseProfile)))


@pytest.fixture(scope="module")
def scene(drawing: Drawing) -> ViewScene:
    """The town as it is drawn. Not to be changed."""
    return view_scene(drawing, ((0.0, 50.0),), SIZE)


def test_pieces_are_the_mesh_in_another_order() -> None:
    mesh = joined([box(Box(x, y, 0.0, 3.0, 3.0, 5.0), (9, 9, 9)) for x in (-300.0, 0.0, 310.0) for y in (0.0, 200.0)])
    cut = pieces(mesh)
    assert cut.length.sum() == len(mesh)
    assert len(cut.first) >= 6
    assert sorted(vertex.tobytes() for vertex in cut.vertices) == sorted(vertex.tobytes() for vertex in mesh)
    for first, length, centre, radius in zip(cut.first, cut.length, cut.centre, cut.radius, strict=True):
        corners = cut.vertices["position"][first : first + length].astype(float)
        assert np.linalg.norm(corners - centre, axis=1).max() <= radius + 1e-4


def test_nothing_that_a_camera_sees_is_left_out(scene: ViewScene, sample: Sample) -> None:
    """A vertex inside the picture and within reach belongs to a run that is drawn."""
    generator = np.random.Generator(np.random.PCG64(sample.seed))
    solids = scene.solids
    corners = solids.vertices["position"].astype(float)
    for _ in range(sample.of(20, 500)):
        eye = np.array((*corners[generator.integers(len(corners)), :2] + generator.normal(0.0, 20.0, 2), 1.2))
        camera, lens = Camera(eye, rotation(generator.uniform(-3.2, 3.2))), Lens(generator.uniform(0.2, 2.2), 1.6)
        matrix = lens.projection() @ camera.view(np.zeros(3))
        runs = in_sight(solids, matrix, 400.0, eye)
        drawn = np.zeros(len(corners), dtype=bool)
        for first, count in runs:
            drawn[first : first + count] = True
        clip = np.column_stack((corners, np.ones(len(corners)))) @ matrix.T
        inside = (np.abs(clip[:, 0]) < clip[:, 3]) & (np.abs(clip[:, 1]) < clip[:, 3])
        near = np.linalg.norm(corners - eye, axis=1) < 400.0
        assert drawn[inside & near].all()


def test_a_session_without_a_world_has_a_plain_to_move_over() -> None:
    scene = view_scene(None, (), SIZE)
    assert len(scene.layers) == 2
    assert all(len(layer.vertices) > 0 for layer in scene.layers)
    assert len(scene.solids.vertices) == 0
    assert in_sight(scene.solids, np.eye(4), 10.0, np.zeros(3)) == []


def test_every_light_of_the_drawing_has_a_post(drawing: Drawing, scene: ViewScene) -> None:
    with_lights = scene.solids
    without = view_scene(drawing._replace(lights=()), ((0.0, 50.0),), SIZE).solids
    assert len(drawing.lights) > 0
    assert len(with_lights.vertices) > len(without.vertices)
    for light in drawing.lights:
        near = np.hypot(*(with_lights.vertices["position"][:, :2] - (light.x_m, light.y_m)).T) < 0.3
        assert with_lights.vertices["position"][near, 2].max() > 2.5
