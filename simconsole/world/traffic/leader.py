"""Whom the console's vehicle follows: the nearest road user in its way, and the gap to them."""

import math
from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.values.kernels import Row, holding, kernel
from simconsole.values.numerics.array_functions import cosine as cosine_of
from simconsole.values.numerics.array_functions import sine as sine_of
from simconsole.values.signals import NO_AHEAD, AheadInput
from simconsole.values.trigonometry import direction
from simconsole.world.roads.road_map import Array
from simconsole.world.route import CELL_M, Route
from simconsole.world.traffic.road_users import Box

AHEAD_M: Final = 150.0
MARGIN_M: Final = 0.2
_BESIDE_M: Final = 5.0  # further beside its route, the vehicle's way is straight on
_TURNED: Final = 0.5403023058681398  # likewise, where the cosine of the angle between them is less: 1 rad
_STRETCH: Final = 0.3  # bound of the curvature's share, for a vehicle near the centre of a curve
_SAME_M: Final = 1.0  # an open route that comes by twice: of places as near as this, the first
_NOBODY_M: Final = NO_AHEAD.lead_gap_m
_X: Final = 2  # columns of a table of road users
_Y: Final = 3
_YAW: Final = 4
_SPEED: Final = 5
_LENGTH: Final = 6
_WIDTH: Final = 7

Execution = Callable[[Any], Any]


class Way(NamedTuple):
    """A route for kernels: the beginnings of its cells, float64 [cells] each, or lists.

    Two that follow each other are at most CELL_M apart, so a place that is `d` away from one is at least `d - n CELL_M`
    away from the n-th after it: searches leave out those that cannot be near.
    """

    x_m: Row
    y_m: Row
    cosine: Row
    sine: Row
    s_m: Row
    curvature_1pm: Row
    length_m: float
    closed: int


class Start(NamedTuple):
    """Where a vehicle is: after which cell of its route, and how far; -1 where it does not follow it. Its heading."""

    cell: int
    along_m: float
    cosine: float
    sine: float


class Beside(NamedTuple):
    """A point beside a way: how far along it from the vehicle, how far left of it, and its direction there."""

    along_m: float  # not positive: behind, or not on the way
    lateral_m: float
    cosine: float
    sine: float


class Leaders:
    """Finds whom a vehicle follows along a route."""

    def __init__(self, route: Route | None, compile_kernel: Execution | None = None) -> None:
        """Take the route; far beside it, or without one, a vehicle goes straight on.

        Args:
            route: what the vehicle follows.
            compile_kernel: `jit.compiled`; without it the search runs plain, to the same bits.
        """
        self._lists = compile_kernel is None  # plain Python reads them several times as fast as arrays
        self._search = holding(
            leader_on if compile_kernel is None else compile_kernel(leader_on), _way(route, self._lists)
        )
        self._guess = 0  # the cell where the vehicle was: searches that begin there are short

    def find(self, ego: Box, users: Array) -> AheadInput:
        """Return the nearest road user on the way ahead, bumper to bumper along it.

        Args:
            ego: the vehicle's footprint.
            users: the road users, float64 [users, FIELDS].
        """
        rows: Any = users.tolist() if self._lists else users
        gap_m, speed_mps, self._guess = self._search(self._guess, *ego, rows)
        return AheadInput(gap_m, speed_mps, NO_AHEAD.yield_m, NO_AHEAD.yield_s)


def _way(route: Route | None, lists: bool) -> Way:
    arrays = [np.zeros(0)] * 6
    if route is not None:
        arrays = [route.x, route.y, cosine_of(route.yaw), sine_of(route.yaw), route.s, route.curvature]
    columns: list[Any] = [array.tolist() for array in arrays] if lists else arrays
    length_m, closed = (0.0, False) if route is None else (route.length_m, route.closed)
    x, y, cosine, sine, s, curvature = columns
    return Way(
        x_m=x, y_m=y, cosine=cosine, sine=sine, s_m=s, curvature_1pm=curvature, length_m=length_m, closed=int(closed)
    )


