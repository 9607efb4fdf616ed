"""What a tracker plans for the next seconds: where on its line it will be, and when, if the car does as asked."""

import math
from collections.abc import Iterator
from typing import Final, NamedTuple, Protocol

from simconsole.drivers.path_tracker.speed_control import SpeedControl
from simconsole.world.route import Route

AHEAD_S: Final = 5.0
STEP_S: Final = 0.25
PLACES: Final = 1 + round(AHEAD_S / STEP_S)


class Planner(Protocol):
    """As much of a tracker as its plan follows from."""

    course: Route
    s_m: float | None
    along: SpeedControl

    @property
    def acts_after_s(self) -> float:
        """How long after what was seen last the car is at `s_m`."""

    def offset_at(self, s_m: float) -> tuple[float, float]:
        """Return how far left of the course it wants to be at a place (m), and the slope of that line against it."""


class Place(NamedTuple):
    """A planned place of base_link in `map`."""

    after_s: float  # since what was seen last
    x_m: float
    y_m: float
    yaw_rad: float


def plan(tracker: Planner, speed_mps: float) -> Iterator[Place]:
    """Yield PLACES planned places, STEP_S apart; none before a tracker's first step.

    Args:
        tracker: after its step.
        speed_mps: of the car, as seen last.
    """
    if tracker.s_m is None:
        return
    places = (tracker.s_m, *tracker.along.ahead(tracker.s_m, speed_mps, PLACES - 1, STEP_S))
    for number, s_m in enumerate(places):
        point, (offset_m, slope) = tracker.course.at(s_m), tracker.offset_at(s_m)
        yield Place(
            after_s=tracker.acts_after_s + number * STEP_S,
            x_m=point.x_m - offset_m * math.sin(point.yaw_rad),
            y_m=point.y_m + offset_m * math.cos(point.yaw_rad),
            yaw_rad=point.yaw_rad + math.atan(slope),
        )
