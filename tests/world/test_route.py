import math
from itertools import pairwise

import numpy as np
import pytest

from simconsole.values.platform import Pose
from simconsole.world.course import Course
from simconsole.world.path_geometry import Piece, travel
from simconsole.world.route import Route, Stretch


@pytest.fixture
def bend() -> Route:
    """20 m straight at 50 km/h, then a quarter of a circle of 10 m at 30 km/h."""
    first = Piece(20.0, 0.0, 0.0)
    start = Pose(1.0, 2.0, 0.3)
    second = Piece(5.0 * math.pi, 0.1, 0.1)
    return Route([Stretch(0.0, start, first, 50.0 / 3.6), Stretch(20.0, travel(start, first), second, 30.0 / 3.6)])


def test_points_are_one_lap(course: Course) -> None:
    points = course.points()
    steps = [math.dist(one[:2], other[:2]) for one, other in pairwise((*points, points[0]))]
    assert len(points) > 1000
    assert max(steps) <= 2.01


@pytest.mark.parametrize("s_m", [-7.0, 60.0])
def test_open_route_goes_straight_on_at_both_ends(bend: Route, s_m: float) -> None:
    point, end = bend.at(s_m), bend.at(0.0 if s_m < 0.0 else bend.length_m)
    beyond = s_m if s_m < 0.0 else s_m - bend.length_m
    assert point.curvature_1pm == bend.curvature_at(s_m) == 0.0
    assert point.x_m == pytest.approx(end.x_m + beyond * math.cos(end.yaw_rad), abs=1e-9)
    assert point.y_m == pytest.approx(end.y_m + beyond * math.sin(end.yaw_rad), abs=1e-9)
    found = bend.project(point.x_m, point.y_m, None, point.yaw_rad)
    assert found == pytest.approx((s_m, 0.0, 0.0), abs=1e-6)


def test_many_places_are_those_of_one_by_one(bend: Route) -> None:
    stations = np.linspace(-5.0, bend.length_m + 5.0, 200)
    x = np.array([bend.at(s).x_m - math.sin(bend.at(s).yaw_rad) for s in stations.tolist()])
    y = np.array([bend.at(s).y_m + math.cos(bend.at(s).yaw_rad) for s in stations.tolist()])
    s_m, lateral = bend.project_all(x, y, -5.0)
    assert np.abs(s_m - stations).max() < 1e-5
    assert np.abs(lateral - 1.0).max() < 1e-6


def test_limit_holds_from_where_it_begins(bend: Route) -> None:
    assert (bend.limits_at(np.array((-1.0, 19.9, 20.1, 99.0))) * 3.6).round(6).tolist() == [50.0, 50.0, 30.0, 30.0]
    assert bend.speed_limit_mps == 50.0 / 3.6


def test_open_route_has_no_laps(bend: Route, course: Course) -> None:
    assert bend.unwrap(3.0, 100.0) == 3.0
    assert course.unwrap(3.0, 2604.0) == 2603.0


def test_route_that_comes_by_twice_begins_at_the_first() -> None:
    pieces = [Piece(30.0, 0.0, 0.0), Piece(20.0 * math.pi, 0.1, 0.1), Piece(30.0, 0.0, 0.0)]
    pose, s, stretches = Pose(0.0, 0.0, 0.0), 0.0, []
    for piece in pieces:
        stretches.append(Stretch(s, pose, piece, 10.0))
        s, pose = s + piece.length_m, travel(pose, piece)
    assert Route(stretches).project(29.0, 0.2).s_m == pytest.approx(29.0, abs=1e-6)
