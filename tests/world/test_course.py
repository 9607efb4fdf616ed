import math
import random

import numpy as np
import pytest

from simconsole.profiles.course_plan import CoursePlan, Curve, Straight
from simconsole.profiles.world import CourseProfile
from simconsole.values.platform import Pose
from simconsole.world.course import Course
from simconsole.world.path_geometry import Piece, travel
from simconsole.world.planning import solve
from simconsole.world.route import CELL_M
from tests.samples import Sample


def test_cells_are_half_a_metre_or_finer(course: Course) -> None:
    assert float(np.diff(course.s).max()) <= CELL_M + 1e-9
    assert float(np.diff(course.s).min()) > 0.0
    assert course.length_m == pytest.approx(2600.0)
    assert course.speed_limit_mps == pytest.approx(50.0 / 3.6)


def test_path_and_projection_agree_with_the_exact_primitives(
    urban: CourseProfile, course: Course, sample: Sample
) -> None:
    dice = random.Random(sample.seed)
    for _ in range(sample.of(1500, 50_000)):
        part = dice.choice(urban.path)
        u = dice.uniform(0.0, part.length_m)
        piece = Piece(part.length_m, part.curvature_start_1pm, part.curvature_end_1pm)
        exact = travel(Pose(part.x_m, part.y_m, part.yaw_rad), piece, u)
        assert course.at(part.s_m + u)[:3] == pytest.approx(exact, abs=2e-8)
        lateral = dice.uniform(-3.0, 3.0)
        x = exact.x_m - lateral * math.sin(exact.yaw_rad)
        y = exact.y_m + lateral * math.cos(exact.yaw_rad)
        found = course.project(x, y, part.s_m + u + dice.uniform(-2.0, 2.0), exact.yaw_rad + 0.1)
        assert found == pytest.approx((part.s_m + u, lateral, 0.1), abs=1e-7)


def test_curvature_is_that_of_the_heading(course: Course) -> None:
    for s in np.arange(0.3, 2600.0, 7.7).tolist():
        slope = (course.at(s + 1e-4).yaw_rad - course.at(s - 1e-4).yaw_rad) / 2e-4
        assert course.curvature_at(s) == pytest.approx(slope, abs=1e-5)
        assert course.curvature_at(s) == course.at(s).curvature_1pm


def test_projection_without_hint_searches_the_course(course: Course) -> None:
    point = course.at(1700.25)
    assert course.project(point.x_m, point.y_m).s_m == pytest.approx(1700.25, abs=1e-6)
    assert course.project(point.x_m, point.y_m, 800.0).s_m == pytest.approx(1700.25, abs=1e-6)


def test_distance_runs_on_over_laps(course: Course) -> None:
    s = 2590.0
    for _ in range(40):
        point = course.at(s + 0.5)
        s = course.project(point.x_m, point.y_m, s).s_m
    assert s == pytest.approx(2610.0, abs=1e-5)
    assert course.at(2610.0)[:2] == pytest.approx(course.at(10.0)[:2])
    assert course.unwrap(10.0, 2605.0) == pytest.approx(2610.0)


def test_heading_error_is_the_smallest_angle(course: Course) -> None:
    point = course.at(2599.0)  # here the path's heading has grown to a whole turn
    assert course.project(point.x_m, point.y_m, 2599.0, 0.02).heading_error_rad == pytest.approx(0.02, abs=1e-9)
    assert course.project(point.x_m, point.y_m, 2599.0).heading_error_rad == 0.0


def test_offset_lines_keep_their_distance(course: Course) -> None:
    line = course.offset(-1.75, 600.0, 640.0)
    assert line.shape == (41, 2)
    for x, y in line.tolist():
        assert course.project(x, y, 620.0).lateral_m == pytest.approx(-1.75, abs=1e-6)


def test_far_away_points_still_get_an_answer(course: Course) -> None:
    found = course.project(5000.0, 5000.0)
    assert 0.0 <= found.s_m % course.length_m < course.length_m
    assert math.isfinite(found.lateral_m)


def test_a_whole_way_is_projected_as_its_places_are(course: Course) -> None:
    s = np.linspace(2300.0, 5400.0, 3001)  # more than a lap
    lateral = 0.4 * np.sin(s / 9.0)
    points = [course.at(value) for value in s.tolist()]
    x = np.array([p.x_m - d * math.sin(p.yaw_rad) for p, d in zip(points, lateral.tolist(), strict=True)])
    y = np.array([p.y_m + d * math.cos(p.yaw_rad) for p, d in zip(points, lateral.tolist(), strict=True)])
    found_s, found_lateral = course.project_all(x, y, 2300.0)
    assert found_s == pytest.approx(s, abs=1e-7)
    assert found_lateral == pytest.approx(lateral, abs=1e-9)
    assert [len(part) for part in course.project_all(np.zeros(0), np.zeros(0))] == [0, 0]


def test_a_way_with_a_jump_is_projected_before_and_after_it(course: Course) -> None:
    before, after = course.at(100.0), course.at(1500.0)
    x = np.array([before.x_m] * 7 + [after.x_m] * 50)
    y = np.array([before.y_m] * 7 + [after.y_m] * 50)
    _, lateral = course.project_all(x, y)
    assert np.abs(lateral).max() < 1e-6


def test_an_open_course_has_two_ends_and_goes_on_straight() -> None:
    curve = Curve(radius_m=20.0, angle_deg=90.0, ramp_m=5.0)
    elements = (Straight(length_m=50.0), curve, Straight(length_m=10.0))
    plan = CoursePlan(schema=1, title="t", lane_width_m=3.5, speed_limit_kmh=50.0, elements=elements)
    course = Course(solve(plan, "t"))
    assert not course.closed
    end = course.at(course.length_m)
    assert end.yaw_rad == pytest.approx(0.5 * math.pi)
    assert course.at(course.length_m + 7.0) == pytest.approx((end.x_m, end.y_m + 7.0, end.yaw_rad, 0.0))
    assert course.at(-30.0) == pytest.approx((-30.0, 0.0, 0.0, 0.0), abs=1e-9)
    assert course.curvature_at(course.length_m + 1.0) == course.curvature_at(-1.0) == 0.0
    assert course.unwrap(10.0, 900.0) == 10.0
    found = course.project(end.x_m - 0.5, end.y_m + 3.0, 20.0, 0.5 * math.pi)
    assert found == pytest.approx((course.length_m + 3.0, 0.5, 0.0), abs=1e-6)
    s_m, lateral = course.project_all(np.array((-2.0, 10.0)), np.array((0.3, -0.2)), 0.0)
    assert s_m == pytest.approx((-2.0, 10.0))
    assert lateral == pytest.approx((0.3, -0.2))


def test_the_urban_course_is_closed(course: Course) -> None:
    assert course.closed
