"""Contact of a round body with walls and pillars: it is pushed out along the shortest way, so it stops or slides."""

from math import sqrt
from typing import Final, NamedTuple

from simconsole.values.kernels import Row, clip, kernel
from simconsole.vehicle.turtlebot.robot_state import OBSTACLES_AT

_PASSES: Final = 2
"""Out of a corner it takes one push for each wall."""


class Pushed(NamedTuple):
    """The middle of the body after contact."""

    x_m: float
    y_m: float
    push_x_m: float  # the sum of all pushes; 0, 0: nothing is touched
    push_y_m: float


@kernel
def pushed_out(x_m: float, y_m: float, radius_m: float, parameters: Row, segments: int, circles: int) -> Pushed:
    """Return where a body about (x, y) is after contact with the obstacles in the row of parameters."""
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
            away_x = x - parameters[at]
            away_y = y - parameters[at + 1]
            reach = radius_m + parameters[at + 2]
            square = away_x * away_x + away_y * away_y
            if 0.0 < square < reach * reach:
                apart = sqrt(square)
                x += away_x / apart * (reach - apart)
                y += away_y / apart * (reach - apart)
            at += 3
    return Pushed(x, y, x - x_m, y - y_m)
