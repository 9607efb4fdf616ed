"""Where the route turns next: from the route's turns and the vehicle's place to an arrow and a distance. Pure."""

import math
from bisect import bisect_right
from itertools import pairwise
from typing import Final, NamedTuple

from simconsole.world.route import Route, Turn

OFF_ROUTE_M: Final = 15.0
"""Further than this from the route nobody is told to turn: the arrow would be of another road."""
NEAR_M: Final = 40.0
"""How far from the last place on the route the next one is looked for first."""
_STEP_M: Final = 2.0
_LONGEST_M: Final = 60.0
_BEND_RAD: Final = 0.1


class Guidance(NamedTuple):
    """A route as the display needs it: corners of a line as (s, x, y) in m, and its turns."""

    points: tuple[tuple[float, float, float], ...]
    turns: tuple[Turn, ...]
    length_m: float
    closed: bool


class Ahead(NamedTuple):
    """What comes next on the route."""

    distance_m: float
    angle_rad: float = 0.0  # left-positive
    exit: int = 0  # of a roundabout; 0: it is none
    is_end: bool = False  # the route ends there


def guidance_of(route: Route) -> Guidance:
    """Return what the display needs of a route: few corners where it is straight, more in bends."""
    points: list[tuple[float, float, float]] = []
    last_yaw = last_s = -math.inf
    for number in range(int(route.length_m / _STEP_M) + 1):
        s = _STEP_M * number
        at = route.at(s)
        if s - last_s >= _LONGEST_M or abs(at.yaw_rad - last_yaw) >= _BEND_RAD:
            points.append((s, at.x_m, at.y_m))
            last_yaw, last_s = at.yaw_rad, s
    end = route.at(math.nextafter(route.length_m, 0.0))
    points.append((route.length_m, end.x_m, end.y_m))
    return Guidance(tuple(points), route.turns, route.length_m, route.closed)


def ahead(
    guidance: Guidance, x_m: float, y_m: float, yaw_rad: float, before_m: float | None
) -> tuple[Ahead | None, float | None]:
    """Return what comes next, and the vehicle's place along the route; None for both off the route.

    Args:
        guidance: The route.
        x_m: The vehicle's place in map.
        y_m: The same.
        yaw_rad: Its heading; against the route's direction it is not on it.
        before_m: Its last place along the route, None where none is known.
    """
    s_m = _station(guidance, x_m, y_m, yaw_rad, before_m)
    if s_m is None:
        return None, None
    for turn in guidance.turns:
        if turn.end_s_m > s_m:
            return Ahead(max(0.0, turn.s_m - s_m), turn.angle_rad, turn.exit), s_m
    if guidance.closed:
        turn_again = guidance.turns[:1]
        return next((Ahead(t.s_m + guidance.length_m - s_m, t.angle_rad, t.exit) for t in turn_again), None), s_m
    return Ahead(max(0.0, guidance.length_m - s_m), is_end=True), s_m


def _station(guidance: Guidance, x_m: float, y_m: float, yaw_rad: float, before_m: float | None) -> float | None:
    points = guidance.points
    first, last = 0, len(points) - 1
    if before_m is not None:
        first = max(0, bisect_right(points, (before_m - NEAR_M,)) - 1)
        last = min(last, bisect_right(points, (before_m + NEAR_M,)))
    found = _nearest(points[first : last + 1], x_m, y_m, yaw_rad)
    if found is None and before_m is not None:  # a lap begins anew, or the vehicle was put elsewhere
        found = _nearest(points, x_m, y_m, yaw_rad)
    return found


def _nearest(points: tuple[tuple[float, float, float], ...], x_m: float, y_m: float, yaw_rad: float) -> float | None:
    """Return the place of the nearest piece that leads where the vehicle looks, None where none is near."""
    best_m, best_s = OFF_ROUTE_M, None
    look_x, look_y = math.cos(yaw_rad), math.sin(yaw_rad)
    for (s, x, y), (_, next_x, next_y) in pairwise(points):
        along_x, along_y = next_x - x, next_y - y
        squared = along_x * along_x + along_y * along_y
        if squared == 0.0 or along_x * look_x + along_y * look_y <= 0.0:
            continue
        share = min(1.0, max(0.0, ((x_m - x) * along_x + (y_m - y) * along_y) / squared))
        away_m = math.hypot(x + share * along_x - x_m, y + share * along_y - y_m)
        if away_m < best_m:
            best_m, best_s = away_m, s + share * math.sqrt(squared)
    return best_s
