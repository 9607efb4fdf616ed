"""The ground of a course: heights along it from its profile of grades, banked in bends, kerbs and verges beside it."""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from simconsole.profiles.world import CourseGroundProfile
from simconsole.values.height_field import HeightField
from simconsole.world.course import Course
from simconsole.world.drawing_layers import Frame, arc, axis_frame
from simconsole.world.relief.compile_field import Edges, height_field
from simconsole.world.relief.strips import STEP_M, Array, Strips, evenly, rounded, strip, together

FADE_M: Final = 30.0


def course_field(course: Course, ground: CourseGroundProfile) -> HeightField:
    """Return the field of a course."""
    road = _road(course, ground)
    return height_field(road, together((road, *_beside(course))), Edges(ground.kerb_m, ground.off_road_friction_share))


def heights_along(course: Course, ground: CourseGroundProfile, s_m: Array) -> Array:
    """Return the heights [N] of the road's axis at places [N] of the first lap, before vertical curves."""
    at = np.array([point.s_m for point in ground.grades])
    height = np.array([point.height_m for point in ground.grades])
    if not len(at):
        return np.zeros(len(s_m))
    if course.closed:
        return np.asarray(np.interp(s_m, at, height, period=course.length_m))
    return np.asarray(np.interp(s_m, at, height))


def _road(course: Course, ground: CourseGroundProfile) -> Strips:
    count = max(3, math.ceil(course.length_m / STEP_M) + 1)
    way = np.linspace(0.0, course.length_m, count)
    over = round(ground.vertical_curve_m / STEP_M) + round(FADE_M / STEP_M)
    height = heights_along(course, ground, way)
    curvature = np.array([course.curvature_at(s) for s in np.minimum(way, course.length_m - 1e-6).tolist()])
    if course.closed:  # round the start as anywhere else
        height, curvature = (
            np.concatenate((row[-over - 1 : -1], row, row[1 : over + 1])) for row in (height, curvature)
        )
    height = rounded(height, ground.vertical_curve_m)
    bank = -0.01 * ground.bank_percent * rounded(np.clip(curvature * ground.bank_full_radius_m, -1.0, 1.0), FADE_M)
    if course.closed:
        height, bank = height[over:-over], bank[over:-over]
    points = [course.at(s) for s in way.tolist()]
    half = 0.5 * course.world.lane_width_m
    line = np.array([(point.x_m, point.y_m, 0.0) for point in points])
    line[:, 2] = height - bank * half  # about the axis, half a lane to the left of the driven lane's centre
    return strip(line, bank, 3.0 * half, half)


def _beside(course: Course) -> Iterator[Strips]:
    """Yield the other roads of a course, which lie as the course does: side arms and rings."""
    lane = course.world.lane_width_m
    for spot in course.world.intersections:
        yield _level(_across(axis_frame(course, spot.s_m), spot.arm_m), lane, lane)
    for ring in course.world.roundabouts:
        around = arc(ring.x_m, ring.y_m, ring.radius_m, 0.0, math.tau, max(8, math.ceil(math.tau * ring.radius_m)))
        yield _level(around, 0.5 * lane, 0.5 * lane)


def _across(frame: Frame, arm_m: float) -> Array:
    return frame.turned(0.5 * math.pi).out(np.array(((-arm_m, 0.0), (arm_m, 0.0))))


def _level(line: Array, left_m: float, right_m: float) -> Strips:
    points = evenly(np.column_stack((line, np.zeros(len(line)))))
    return strip(points, np.zeros(len(points)), left_m, right_m)
