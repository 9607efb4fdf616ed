"""A path to follow, closed or open, with exact evaluation, and where a point lies beside it.

The path is cut into cells of at most half a metre that never straddle two pieces, so curvature is exactly linear
in each cell and position is a short power series from the cell's start (error below 1e-8 m at radius 12 m).
"""

import math
from bisect import bisect_right
from collections.abc import Sequence
from typing import Final, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from simconsole.values.platform import Pose
from simconsole.world.path_geometry import Piece, travel

Array = NDArray[np.float64]
Number = TypeVar("Number", float, Array)

CELL_M: Final = 0.5
_NEWTON_STEPS: Final = 8
_CLOSE_M: Final = 1e-6
_STRETCH: Final = 0.3  # bound of the Newton step for points near the centre of a curve
_STRIDE: Final = 20
_AT_ONCE: Final = 8192  # places: some twenty arrays of this length are in memory at once
_LOST_M: Final = 30.0  # further than this from the hinted place, look at the whole path
_SAME_M: Final = 1.0  # an open path that comes by twice: of places as near as this, the first
_POINT_STEP_M: Final = 2.0


class PathPoint(NamedTuple):
    """The path at one place."""

    x_m: float
    y_m: float
    yaw_rad: float
    curvature_1pm: float


class Projection(NamedTuple):
    """Where a pose lies beside the path: `lateral_m` left of it, `heading_error_rad` turned left of it."""

    s_m: float
    lateral_m: float
    heading_error_rad: float


class Stretch(NamedTuple):
    """A piece of the path: where it begins, `s_m` after the path's start, and the speed limit on it."""

    s_m: float
    start: Pose
    piece: Piece
    limit_mps: float


class Landmark(NamedTuple):
    """What a map of the route shows beside it: where, its name, and a line across the road if it has one."""

    kind: str  # crossing, traffic lights, side road, roundabout
    s_m: float
    x_m: float
    y_m: float
    across: tuple[tuple[float, float], ...] = ()


class Turn(NamedTuple):
    """A junction at which the path does not just go on: what a driver is told before it."""

    s_m: float  # where the path enters the junction
    end_s_m: float  # and where it has left it
    angle_rad: float  # from the road before to the road after, left-positive
    exit: int = 0  # of a roundabout: which exit, the first is 1; 0: it is none