@kernel
def leader_on(
    way: Way, guess: int, x: float, y: float, yaw: float, speed: float, length: float, width: float, users: Row
) -> tuple[float, float, int]:
    """Return gap (m) and speed along the way (m/s) of the nearest road user ahead, and the cell where the ego is.

    The ego is a `Box` by its fields. `guess` is a cell near it; any gives the same.
    """
    ego = _start(way, guess, x, y, yaw)
    gap, found = _NOBODY_M, 0.0
    for row in range(len(users)):
        user = users[row]
        dx, dy = user[_X] - x, user[_Y] - y
        if dx * dx + dy * dy >= AHEAD_M * AHEAD_M:
            continue
        reach = 1.0 + MARGIN_M + 0.5 * (width + user[_LENGTH] + user[_WIDTH])
        beside = _beside(way, ego, dx, dy, user[_X], user[_Y], reach)
        if beside.along_m <= 0.0:
            continue
        other = direction(user[_YAW])
        towards = other.cos * beside.cosine + other.sin * beside.sine
        across = abs(other.sin * beside.cosine - other.cos * beside.sine)
        long = user[_LENGTH] * abs(towards) + user[_WIDTH] * across
        wide = user[_LENGTH] * across + user[_WIDTH] * abs(towards)
        free = beside.along_m - 0.5 * (length + long)
        if free < gap and abs(beside.lateral_m) <= 0.5 * (width + wide) + MARGIN_M:
            gap, found = free, user[_SPEED] * towards
    return (gap if gap > 0.0 else 0.0), found, (ego.cell if ego.cell >= 0 else 0)


@kernel
def _start(way: Way, guess: int, x: float, y: float, yaw: float) -> Start:
    """Return where on the route a vehicle is, if it follows it."""
    heading = direction(yaw)
    if len(way.x_m) == 0:
        return Start(-1, 0.0, heading.cos, heading.sin)
    place = _nearest_cell(way, guess, x, y)
    cosine, sine = way.cosine[place], way.sine[place]
    dx, dy = x - way.x_m[place], y - way.y_m[place]
    lateral = dy * cosine - dx * sine
    stretch = 1.0 - way.curvature_1pm[place] * lateral
    here = (dx * cosine + dy * sine) / (stretch if stretch > _STRETCH else _STRETCH)
    turned = heading.cos * cosine + heading.sin * sine
    if abs(lateral) >= _BESIDE_M or abs(here) > _BESIDE_M or turned <= _TURNED:
        place = -1
    return Start(place, here, heading.cos, heading.sin)


@kernel
def _beside(way: Way, ego: Start, dx: float, dy: float, x: float, y: float, reach: float) -> Beside:
    """Return where a point, `dx` and `dy` from the vehicle, lies beside its way."""
    if ego.cell < 0:
        return Beside(dx * ego.cosine + dy * ego.sine, dy * ego.cosine - dx * ego.sine, ego.cosine, ego.sine)
    place = _cell_beside(way, ego, x, y, reach)
    if place < 0:
        return Beside(-1.0, 0.0, 1.0, 0.0)
    cosine, sine = way.cosine[place], way.sine[place]
    to_x, to_y = x - way.x_m[place], y - way.y_m[place]
    beyond = to_x * cosine + to_y * sine
    along = _way_to(way, ego, place) + beyond
    return Beside(along if abs(beyond) <= CELL_M else -1.0, to_y * cosine - to_x * sine, cosine, sine)


@kernel
def _way_to(way: Way, ego: Start, place: int) -> float:
    """Return how far it is along the route from the vehicle to a cell; never back, on a closed one."""
    found = way.s_m[place] - way.s_m[ego.cell] - ego.along_m
    return float(found + way.length_m if place < ego.cell else found)


@kernel
def _nearest_cell(way: Way, guess: int, x: float, y: float) -> int:
    """Return the cell of the route that a point is nearest to; of an open route the first of those that are as near."""
    count = len(way.x_m)
    best, least, place = guess, _away(way, guess, x, y), 0
    while place < count:
        away = _away(way, place, x, y)
        if away < least or (away == least and place < best):
            best, least = place, away
        place += 1 + int((away - least) / CELL_M)
    if way.closed == 1:
        return best
    place = 0
    while place < best:
        away = _away(way, place, x, y)
        if away <= least + _SAME_M:
            break
        place += 1 + int((away - least - _SAME_M) / CELL_M)
    while place < best and _away(way, place + 1, x, y) <= _away(way, place, x, y):
        place += 1
    return place


@kernel
def _away(way: Way, place: int, x: float, y: float) -> float:
    dx, dy = way.x_m[place] - x, way.y_m[place] - y
    return math.sqrt(dx * dx + dy * dy)


@kernel
def _cell_beside(way: Way, ego: Start, x: float, y: float, reach: float) -> int:
    """Return the cell, at most AHEAD_M after the vehicle's, that a point is nearest to; -1 if further than `reach`."""
    count = len(way.x_m)
    best, least, step = -1, reach, 0
    while step < count:
        place = ego.cell + step
        if place >= count:
            if way.closed == 0:
                break
            place -= count
        if _way_to(way, ego, place) > AHEAD_M:
            break
        away = _away(way, place, x, y)
        if away < least:
            best, least = place, away
        step += 1 + int((away - least) / CELL_M)
    return best
