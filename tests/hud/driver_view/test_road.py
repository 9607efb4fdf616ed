import numpy as np
import pytest

from simconsole.hud.driver_view.occupancy import Occupancy
from simconsole.hud.driver_view.road import (
    DASH_M,
    KERB_HEIGHT_M,
    LINE_M,
    THIN_M,
    Array,
    RoadMeshes,
    dashes_of,
    flat,
    occupancy_of,
    road_meshes,
    thinned,
)
from simconsole.profiles.files.loader import load
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import CourseProfile, RoadsProfile
from simconsole.world.course import Course
from simconsole.world.drawing import Drawing, draw
from simconsole.world.kinds.worlds import open_map, open_world
from simconsole.world.roads.road_drawing import beside
from tests.samples import Sample

MARKING_M = 0.02


@pytest.fixture(scope="module")
def course() -> Course:
    return Course(load("worlds", "urban", CourseProfile))


@pytest.fixture(scope="module")
def drawing(course: Course) -> Drawing:
    return draw(course)


@pytest.fixture(scope="module")
def taken(drawing: Drawing) -> Occupancy:
    """The ground that the road takes. Not to be changed."""
    return occupancy_of(drawing)


@pytest.fixture(scope="module")
def meshes(drawing: Drawing, taken: Occupancy) -> RoadMeshes:
    return road_meshes(drawing, taken)


def test_markings_lie_on_the_lane_geometry(course: Course, meshes: RoadMeshes) -> None:
    """Where the road is plain, each painted point is half a line's width beside an edge of a lane."""
    paint = meshes.markings["position"].astype(float)
    half_m = 0.5 * course.world.lane_width_m
    plain = (paint[:, 0] > 20.0) & (paint[:, 0] < 250.0) & (np.abs(paint[:, 1]) < 12.0)
    assert plain.sum() > 100
    beside = np.abs(paint[plain, 1][:, None] - np.array((-half_m, half_m, 3.0 * half_m))).min(axis=1)
    assert np.abs(beside - 0.5 * LINE_M).max() < MARKING_M


@pytest.mark.parametrize("name", ["urban_signals", "country", "motorway"])
def test_markings_of_a_road_map_lie_on_the_borders_of_its_lanes(name: str, sample: Sample) -> None:
    """Each painted point is half a line's width beside a border, however thinned the line is."""
    world = load_world(name)
    assert isinstance(world, RoadsProfile)
    drawing = open_world(world).drawing
    paint = road_meshes(drawing, occupancy_of(drawing)).markings["position"][:, :2].astype(float)
    borders = [
        beside(lane.line[:, :2], side * 0.5 * lane.width_m)
        for lane in open_map(world).lanes
        for side in (-1.0, 1.0)
    ]  # fmt: skip
    starts, ends = np.vstack([line[:-1] for line in borders]), np.vstack([line[1:] for line in borders])
    along = ends - starts
    squared = np.maximum((along**2).sum(axis=1), 1e-12)
    generator = np.random.Generator(np.random.PCG64(sample.seed))
    for point in generator.choice(paint, sample.of(100, 3000), replace=False):
        share = np.clip(((point - starts) * along).sum(axis=1) / squared, 0.0, 1.0)
        away = np.hypot(*(starts + share[:, None] * along - point).T)
        assert np.abs(away - 0.5 * LINE_M).min() < MARKING_M, point
        assert away.min() < 0.5 * LINE_M + MARKING_M, point


def test_markings_follow_every_bend_of_the_lane(course: Course, drawing: Drawing, meshes: RoadMeshes) -> None:
    edges = [line for line in drawing.edges if len(line) > 20]
    points = np.vstack([thinned(line) for line in edges])
    s, lateral = course.project_all(points[:, 0], points[:, 1])
    paint = meshes.markings["position"].astype(float)
    for index in range(0, len(points), 17):
        nearest = np.hypot(*(paint[:, :2] - points[index]).T).min()
        assert nearest < 0.5 * LINE_M + MARKING_M, (s[index], lateral[index])


