"""The course as lines and areas in `map` for whoever draws it: driver's view, rerun, report. Pure geometry."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from simconsole.values.height_field import HeightField
from simconsole.world.course import Course
from simconsole.world.drawing_layers import STEP_M, Array, DrawingLayers, Light, add_crossing
from simconsole.world.intersection import add_intersection, clear_m, opening_m
from simconsole.world.roundabout import add_roundabout

_CHUNK_M: Final = 12.0  # length of one asphalt polygon: nearly convex on every curve

Span = tuple[float, float]


class Drawing(NamedTuple):
    """Polylines and polygons, each float64 [N, 2] in metres of `map`."""

    surfaces: tuple[Array, ...]  # asphalt, polygons (closed by their user, as all polygons here)
    islands: tuple[Array, ...]  # green inside of roundabouts, polygons to be drawn over the surfaces
    edges: tuple[Array, ...]  # solid lines
    centre_lines: tuple[Array, ...]  # to be drawn dashed
    zebras: tuple[Array, ...]  # one polygon per stripe
    stop_lines: tuple[Array, ...]  # polygons
    lights: tuple[Light, ...]
    path: Array  # the theoretical path, once round
    ground: HeightField | None = None  # on which all of it lies; None: flat
    walls: tuple[Array, ...] = ()  # lines [N, 3] of what stands upright: x, y and height of each corner


def draw(course: Course) -> Drawing:
    """Return everything there is to draw of a course: a two-lane road whose right lane is driven."""
    world, layers = course.world, DrawingLayers()
    half = 0.5 * world.lane_width_m
    rings = [(ring.s_m, ring.end_s_m) for ring in world.roundabouts]
    open_ = opening_m(world.lane_width_m)
    corners = [(spot.s_m - open_, spot.s_m + open_) for spot in world.intersections]
    clear = [(s.s_m - c, s.s_m + c) for s in world.intersections for c in (clear_m(s, world.lane_width_m),)]
    for start, end in _rest(course.length_m, rings):
        layers.surfaces += _strip(course, start, end, -half, 3.0 * half)
    for start, end in _rest(course.length_m, rings + corners):
        layers.edges += [course.offset(side, start, end, STEP_M) for side in (-half, 3.0 * half)]
    for start, end in _rest(course.length_m, rings + clear):
        layers.centre_lines.append(course.offset(half, start, end, STEP_M))
    for ring in world.roundabouts:
        add_roundabout(layers, course, ring)
    for spot in world.intersections:
        add_intersection(layers, course, spot)
    for crossing in world.crossings:
        add_crossing(layers, course, crossing)
    return Drawing(
        surfaces=tuple(layers.surfaces),
        islands=tuple(layers.islands),
        edges=tuple(layers.edges),
        centre_lines=tuple(layers.centre_lines),
        zebras=tuple(layers.zebras),
        stop_lines=tuple(layers.stop_lines),
        lights=tuple(layers.lights),
        path=course.offset(0.0, 0.0, course.length_m, STEP_M),
    )


def _rest(length_m: float, gaps: Sequence[Span]) -> Iterator[Span]:
    """Yield what the gaps leave of one lap, in order."""
    s = 0.0
    for start, end in sorted(gaps):
        if start > s:
            yield s, start
        s = max(s, end)
    if s < length_m:
        yield s, length_m


def _strip(course: Course, start_m: float, end_m: float, right_m: float, left_m: float) -> Iterator[Array]:
    """Yield the area between two offsets of the path as polygons of at most 12 m."""
    count = max(1, round((end_m - start_m) / _CHUNK_M))
    bounds = np.linspace(start_m, end_m, count + 1).tolist()
    for near, far in pairwise(bounds):
        right = course.offset(right_m, near, far, STEP_M)
        left = course.offset(left_m, near, far, STEP_M)
        yield np.vstack((right, left[::-1]))
