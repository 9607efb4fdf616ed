"""The layers on which a course is drawn, and the few shapes that all its parts share."""

from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.profiles.world import Crossing
from simconsole.world.course import Course

Array = NDArray[np.float64]

STEP_M: Final = 1.0
ZEBRA_STRIPE_M: Final = 0.5  # stripes and the gaps between them


class LightProgram(NamedTuple):
    """What a light shows: phases that follow each other for ever, `offset_s` later than the clock."""

    signal: str  # the map's name of it
    link: int  # its place in that signal's states
    offset_s: float
    durations_s: tuple[float, ...]
    letters: str  # what it shows in each phase, as SUMO writes it


class Light(NamedTuple):
    """A traffic light's post, with the heading of the traffic that it faces."""

    x_m: float
    y_m: float
    yaw_rad: float
    program: LightProgram | None = None  # None: nobody knows


@dataclass
class DrawingLayers:
    """Polylines and polygons, each float64 [N, 2] in metres of `map`, in the order in which they were drawn."""

    surfaces: list[Array] = field(default_factory=list)
    islands: list[Array] = field(default_factory=list)
    edges: list[Array] = field(default_factory=list)
    centre_lines: list[Array] = field(default_factory=list)
    zebras: list[Array] = field(default_factory=list)
    stop_lines: list[Array] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)


class Frame(NamedTuple):
    """A place of the road: its axis point and direction; local points are (forward, left)."""

    x_m: float
    y_m: float
    yaw_rad: float

    def out(self, points: Array) -> Array:
        """Return local points [N, 2] in `map`."""
        cosine, sine = np.cos(self.yaw_rad), np.sin(self.yaw_rad)
        return np.asarray(points @ np.array(((cosine, sine), (-sine, cosine))) + (self.x_m, self.y_m))

    def turned(self, angle_rad: float) -> "Frame":
        """Return the same place looking `angle_rad` further left."""
        return Frame(self.x_m, self.y_m, self.yaw_rad + angle_rad)


def axis_frame(course: Course, s_m: float) -> Frame:
    """Return the frame of the road's axis (the line between its two lanes) at `s_m`."""
    point = course.at(s_m)
    offset = 0.5 * course.world.lane_width_m
    return Frame(
        point.x_m - offset * float(np.sin(point.yaw_rad)),
        point.y_m + offset * float(np.cos(point.yaw_rad)),
        point.yaw_rad,
    )


def box(forward_from: float, forward_to: float, left_from: float, left_to: float) -> Array:
    """Return a local rectangle as a polygon [4, 2]."""
    return np.array(
        ((forward_from, left_from), (forward_to, left_from), (forward_to, left_to), (forward_from, left_to))
    )


def add_crossing(layers: DrawingLayers, course: Course, crossing: Crossing) -> None:
    """Draw a zebra over both lanes."""
    frame = axis_frame(course, crossing.s_m)
    add_zebra(layers, frame, -0.5 * crossing.width_m, 0.5 * crossing.width_m, course.world.lane_width_m)


def add_zebra(layers: DrawingLayers, frame: Frame, forward_from: float, forward_to: float, half_road_m: float) -> None:
    """Draw stripes along the road from one distance of the frame to another, symmetric to its axis."""
    pairs = int(half_road_m / (2.0 * ZEBRA_STRIPE_M) - 0.5)
    for index in range(-pairs, pairs + 1):
        middle = 2.0 * ZEBRA_STRIPE_M * index
        stripe = box(forward_from, forward_to, middle - 0.5 * ZEBRA_STRIPE_M, middle + 0.5 * ZEBRA_STRIPE_M)
        layers.zebras.append(frame.out(stripe))


def arc(x: float, y: float, radius: float, start_rad: float, end_rad: float, count: int) -> Array:
    """Return points [count, 2] on an arc about (x, y)."""
    angles = np.linspace(start_rad, end_rad, count)
    return np.stack((x + radius * np.cos(angles), y + radius * np.sin(angles)), axis=1)
