"""A roundabout as lines and areas.

Its outline is the boundary of a union: the ring's disc, the roads that lead to it, the driven entry and exit, and
their mirror images for the other direction. Each shape's boundary is kept where it lies in none of the others.
"""

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.profiles.world import Roundabout
from simconsole.world.course import Course
from simconsole.world.drawing_layers import Array, DrawingLayers, Frame, arc, axis_frame, box

_STEP_M: Final = 0.25
_STUB_M: Final = 45.0  # roads that the course does not use end this far from the centre
_QUARTERS: Final = 4
_TOUCH_M: Final = 0.05
_SHORTEST_M: Final = 5.0  # shorter pieces of boundary are pockets between entry, exit, ring: paved over
_POCKET_M: Final = 5.0


class Shape(NamedTuple):
    """All points within `radius_m` of a line [N, 2]: a disc, a road or a driven lane."""

    spine: Array
    radius_m: float

    def covers(self, points: Array) -> NDArray[np.bool_]:
        """Return which points [N, 2] lie inside."""
        gaps = points[:, None, :] - self.spine[None, :, :]
        return np.asarray((gaps**2).sum(axis=2).min(axis=1) < (self.radius_m - _TOUCH_M) ** 2)


def add_roundabout(layers: DrawingLayers, course: Course, ring: Roundabout) -> None:
    """Draw one roundabout; the course's road ends at its `s_m` and begins again at its `end_s_m`."""
    half = 0.5 * course.world.lane_width_m
    entry, leave = axis_frame(course, ring.s_m), axis_frame(course, ring.end_s_m)
    arms = _arms(ring, entry, leave)
    disc = Shape(np.array(((ring.x_m, ring.y_m),)), ring.radius_m + half)
    shapes = [disc, *(Shape(_axis(ring, arm), 2.0 * half) for arm in arms)]
    middle = 0.5 * (ring.s_m + ring.end_s_m)
    outlines = [(0, arc(ring.x_m, ring.y_m, disc.radius_m, 0.0, math.tau, 500))]
    for index, arm in enumerate(arms):
        frame = Frame(ring.x_m, ring.y_m, arm.yaw_rad)
        reach = math.hypot(arm.x_m - ring.x_m, arm.y_m - ring.y_m)
        layers.surfaces.append(frame.out(box(0.0, reach, -2.0 * half, 2.0 * half)))
        if index < 2:
            pocket = disc.radius_m + _POCKET_M
            layers.surfaces.append(frame.out(box(ring.radius_m, pocket, -3.0 * half, 3.0 * half)))
        steps = np.arange(0.0, reach + _STEP_M, _STEP_M)
        sides = (np.full_like(steps, -2.0 * half), np.full_like(steps, 2.0 * half))
        outlines += [(1 + index, frame.out(np.stack((steps, side), axis=1))) for side in sides]
        layers.centre_lines.append(frame.out(np.array(((ring.radius_m + 4.0 * half, 0.0), (reach, 0.0)))))
    for axis, start, end in ((entry, ring.s_m, middle), (leave, middle, ring.end_s_m)):
        for image in (_same, _mirrored):
            lane = Shape(image(course.offset(0.0, start, end, _STEP_M), axis), half)
            kerb = image(course.offset(-half, start, end, _STEP_M), axis)
            inner = image(course.offset(half, start, end, _STEP_M), axis)
            layers.surfaces.append(np.vstack((kerb, inner[::-1])))
            outlines.append((len(shapes), kerb))
            shapes.append(lane)
    for own, line in outlines:
        others = [shape for index, shape in enumerate(shapes) if index != own]
        layers.edges += _visible(line, others)
    layers.surfaces.append(arc(ring.x_m, ring.y_m, disc.radius_m, 0.0, math.tau, 120))
    layers.islands.append(arc(ring.x_m, ring.y_m, ring.radius_m - half, 0.0, math.tau, 120))
    layers.edges.append(layers.islands[-1])


def _arms(ring: Roundabout, entry: Frame, leave: Frame) -> list[Frame]:
    """Return the outer end of every road, looking outwards: the course's two, and stubs in the free quarters."""
    arms = [entry.turned(math.pi), leave]
    for quarter in range(_QUARTERS):
        yaw = entry.yaw_rad + quarter * math.tau / _QUARTERS
        if all(abs(math.remainder(yaw - arm.yaw_rad, math.tau)) > 0.5 for arm in arms[:2]):
            x, y = ring.x_m + _STUB_M * math.cos(yaw), ring.y_m + _STUB_M * math.sin(yaw)
            arms.append(Frame(x, y, yaw))
    return arms


def _axis(ring: Roundabout, arm: Frame) -> Array:
    reach = math.hypot(arm.x_m - ring.x_m, arm.y_m - ring.y_m)
    steps = np.arange(0.0, reach, _STEP_M)
    return Frame(ring.x_m, ring.y_m, arm.yaw_rad).out(np.stack((steps, np.zeros_like(steps)), axis=1))


def _same(points: Array, axis: Frame) -> Array:
    return points


def _mirrored(points: Array, axis: Frame) -> Array:
    """Return the mirror image of points [N, 2] about a road's axis."""
    normal = np.array((-math.sin(axis.yaw_rad), math.cos(axis.yaw_rad)))
    distance = (points - (axis.x_m, axis.y_m)) @ normal
    return np.asarray(points - 2.0 * distance[:, None] * normal)


def _visible(line: Array, others: Sequence[Shape]) -> list[Array]:
    """Return the runs of a line [N, 2] that none of the shapes covers."""
    covered = np.zeros(len(line), dtype=np.bool_)
    for shape in others:
        covered |= shape.covers(line)
    cuts = np.flatnonzero(np.diff(covered)) + 1
    runs = np.split(line, cuts)
    seen = ~covered[np.concatenate((np.zeros(1, dtype=np.int64), cuts))]
    return [run for run, shown in zip(runs, seen.tolist(), strict=True) if shown and _length(run) > _SHORTEST_M]


def _length(line: Array) -> float:
    return float(np.hypot(*np.diff(line, axis=0).T).sum())
