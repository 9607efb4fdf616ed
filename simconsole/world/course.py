"""The theoretical path: a lane centre with exact evaluation, and where a point lies beside it.

The path is cut into cells of at most half a metre that never straddle two primitives, so curvature is exactly linear
in each cell and position is a short power series from the cell's start (error below 1e-8 m at radius 12 m).
"""

import math
from bisect import bisect_right
from typing import Final, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from simconsole.profiles.world import Primitive, WorldProfile
from simconsole.values.platform import Pose
from simconsole.values.units import MPS_PER_KMH
from simconsole.world.path_geometry import Piece, travel

Array = NDArray[np.float64]
Number = TypeVar("Number", float, Array)

CELL_M: Final = 0.5
_NEWTON_STEPS: Final = 8
_CLOSE_M: Final = 1e-6
_STRETCH: Final = 0.3  # bound of the Newton step for points near the centre of a curve
_STRIDE: Final = 20
_AT_ONCE: Final = 8192  # places: some twenty arrays of this length are in memory at once
_LOST_M: Final = 30.0  # further than this from the hinted place, look at the whole course
_MET_M: Final = 1e-3
_MET_RAD: Final = 1e-6
_BEYOND_M: Final = 1e5
"""An open course goes on straight for this far before its start; behind its end without bound."""


class PathPoint(NamedTuple):
    """The theoretical path at one place."""

    x_m: float
    y_m: float
    yaw_rad: float
    curvature_1pm: float


class Projection(NamedTuple):
    """Where a pose lies beside the path: `lateral_m` left of it, `heading_error_rad` turned left of it."""

    s_m: float
    lateral_m: float
    heading_error_rad: float


class Course:
    """A course. Arrays hold the cells' starts: `s`, `x`, `y`, `yaw` (continuous), `curvature`, all float64 [N].

    It is `closed` where its end meets its start: then distances along the path (`s_m`) may run on over laps, 2610 is
    10 m into the second lap of a course of 2600 m. An open course has a start (0) and an end (`length_m`), and is
    taken as straight beyond both.
    """

    def __init__(self, world: WorldProfile) -> None:
        self.world = world
        self.length_m = world.path[-1].s_m + world.path[-1].length_m
        self.speed_limit_mps = world.speed_limit_kmh * MPS_PER_KMH
        first, last = _pose(world.path[0]), world.path[-1]
        end = travel(_pose(last), _piece(last), last.length_m)
        self.closed = _meet(first, end)
        cells = [
            cell for primitive in world.path for cell in _cells(primitive.s_m, _pose(primitive), _piece(primitive))
        ]
        if not self.closed:
            before = travel(first, Piece(_BEYOND_M, 0.0, 0.0), -_BEYOND_M)
            cells = [(-_BEYOND_M, *before, 0.0, 0.0), *cells, (self.length_m, *end, 0.0, 0.0)]
        columns = np.array(cells).T
        self.s, self.x, self.y, self.yaw, self.curvature, self.curvature_rate = (np.array(column) for column in columns)
        self._s: list[float] = self.s.tolist()
        self._cells = [
            (x, y, yaw, math.cos(yaw), math.sin(yaw), curvature, rate) for _, x, y, yaw, curvature, rate in cells
        ]

    def at(self, s_m: float) -> PathPoint:
        """Return the path at `s_m` (any lap)."""
        s = self._within(s_m)
        index = bisect_right(self._s, s) - 1
        x, y, yaw, cosine, sine, curvature, rate = self._cells[index]
        u = s - self._s[index]
        forward, left = _series(u, curvature, rate)
        return PathPoint(
            x + forward * cosine - left * sine,
            y + forward * sine + left * cosine,
            yaw + u * (curvature + 0.5 * rate * u),
            curvature + rate * u,
        )

    def curvature_at(self, s_m: float) -> float:
        """Return the path's curvature at `s_m` (any lap), in 1/m."""
        s = self._within(s_m)
        index = bisect_right(self._s, s) - 1
        cell = self._cells[index]
        return cell[5] + cell[6] * (s - self._s[index])

    def project(
        self, x_m: float, y_m: float, s_hint_m: float | None = None, yaw_rad: float | None = None
    ) -> Projection:
        """Return the nearest place of the path to a point.

        Args:
            x_m: position in map.
            y_m: position in map.
            s_hint_m: where the point was before; the answer continues from there (laps included). Without it,
                or when it is more than 30 m wrong, the whole course is searched.
            yaw_rad: heading of the vehicle; without it the heading error is 0.
        """
        s = self._nearest(x_m, y_m) if s_hint_m is None else s_hint_m
        point = self.at(s)
        if s_hint_m is not None and math.hypot(x_m - point.x_m, y_m - point.y_m) > _LOST_M:
            s = self.unwrap(self._nearest(x_m, y_m), s_hint_m)
            point = self.at(s)
        cosine, sine, lateral = 1.0, 0.0, 0.0
        for _ in range(_NEWTON_STEPS):
            cosine, sine = math.cos(point.yaw_rad), math.sin(point.yaw_rad)
            dx, dy = x_m - point.x_m, y_m - point.y_m
            lateral = dy * cosine - dx * sine
            stretch = 1.0 - point.curvature_1pm * lateral
            step = (dx * cosine + dy * sine) / (stretch if stretch > _STRETCH else _STRETCH)
            s += step
            point = self.at(s)
            if abs(step) < _CLOSE_M:
                break
        heading = 0.0 if yaw_rad is None else math.remainder(yaw_rad - point.yaw_rad, math.tau)
        return Projection(s, lateral, heading)

    def project_all(self, x_m: Array, y_m: Array, s_hint_m: float | None = None) -> tuple[Array, Array]:
        """Return (s_m, lateral_m), float64 [N] each, of the places that a vehicle passed one after the other.

        As `project` from each place to the next, laps included, but fast: every 20th place is followed along the
        course, the others start from between those. Takes little more memory than what it returns.
        """
        if len(x_m) == 0:
            return np.zeros(0), np.zeros(0)
        marks = np.unique(np.append(np.arange(0, len(x_m), _STRIDE), len(x_m) - 1))
        stations, s = [], s_hint_m
        for x, y in zip(x_m[marks].tolist(), y_m[marks].tolist(), strict=True):
            s = self.project(x, y, s).s_m
            stations.append(s)
        places, lateral = np.empty(len(x_m)), np.empty(len(x_m))
        for start in range(0, len(x_m), _AT_ONCE):
            part = slice(start, min(start + _AT_ONCE, len(x_m)))
            near = np.interp(np.arange(part.start, part.stop), marks, stations)
            places[part], lateral[part] = self._project_from(x_m[part], y_m[part], near)
        return places, lateral

    def _project_from(self, x_m: Array, y_m: Array, places: Array) -> tuple[Array, Array]:
        lateral = along = np.zeros(len(x_m))
        for _ in range(_NEWTON_STEPS):
            x, y, yaw, curvature = self._at_all(places)
            dx, dy, cosine, sine = x_m - x, y_m - y, np.cos(yaw), np.sin(yaw)
            lateral = dy * cosine - dx * sine
            along = (dx * cosine + dy * sine) / np.maximum(1.0 - curvature * lateral, _STRETCH)
            places = places + along
            if float(np.abs(along).max()) < _CLOSE_M:
                break
        astray = (np.abs(along) >= _CLOSE_M) | (np.abs(lateral) > _LOST_M)
        for index in np.flatnonzero(astray).tolist():  # a vehicle that was put elsewhere
            found = self.project(float(x_m[index]), float(y_m[index]), float(places[index]))
            places[index], lateral[index] = found.s_m, found.lateral_m
        return places, lateral

    def _at_all(self, s_m: Array) -> tuple[Array, Array, Array, Array]:
        s = s_m % self.length_m if self.closed else np.maximum(s_m, -_BEYOND_M)
        cell = np.searchsorted(self.s, s, side="right") - 1
        u, yaw, curvature, rate = s - self.s[cell], self.yaw[cell], self.curvature[cell], self.curvature_rate[cell]
        forward, left = _series(u, curvature, rate)
        cosine, sine = np.cos(yaw), np.sin(yaw)
        return (
            self.x[cell] + forward * cosine - left * sine,
            self.y[cell] + forward * sine + left * cosine,
            yaw + u * (curvature + 0.5 * rate * u),
            curvature + rate * u,
        )

    def unwrap(self, s_m: float, near_m: float) -> float:
        """Return `s_m` plus the whole laps that bring it nearest to `near_m`; an open course has none."""
        if not self.closed:
            return s_m
        return s_m + round((near_m - s_m) / self.length_m) * self.length_m

    def offset(self, lateral_m: float, s_from_m: float, s_to_m: float, step_m: float = 1.0) -> Array:
        """Return the line `lateral_m` left of the path from one place to a later one, as float64 [N, 2]."""
        count = max(2, 1 + math.ceil((s_to_m - s_from_m) / step_m))
        points = [self.at(s) for s in np.linspace(s_from_m, s_to_m, count).tolist()]
        return np.array(
            [(p.x_m - lateral_m * math.sin(p.yaw_rad), p.y_m + lateral_m * math.cos(p.yaw_rad)) for p in points]
        )

    def _within(self, s_m: float) -> float:
        return s_m % self.length_m if self.closed else max(s_m, -_BEYOND_M)

    def _nearest(self, x_m: float, y_m: float) -> float:
        return self._s[int(np.argmin((self.x - x_m) ** 2 + (self.y - y_m) ** 2))]


