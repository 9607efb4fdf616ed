import math

import numpy as np
import pytest

from simconsole.world.course import Course
from simconsole.world.drawing import Drawing, draw


@pytest.fixture(scope="module")
def drawn(course: Course) -> Drawing:
    return draw(course)


def area(polygon: np.ndarray) -> float:
    x, y = polygon.T
    return 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))


def test_everything_is_finite_pairs(drawn: Drawing) -> None:
    assert np.isfinite(drawn.lights).all()
    lines_of = {**drawn._asdict(), "path": (drawn.path,)}
    del lines_of["lights"]
    for name, lines in lines_of.items():
        assert lines, f"the urban course has {name}"
        for line in lines:
            assert line.ndim == 2
            assert line.shape[1] == 2
            assert len(line) >= 2
            assert np.isfinite(line).all()


def test_no_edge_lies_on_the_driven_lane(course: Course, drawn: Drawing) -> None:
    path = drawn.path
    for edge in drawn.edges:
        gaps = np.hypot(*(edge[:, None, :] - path[None, :, :]).transpose(2, 0, 1)).min(axis=1)
        assert gaps.min() > 0.5 * course.world.lane_width_m - 0.1


def test_driven_lane_is_paved_all_along(course: Course, drawn: Drawing) -> None:
    boxes = [(p, p.min(axis=0), p.max(axis=0)) for p in drawn.surfaces]
    for s in np.arange(0.37, course.length_m, 4.9).tolist():
        point = np.array(course.at(s)[:2])
        near = [p for p, low, high in boxes if (low <= point + 0.01).all() and (point - 0.01 <= high).all()]
        assert any(inside(p, point) for p in near), point


def inside(polygon: np.ndarray, point: np.ndarray) -> bool:
    # The winding angle of the polygon about the point.
    d = polygon - point
    angles = np.arctan2(d[:, 1], d[:, 0])
    turns = np.diff(np.append(angles, angles[0]))
    total = float(((turns + math.pi) % math.tau - math.pi).sum())
    return abs(total) > 3.0


def test_zebras_lie_across_the_road(course: Course, drawn: Drawing) -> None:
    assert len(drawn.zebras) == 7 * (len(course.world.crossings) + 4)  # each arm of the signalled intersection too
    for crossing in course.world.crossings:
        point = course.at(crossing.s_m)
        near = [z for z in drawn.zebras if np.hypot(*(z.mean(axis=0) - point[:2])) < 6.0]
        assert len(near) == 7
        middles = [z.mean(axis=0) for z in near]
        laterals = sorted(course.project(float(x), float(y), crossing.s_m).lateral_m for x, y in middles)
        assert laterals == pytest.approx([-1.25, -0.25, 0.75, 1.75, 2.75, 3.75, 4.75], abs=1e-6)


def test_lights_face_the_traffic_beside_its_stop_line(course: Course, drawn: Drawing) -> None:
    assert len(drawn.lights) == 4
    spot = next(s for s in course.world.intersections if s.signalled)
    ours = [light for light in drawn.lights if abs(course.project(*light[:2], spot.s_m, light.yaw_rad)[2]) < 0.01]
    assert len(ours) == 1
    place = course.project(*ours[0][:2], spot.s_m)
    assert 10.0 < spot.s_m - place.s_m < 20.0
    assert -3.0 < place.lateral_m < -1.75
    assert len(drawn.stop_lines) == 4 + 2  # the unsignalled side road has two


def test_roundabout_has_one_island_and_a_closed_outline(course: Course, drawn: Drawing) -> None:
    ring = course.world.roundabouts[0]
    assert len(drawn.islands) == 1
    assert area(drawn.islands[0]) == pytest.approx(math.pi * (18.0 - 1.75) ** 2, rel=0.01)
    assert drawn.islands[0].mean(axis=0) == pytest.approx((ring.x_m, ring.y_m), abs=0.5)
    for edge in drawn.edges:  # the roads' mouths are open
        distance = np.hypot(*(edge - (ring.x_m, ring.y_m)).T)
        assert distance.min() > 18.0 - 1.75 - 0.01
