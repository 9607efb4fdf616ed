"""Contact of a round body with walls, pillars and other robots.

It is pushed out along the shortest way, so it stops or slides.
"""

from math import sqrt
from typing import Final, NamedTuple

from simconsole.values.kernels import Row, clip, kernel
from simconsole.vehicle.turtlebot.robot_state import OBSTACLES_AT, OTHERS_AT

_PASSES: Final = 2
"""Out of a corner it takes one push for each wall."""


class Pushed(NamedTuple):
    """The middle of the body after contact."""

    x_m: float
    y_m: float
    push_x_m: float  # the sum of all pushes; 0, 0: nothing is touched
    push_y_m: float


@kernel
def pushed_out(
    x_m: float, y_m: float, radius_m: float, parameters: Row, segments: int, circles: int, row: Row, others: int
) -> Pushed:
    """Return where a body about (x, y) is after contact.

    The obstacles are in the row of parameters, the other robots at the end of the state vector `row`.
    """
    x = x_m
    y = y_m
    for _ in range(_PASSES):
        at = OBSTACLES_AT
        for _ in range(segments):
            from_x = parameters[at]
            from_y = parameters[at + 1]
            along_x = parameters[at + 2] - from_x
            along_y = parameters[at + 3] - from_y
            share = ((x - from_x) * along_x + (y - from_y) * along_y) / (along_x * along_x + along_y * along_y)
            share = clip(share, 0.0, 1.0)
            away_x = x - from_x - share * along_x
            away_y = y - from_y - share * along_y
            square = away_x * away_x + away_y * away_y
            if 0.0 < square < radius_m * radius_m:
                apart = sqrt(square)
                x += away_x / apart * (radius_m - apart)
                y += away_y / apart * (radius_m - apart)
            at += 4
        for _ in range(circles):
            x, y = outside(x, y, radius_m, parameters, at)
            at += 3
        at = OTHERS_AT
        for _ in range(others):
            x, y = outside(x, y, radius_m, row, at)
            at += 3
    return Pushed(x, y, x - x_m, y - y_m)


@kernel
def outside(x_m: float, y_m: float, radius_m: float, circles: Row, at: int) -> tuple[float, float]:
    """Return where a body about (x, y) is after contact with the circle (x, y, radius) at this place of a row."""
    away_x = x_m - circles[at]
    away_y = y_m - circles[at + 1]
    reach = radius_m + circles[at + 2]
    square = away_x * away_x + away_y * away_y
    if 0.0 < square < reach * reach:
        apart = sqrt(square)
        x_m += away_x / apart * (reach - apart)
        y_m += away_y / apart * (reach - apart)
    return x_m, y_m