class Route:
    """A path. Arrays hold the cells' starts: `s`, `x`, `y`, `yaw` (continuous), `curvature`, `limit`, float64 [N].

    Distances along a closed path (`s_m`) may run on over laps: 2610 is 10 m into the second lap of 2600 m. Before and
    after an open path it goes straight on.
    """

    def __init__(
        self, stretches: Sequence[Stretch], *, closed: bool = False, landmarks: Sequence[Landmark] = ()
    ) -> None:
        self.closed = closed
        self.landmarks = tuple(landmarks)
        self.turns: tuple[Turn, ...] = ()
        self.length_m = stretches[-1].s_m + stretches[-1].piece.length_m
        cells = [cell for stretch in stretches for cell in _cells(stretch)]
        columns = np.array(cells).T
        self.s, self.x, self.y, self.yaw, self.curvature, self.curvature_rate, self.limit = (
            np.array(column) for column in columns
        )
        self.speed_limit_mps = float(self.limit.max())
        self._s: list[float] = self.s.tolist()
        self._cells = [
            (x, y, yaw, math.cos(yaw), math.sin(yaw), curvature, rate) for _, x, y, yaw, curvature, rate, _ in cells
        ]
        self._ends = stretches[0].start, travel(stretches[-1].start, stretches[-1].piece)

    def at(self, s_m: float) -> PathPoint:
        """Return the path at `s_m` (any lap)."""
        if not (self.closed or 0.0 <= s_m < self.length_m):
            return self._beyond(s_m)
        s = s_m % self.length_m
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

    def _beyond(self, s_m: float) -> PathPoint:
        """Return a place before or after an open path, straight on."""
        x, y, yaw = self._ends[0 if s_m < 0.0 else 1]
        further = s_m if s_m < 0.0 else s_m - self.length_m
        return PathPoint(x + further * math.cos(yaw), y + further * math.sin(yaw), yaw, 0.0)

    def within(self, s_m: Array) -> Array:
        """Return places [N] of any lap as places of the first; those beside an open path as its ends."""
        return s_m % self.length_m if self.closed else np.clip(s_m, 0.0, np.nextafter(self.length_m, 0.0))

    def curvature_at(self, s_m: float) -> float:
        """Return the path's curvature at `s_m` (any lap), in 1/m."""
        if not (self.closed or 0.0 <= s_m < self.length_m):
            return 0.0
        s = s_m % self.length_m
        index = bisect_right(self._s, s) - 1
        cell = self._cells[index]
        return cell[5] + cell[6] * (s - self._s[index])

    def limits_at(self, s_m: Array) -> Array:
        """Return the speed limits in m/s at places [N] (any lap)."""
        found: Array = self.limit[np.searchsorted(self.s, self.within(s_m), side="right") - 1]
        return found

    def points(self, step_m: float = _POINT_STEP_M) -> tuple[tuple[float, float, float], ...]:
        """Return the path, once, as points of x and y in m and yaw in rad: what a controller is shown."""
        points = [self.at(number * step_m) for number in range(int(self.length_m / step_m) + 1)]
        return tuple((point.x_m, point.y_m, point.yaw_rad) for point in points)

    def project(
        self, x_m: float, y_m: float, s_hint_m: float | None = None, yaw_rad: float | None = None
    ) -> Projection:
        """Return the nearest place of the path to a point.

        Args:
            x_m: position in map.
            y_m: position in map.
            s_hint_m: where the point was before; the answer continues from there (laps included). Without it,
                or when it is more than 30 m wrong, the whole path is searched.
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
        path, the others start from between those. Takes little more memory than what it returns.
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
        s = self.within(s_m)
        cell = np.searchsorted(self.s, s, side="right") - 1
        u, yaw, curvature, rate = s - self.s[cell], self.yaw[cell], self.curvature[cell], self.curvature_rate[cell]
        forward, left = _series(u, curvature, rate)
        cosine, sine = np.cos(yaw), np.sin(yaw)
        x, y = self.x[cell] + forward * cosine - left * sine, self.y[cell] + forward * sine + left * cosine
        yaw, curvature = yaw + u * (curvature + 0.5 * rate * u), curvature + rate * u
        return (x, y, yaw, curvature) if self.closed else _straight_on(x, y, yaw, curvature, s_m - s)

    def unwrap(self, s_m: float, near_m: float) -> float:
        """Return `s_m` plus the whole laps that bring it nearest to `near_m`; an open path has none."""
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

    def _nearest(self, x_m: float, y_m: float) -> float:
        squares = (self.x - x_m) ** 2 + (self.y - y_m) ** 2
        if self.closed:
            return self._s[int(np.argmin(squares))]
        near = np.sqrt(squares)
        return self._s[int(np.argmax(near <= near.min() + _SAME_M))]


def _cells(stretch: Stretch) -> list[tuple[float, ...]]:
    """Return (s, x, y, yaw, curvature, curvature per metre, limit) at the start of every cell of one stretch."""
    s_m, pose, piece, limit_mps = stretch
    count = math.ceil(piece.length_m / CELL_M)
    rate = (piece.curvature_end_1pm - piece.curvature_start_1pm) / piece.length_m
    cells: list[tuple[float, ...]] = []
    for index in range(count):
        u = piece.length_m * index / count
        here = travel(pose, piece, u)
        cells.append((s_m + u, *here, piece.curvature_start_1pm + rate * u, rate, limit_mps))
    return cells


def _straight_on(
    x: Array, y: Array, yaw: Array, curvature: Array, beyond_m: Array
) -> tuple[Array, Array, Array, Array]:
    """Return places of an open path's ends moved straight on by what they lie beyond them, 0 for those inside."""
    inside = np.abs(beyond_m) < _CLOSE_M
    return x + beyond_m * np.cos(yaw), y + beyond_m * np.sin(yaw), yaw, np.where(inside, curvature, 0.0)


def _series(u: Number, curvature: Number, rate: Number) -> tuple[Number, Number]:
    """Return (forward, left) after `u` m of linear curvature: the Taylor series of the integral of (cos, sin).

    Heading a u + b u^2 with a = curvature, b = rate / 2; terms to u^5 in a. Remainder below a^5 u^6 / 720.
    """
    a, b = curvature * u, 0.5 * rate * u * u
    forward = u * (1.0 - a * a / 6.0 - a * b / 4.0 - b * b / 10.0 + a * a * a * a / 120.0)
    left = u * (a / 2.0 + b / 3.0 - a * a * a / 24.0 - a * a * b / 10.0)
    return forward, left