def test_thinned_lines_stay_where_they_were(drawing: Drawing) -> None:
    lines = drawing.edges
    for line in lines:
        sparse = thinned(line)
        assert (sparse[0] == line[0]).all()
        assert (sparse[-1] == line[-1]).all()
        assert distances_m(line, sparse).max() <= THIN_M
    assert sum(len(thinned(line)) for line in lines) < 0.5 * sum(len(line) for line in lines)


def test_lines_that_turn_back_keep_their_end() -> None:
    there_and_back = np.array(((0.0, 0.0), (5.0, 0.0), (10.0, 0.0), (5.0, 0.0), (0.0, 0.0)))
    assert thinned(there_and_back).tolist() == [[0.0, 0.0], [10.0, 0.0], [0.0, 0.0]]
    assert thinned(there_and_back[:2]).tolist() == there_and_back[:2].tolist()


def distances_m(points: Array, line: Array) -> Array:
    """Of points [N, 2] from a line [M, 2]."""
    starts, steps = line[:-1], np.diff(line, axis=0)
    square = np.maximum((steps * steps).sum(axis=1), 1e-12)
    share = (((points[:, None] - starts) * steps).sum(axis=2) / square).clip(0.0, 1.0)
    return np.asarray(np.hypot(*(points[:, None] - starts - share[..., None] * steps).T).min(axis=0))


def test_kerbs_stand_beside_the_road_and_never_on_it(course: Course, meshes: RoadMeshes) -> None:
    kerb = meshes.kerbs["position"].astype(float)
    assert kerb[:, 2].max() == pytest.approx(KERB_HEIGHT_M)
    half_m = 0.5 * course.world.lane_width_m
    straight = (kerb[:, 0] > 40.0) & (kerb[:, 0] < 240.0) & (np.abs(kerb[:, 1]) < 12.0)
    assert straight.sum() > 100
    on_road = (kerb[straight, 1] > -half_m) & (kerb[straight, 1] < 3.0 * half_m)
    assert not on_road.any()


def test_flat_polygons_face_up_whichever_way_they_turn() -> None:
    square = np.array(((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)))
    for polygon in (square, square[::-1]):
        assert (flat(polygon, (1, 2, 3))["normal"][:, 2] == 255).all()


def test_dashes_are_as_long_as_they_should_be_and_keep_the_bend() -> None:
    angles = np.linspace(0.0, 2.0, 80)
    line = 25.0 * np.column_stack((np.cos(angles), np.sin(angles)))
    dashes = dashes_of(line)
    assert len(dashes) >= 4
    for dash in dashes[:-1]:
        assert np.hypot(*np.diff(dash, axis=0).T).sum() == pytest.approx(DASH_M, abs=0.01)
        assert np.abs(np.hypot(*dash.T) - 25.0).max() < MARKING_M


def test_the_road_takes_its_ground(course: Course, taken: Occupancy) -> None:
    assert taken.is_taken(course.offset(0.0, 0.0, course.length_m)).all()


def test_a_road_outside_of_towns_has_verges_instead_of_kerbs(
    course: Course, drawing: Drawing, taken: Occupancy
) -> None:
    town, country = road_meshes(drawing, taken, ((0.0, 50.0),)), road_meshes(drawing, taken, ((0.0, 100.0),))
    assert len(town.kerbs) > len(town.verges) == 0
    assert len(country.verges) > len(country.kerbs) == 0
    assert (country.verges["normal"][:, 2] == 255).all()
    outer = ~taken.is_taken(country.verges["position"][:, :2].astype(float))
    assert 0.45 < outer.mean() < 0.55  # one rim on the road's edge, the other one beside the road
    half = road_meshes(drawing, taken, ((0.0, 50.0), (0.5 * course.length_m, 100.0)))
    assert 0 < len(half.kerbs) < len(town.kerbs)
    assert 0 < len(half.verges) < len(country.verges)
