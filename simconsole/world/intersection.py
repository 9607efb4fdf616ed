"""An intersection as lines and areas: the crossing road, rounded corners, zebras, stop lines and lights."""

import math
from typing import Final

import numpy as np

from simconsole.profiles.world import Intersection
from simconsole.world.course import Course
from simconsole.world.drawing_layers import DrawingLayers, Frame, Light, add_zebra, arc, axis_frame, box

CORNER_M: Final = 6.0  # kerb radius where the two roads meet
_ZEBRA_M: Final = 4.0
_GAP_M: Final = 0.7
_STOP_LINE_M: Final = 0.5
_POST_M: Final = 0.9  # traffic light's post beside the road's edge
_QUARTERS: Final = (0.0, 0.5 * math.pi, math.pi, -0.5 * math.pi)


def opening_m(lane_width_m: float) -> float:
    """Return how far from the middle the road's edges begin to round into the other road."""
    return lane_width_m + CORNER_M


def clear_m(spot: Intersection, lane_width_m: float) -> float:
    """Return how far from the middle the centre line ends: at the stop lines."""
    return opening_m(lane_width_m) + (2.0 * _GAP_M + _ZEBRA_M + _STOP_LINE_M if spot.signalled else 0.0)


def add_intersection(layers: DrawingLayers, course: Course, spot: Intersection) -> None:
    """Draw one intersection; the course's own road is drawn already, with gaps for it."""
    width = course.world.lane_width_m
    frame = axis_frame(course, spot.s_m)
    layers.surfaces.append(frame.out(box(-width, width, -spot.arm_m, spot.arm_m)))
    for quarter in _QUARTERS:
        arm = frame.turned(quarter)
        _add_corner(layers, arm, width)
        crosses = abs(math.sin(quarter)) > 0.5
        if crosses:
            _add_arm(layers, arm, spot, width)
        if spot.signalled:
            add_zebra(layers, arm, opening_m(width) + _GAP_M, opening_m(width) + _GAP_M + _ZEBRA_M, width)
        if spot.signalled or crosses:
            _add_stop_line(layers, arm, clear_m(spot, width), width, spot.signalled)


def _add_corner(layers: DrawingLayers, arm: Frame, width: float) -> None:
    far = opening_m(width)
    bow = arc(far, far, CORNER_M, 1.5 * math.pi, math.pi, 10)
    layers.surfaces.append(arm.out(np.vstack((bow, ((width, width),)))))
    layers.edges.append(arm.out(bow))


def _add_arm(layers: DrawingLayers, arm: Frame, spot: Intersection, width: float) -> None:
    near = opening_m(width)
    for side in (-width, width):
        layers.edges.append(arm.out(np.array(((near, side), (spot.arm_m, side)))))
    layers.centre_lines.append(arm.out(np.array(((clear_m(spot, width), 0.0), (spot.arm_m, 0.0)))))


def _add_stop_line(layers: DrawingLayers, arm: Frame, distance: float, width: float, signalled: bool) -> None:
    """On an arm, seen outwards, incoming traffic keeps to the left of the axis."""
    layers.stop_lines.append(arm.out(box(distance - _STOP_LINE_M, distance, 0.2, width)))
    if signalled:
        x, y = arm.out(np.array(((distance, width + _POST_M),)))[0].tolist()
        layers.lights.append(Light(x, y, math.remainder(arm.yaw_rad + math.pi, math.tau)))
