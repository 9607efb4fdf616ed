"""The ground of a course: its grades with vertical curves, its bends banked, kerbs where its roads end."""

import msgspec
import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import CourseGroundProfile, CourseProfile, GradePoint
from simconsole.values.height_field import spline_at
from simconsole.world.course import Course
from simconsole.world.course_relief import course_field, heights_along

GROUND = CourseGroundProfile(
    grades=(
        GradePoint(s_m=0.0, height_m=0.0),
        GradePoint(s_m=700.0, height_m=35.0),
        GradePoint(s_m=1500.0, height_m=5.0),
    ),
    vertical_curve_m=60.0,
    bank_percent=4.0,
    bank_full_radius_m=60.0,
    kerb_m=0.1,
    off_road_friction_share=0.5,
)


@pytest.fixture(scope="module")
def course() -> Course:
    profile = load_world("urban")
    assert isinstance(profile, CourseProfile)
    return Course(msgspec.structs.replace(profile, ground=GROUND))


def test_the_driven_lane_has_the_grades_of_the_profile_and_the_loop_closes(course: Course) -> None:
    field = course_field(course, GROUND)
    way = np.arange(0.0, course.length_m, 5.0)
    points = np.array([course.at(s)[:2] for s in way.tolist()])
    found = spline_at(field, 0, *points.T)
    planned = heights_along(course, GROUND, way)
    away = np.abs(found - planned)
    assert np.median(away) < 0.05
    # Vertical curves of 60 m cut the corners; the banked lane turns about the road's axis; roundabouts pass themselves.
    assert np.quantile(away, 0.95) < 0.6
    straight = (way > 100.0) & (way < 140.0)
    assert np.gradient(found[straight], 5.0) == pytest.approx(0.05, abs=0.002)
    assert abs(found[0] - found[-1]) < 0.5


def test_the_lane_is_road_and_beside_it_is_not(course: Course) -> None:
    field = course_field(course, GROUND)
    points = [course.at(s) for s in np.arange(0.0, course.length_m, 5.0).tolist()]
    x, y, yaw = (np.array([getattr(point, name) for point in points]) for name in ("x_m", "y_m", "yaw_rad"))
    assert spline_at(field, 1, x, y).max() < -0.8
    right_x, right_y = x + 4.0 * np.sin(yaw), y - 4.0 * np.cos(yaw)
    assert np.median(spline_at(field, 1, right_x, right_y)) > 1.5
    assert (field.grid.kerb_m, field.grid.off_road_share) == (0.1, 0.5)


def test_an_arm_of_an_intersection_is_road_too(course: Course) -> None:
    field = course_field(course, GROUND)
    spot = course.world.intersections[0]
    here = course.at(spot.s_m)
    out_m = 0.6 * spot.arm_m
    x, y = here.x_m + out_m * np.sin(here.yaw_rad), here.y_m - out_m * np.cos(here.yaw_rad)
    assert spline_at(field, 1, np.array((x,)), np.array((y,)))[0] < -1.0


def test_no_grades_at_all_are_level(course: Course) -> None:
    assert heights_along(course, CourseGroundProfile(), np.arange(3.0)).tolist() == [0.0, 0.0, 0.0]