def _meet(start: Pose, end: Pose) -> bool:
    turned_rad = math.remainder(end.yaw_rad - start.yaw_rad, math.tau)
    return math.hypot(end.x_m - start.x_m, end.y_m - start.y_m) < _MET_M and abs(turned_rad) < _MET_RAD


def _pose(primitive: Primitive) -> Pose:
    return Pose(primitive.x_m, primitive.y_m, primitive.yaw_rad)


def _piece(primitive: Primitive) -> Piece:
    return Piece(primitive.length_m, primitive.curvature_start_1pm, primitive.curvature_end_1pm)


def _cells(s_m: float, pose: Pose, piece: Piece) -> list[tuple[float, ...]]:
    """Return (s, x, y, yaw, curvature, curvature per metre) at the start of every cell of one primitive."""
    count = math.ceil(piece.length_m / CELL_M)
    rate = (piece.curvature_end_1pm - piece.curvature_start_1pm) / piece.length_m
    cells: list[tuple[float, ...]] = []
    for index in range(count):
        u = piece.length_m * index / count
        here = travel(pose, piece, u)
        cells.append((s_m + u, *here, piece.curvature_start_1pm + rate * u, rate))
    return cells


def _series(u: Number, curvature: Number, rate: Number) -> tuple[Number, Number]:
    """Return (forward, left) after `u` m of linear curvature: the Taylor series of the integral of (cos, sin).

    Heading a u + b u^2 with a = curvature, b = rate / 2; terms to u^5 in a. Remainder below a^5 u^6 / 720.
    """
    a, b = curvature * u, 0.5 * rate * u * u
    forward = u * (1.0 - a * a / 6.0 - a * b / 4.0 - b * b / 10.0 + a * a * a * a / 120.0)
    left = u * (a / 2.0 + b / 3.0 - a * a * a / 24.0 - a * a * b / 10.0)
    return forward, left
