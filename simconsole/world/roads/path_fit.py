"""From a polyline with a corridor to a smooth path: pieces of linear curvature, curvature continuous.

First the line of least change of curvature within the corridor: points p that minimise the squares of their third
differences and, weighted, of their distance from the polyline; weights grow where a point leaves its corridor
(iteratively reweighted least squares). Then a path of linear curvature is driven along these points with a small
correction, so that it is exactly smooth and stays with them to a millimetre.
"""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.numerics.array_functions import heading as heading_of
from simconsole.values.platform import Pose
from simconsole.world.path_geometry import Piece, travel

Array = NDArray[np.float64]

STEP_M: Final = 0.5
_SMOOTH_M: Final = 5.0  # the length over which a bend is spread where the corridor is wide
_ROUNDS: Final = 30
_INSIDE: Final = 0.9  # of the corridor: what the second step may add
_RETURN_M: Final = 3.0  # the correction's length
_RUN_M: Final = 12.0
"""Straight line before and after the polyline while it is smoothed: there the path has no curvature."""


class Corridor(NamedTuple):
    """A polyline with, at each of its points, how far the path may be from it, and the speed limit from there."""

    line: Array  # float64 [N, 2]
    room_m: Array  # [N]
    limit_mps: Array  # [N]


class FittedPiece(NamedTuple):
    """A piece of the path, where it starts, and the speed limit on it."""

    start: Pose
    piece: Piece
    limit_mps: float


def fit(corridor: Corridor) -> list[FittedPiece]:
    """Return the path along a corridor of at least two different points."""
    points, room, limits = _sampled(corridor)
    smooth = _smoothed(points, room)
    run = round(_RUN_M / STEP_M)
    return _driven(smooth, limits)[run : len(smooth) - 1 - run]


def _sampled(corridor: Corridor) -> tuple[Array, Array, Array]:
    """Return points every half metre, with straight runs at both ends, their room and limits."""
    steps = np.hypot(*np.diff(corridor.line, axis=0).T)
    kept = np.concatenate((steps > 1e-6, (True,)))  # of equal points the last: its room and limit are those ahead
    line, room, limit = corridor.line[kept], corridor.room_m[kept], corridor.limit_mps[kept]
    way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    count = max(4, round(float(way[-1]) / STEP_M))
    run = round(_RUN_M / STEP_M)
    places = np.linspace(0.0, way[-1], count + 1)
    points = np.stack([np.interp(places, way, line[:, axis]) for axis in (0, 1)], axis=1)
    forward = (line[1] - line[0]) / way[1]
    onward = (line[-1] - line[-2]) / (way[-1] - way[-2])
    step = way[-1] / count
    before = line[0] - forward * step * np.arange(run, 0, -1)[:, None]
    after = line[-1] + onward * step * np.arange(1, run + 1)[:, None]
    ahead = np.pad(_stepped(places, way, room), 1, mode="edge")
    rooms = np.minimum(np.minimum(ahead[:-2], ahead[2:]), ahead[1:-1])
    limits = _stepped(places, way, limit)
    return (
        np.vstack((before, points, after)),
        np.pad(rooms, run, mode="edge"),
        np.pad(limits, run, mode="edge"),
    )


def _stepped(places: Array, way: Array, values: Array) -> Array:
    found: Array = values[np.clip(np.searchsorted(way, places, side="right") - 1, 0, len(values) - 1)]
    return found


def _smoothed(points: Array, room: Array) -> Array:
    weight = np.full(len(points), (STEP_M / _SMOOTH_M) ** 6)
    # The runs are straight, and so are to stay.
    weight[:2] = weight[-2:] = 1.0
    best = points
    for _ in range(_ROUNDS):
        best = _least(points, weight)
        away = np.hypot(*(best - points).T)
        outside = away > _INSIDE * room
        if not outside.any():
            break
        # Neighbours share the change of weight, else a single point would pull a kink into the line.
        over = np.minimum(away / (_INSIDE * room), 2.0)
        factor = np.where(outside, over * over * over, 1.0)
        wide = np.pad(factor, 4, mode="edge")
        weight = weight * np.max([wide[shift : shift + len(factor)] for shift in range(9)], axis=0)
    return best


