from copy import deepcopy

import numpy as np

from simconsole.hud.driver_view.mesh import Material, Vertices, joined
from simconsole.hud.driver_view.occupancy import Occupancy
from simconsole.hud.driver_view.road import occupancy_of
from simconsole.hud.driver_view.surroundings import INK, SIGN_RED, surroundings
from simconsole.profiles.files.loader import load
from simconsole.profiles.world import CourseProfile
from simconsole.world.course import Course
from simconsole.world.drawing import draw
from simconsole.world.triangles import triangulate


def test_nothing_stands_on_the_road_and_every_drive_has_the_same_town() -> None:
    course = Course(load("worlds", "urban", CourseProfile))
    drawing = draw(course)
    taken = occupancy_of(drawing)
    built = [joined(surroundings(drawing.path, ((0.0, 50.0),), deepcopy(taken))) for _ in range(2)]
    assert (built[0] == built[1]).all()
    low = built[0]["position"][built[0]["position"][:, 2] < 1.9].astype(float)
    assert not taken.is_taken(low[:, :2]).any()
    assert (built[0]["colour"][:, 3] == Material.WALL).sum() > 1000


def test_the_sign_shows_the_limit() -> None:
    path = np.column_stack((np.linspace(0.0, 100.0, 101), np.zeros(101)))
    drawn = {}
    for limit in (30.0, 50.0, 100.0):
        mesh = surroundings(path, ((0.0, limit),), Occupancy(path.min(axis=0), path.max(axis=0))).signs
        ink = ink_of(mesh)
        assert (ink[:, 1] < -1.8).all()  # right of the lane
        drawn[limit] = np.round(ink[:, 1:], 3).tobytes()
    assert len(set(drawn.values())) == 3


def test_without_a_limit_there_is_no_sign() -> None:
    path = np.column_stack((np.linspace(0.0, 100.0, 101), np.zeros(101)))
    built = surroundings(path, (), Occupancy(path.min(axis=0), path.max(axis=0)))
    assert len(built.signs) == 0
    assert len(joined(built)) > 0
    assert not (joined(built)["colour"][:, :3] == SIGN_RED).all(axis=1).any()


def test_a_limit_that_changes_has_a_sign_where_it_does() -> None:
    path = np.column_stack((np.linspace(0.0, 900.0, 901), np.zeros(901)))
    free = Occupancy(path.min(axis=0), path.max(axis=0))
    ink = ink_of(surroundings(path, ((0.0, 50.0), (300.0, 100.0)), free).signs)
    at_m = np.unique(np.round(ink[:, 0]))
    assert at_m.tolist() == [30.0, 300.0, 700.0]
    assert len(ink[np.round(ink[:, 0]) == 30.0]) < len(ink[np.round(ink[:, 0]) == 300.0])


def test_a_sign_stands_beside_all_lanes() -> None:
    """The path is that of the left of two lanes: 3 m to its right is road."""
    path = np.column_stack((np.linspace(0.0, 100.0, 101), np.zeros(101)))
    grid = Occupancy(path.min(axis=0), path.max(axis=0))
    road = np.array(((0.0, 2.0), (100.0, 2.0), (100.0, -5.5), (0.0, -5.5)))
    grid.add(road, triangulate(road))
    ink = ink_of(surroundings(path, ((0.0, 100.0),), grid).signs)
    assert len(ink) > 0
    assert (ink[:, 1] < -5.8).all()
    assert (ink[:, 1] > -8.0).all()


def ink_of(mesh: Vertices) -> np.ndarray:
    """Where the corners of a sign's digits are."""
    return np.asarray(mesh[(mesh["colour"][:, :3] == INK).all(axis=1)]["position"])


def test_houses_stand_where_the_limit_is_that_of_a_town() -> None:
    path = np.column_stack((np.linspace(0.0, 900.0, 901), np.zeros(901)))
    grid = Occupancy(path.min(axis=0), path.max(axis=0))
    built = surroundings(path, ((0.0, 50.0), (450.0, 100.0)), grid)
    assert built.houses["position"][:, 0].min() < 50.0
    assert built.houses["position"][:, 0].max() < 470.0
    trees = built.trees["position"]
    assert trees[:, 0].max() > 850.0
    beyond = trees[(trees[:, 0] > 470.0) & (trees[:, 2] < 0.1)]  # their feet
    assert np.abs(beyond[:, 1]).min() > 10.0
