import numpy as np

from simconsole.hud.driver_view.mesh import Material, joined
from simconsole.hud.driver_view.occupancy import Occupancy
from simconsole.hud.driver_view.road import occupancy_of
from simconsole.hud.driver_view.surroundings import SIGN_RED, surroundings
from simconsole.profiles.files.loader import load
from simconsole.profiles.world import CourseProfile
from simconsole.world.course import Course
from simconsole.world.drawing import draw


def test_nothing_stands_on_the_road_and_every_drive_has_the_same_town() -> None:
    course = Course(load("worlds", "urban", CourseProfile))
    drawing = draw(course)
    built = [joined(surroundings(drawing.path, 50.0, occupancy_of(drawing))) for _ in range(2)]
    assert (built[0] == built[1]).all()
    low = built[0]["position"][built[0]["position"][:, 2] < 1.9].astype(float)
    assert not occupancy_of(drawing).is_taken(low[:, :2]).any()
    assert (built[0]["colour"][:, 3] == Material.WALL).sum() > 1000


def test_the_sign_shows_the_limit() -> None:
    path = np.column_stack((np.linspace(0.0, 100.0, 101), np.zeros(101)))
    drawn = {}
    for limit in (30.0, 50.0, 100.0):
        mesh = surroundings(path, limit, Occupancy(path.min(axis=0), path.max(axis=0))).signs
        ink = mesh[(mesh["colour"][:, :3] == (24, 24, 26)).all(axis=1)]["position"]
        assert (ink[:, 1] < -1.8).all()  # right of the lane
        drawn[limit] = np.round(ink[:, 1:], 3).tobytes()
    assert len(set(drawn.values())) == 3


def test_without_a_limit_there_is_no_sign() -> None:
    path = np.column_stack((np.linspace(0.0, 100.0, 101), np.zeros(101)))
    built = surroundings(path, 0.0, Occupancy(path.min(axis=0), path.max(axis=0)))
    assert len(built.signs) == 0
    assert len(joined(built)) > 0
    assert not (joined(built)["colour"][:, :3] == SIGN_RED).all(axis=1).any()