def _least(points: Array, weight: Array) -> Array:
    """Return the points [N, 2] that minimise sum(third differences^2) + sum(weight * distance^2).

    The normal equations have a band of seven: a Cholesky factorisation L D L' of it, row by row.
    """
    count = len(points)
    third = np.array((-1.0, 3.0, -3.0, 1.0))
    bands = np.zeros((4, count))  # bands[k][i] is the entry (i, i + k)
    for first in range(4):
        for second in range(first, 4):
            bands[second - first][first : count - 3 + first] += third[first] * third[second]
    bands[0] += weight
    rows: list[tuple[float, ...]] = []  # of each i: L at (i, i - 1), (i, i - 2), (i, i - 3), then solutions over d
    d1 = d2 = d3 = 1.0  # of the rows before: the diagonal of D, L at their first and second place, what they solve
    a1 = a2 = b1 = 0.0
    x1 = x2 = x3 = y1 = y2 = y3 = 0.0
    shifted = (np.pad(bands[k][: count - k], (k, 0)).tolist() for k in range(4))  # entry (i, i - k) at i
    right = (points * weight[:, None]).tolist()
    for diagonal, one, two, three, (right_x, right_y) in zip(*shifted, right, strict=True):
        c = three / d3
        b = (two - c * d3 * a2) / d2
        a = (one - b * d2 * a1 - c * d3 * b1) / d1
        d = diagonal - a * a * d1 - b * b * d2 - c * c * d3
        x = right_x - a * x1 - b * x2 - c * x3
        y = right_y - a * y1 - b * y2 - c * y3
        rows.append((a, b, c, x / d, y / d))
        d1, d2, d3, a1, a2, b1 = d, d1, d2, a, a1, b
        x1, x2, x3, y1, y2, y3 = x, x1, x2, y, y1, y2
    found: list[tuple[float, float]] = []
    x1 = x2 = x3 = y1 = y2 = y3 = 0.0
    a1 = b1 = b2 = c1 = c2 = c3 = 0.0  # of the rows behind
    for a, b, c, x, y in reversed(rows):
        x1, x2, x3 = x - (a1 * x1 + b2 * x2 + c3 * x3), x1, x2
        y1, y2, y3 = y - (a1 * y1 + b2 * y2 + c3 * y3), y1, y2
        found.append((x1, y1))
        a1, b1, b2, c1, c2, c3 = a, b, b1, c, c1, c2
    return np.array(found[::-1])


def _driven(points: Array, limits: Array) -> list[FittedPiece]:
    """Return pieces of linear curvature along points, each from one to the next."""
    chords = np.diff(points, axis=0)
    lengths = np.hypot(*chords.T)
    headings = np.unwrap(heading_of(chords[:, 1], chords[:, 0]))
    between = 0.5 * (lengths[1:] + lengths[:-1])
    curvature = np.concatenate(((0.0,), np.diff(headings) / between, (0.0,))).tolist()
    yaw = np.concatenate((headings[:1], 0.5 * (headings[1:] + headings[:-1]), headings[-1:])).tolist()
    pose, now = Pose(float(points[0, 0]), float(points[0, 1]), yaw[0]), 0.0
    pieces: list[FittedPiece] = []
    ends, caps = points[1:].tolist(), limits.tolist()
    for index, (x, y) in enumerate(ends):
        heading = headings[index]
        away_x, away_y = x - pose.x_m, y - pose.y_m
        length = away_x * math.cos(heading) + away_y * math.sin(heading)
        # Where this piece would end if it only followed the curvature of the points.
        planned = travel(pose, Piece(length, now, curvature[index + 1]))
        left = (planned.y_m - y) * math.cos(yaw[index + 1]) - (planned.x_m - x) * math.sin(yaw[index + 1])
        turned = planned.yaw_rad - yaw[index + 1]
        then = curvature[index + 1] - left / _RETURN_M**2 - 2.0 * turned / _RETURN_M
        piece = Piece(length, now, then)
        pieces.append(FittedPiece(pose, piece, caps[index]))
        pose, now = travel(pose, piece), then
    return pieces
