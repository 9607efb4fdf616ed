"""Polygons to triangles by cutting ears: exact for every simple polygon, concave ones included."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.uint32]

FLAT_M2: Final = 1e-12
"""Twice the area below which a corner is a straight line or a repeated point."""


def triangulate(polygon: Array) -> Indices:
    """Return the triangles [at most N - 2, 3] of a simple polygon [N, 2] in m, as indices of its vertices.

    A corner is an ear when it is convex and no other vertex lies inside its triangle; a simple polygon always has
    one (Meisters 1975). If the outline crosses itself and no ear is left, the rest is drawn as a fan.
    """
    points: list[list[float]] = polygon.tolist()
    if len(points) == 4 and _is_convex(points):  # most of what is drawn of a road: its strips
        return np.array(((3, 0, 1), (1, 2, 3)), dtype=np.uint32)
    left = list(range(len(points)))
    x, y = polygon.T.copy()
    turn = 1.0 if _area2(polygon) >= 0.0 else -1.0
    triangles: list[tuple[int, int, int]] = []
    at = misses = 0
    while len(left) > 3 and misses < len(left):
        at %= len(left)
        corner = (left[at - 1], left[at], left[(at + 1) % len(left)])
        a, b, c = (points[index] for index in corner)
        size = turn * _corner2(a, b, c)
        flat = abs(size) <= FLAT_M2
        if flat or (size > 0.0 and _is_empty(a, b, c, x[: len(left)], y[: len(left)], turn)):
            if not flat:
                triangles.append(corner)
            del left[at]
            for each in (x, y):  # of the vertices that are left, in their order
                each[at : len(left)] = each[at + 1 : len(left) + 1]
            misses = 0
        else:
            at, misses = at + 1, misses + 1
    triangles += [(left[0], left[i], left[i + 1]) for i in range(1, len(left) - 1)]
    return np.array(triangles, dtype=np.uint32).reshape(-1, 3)


def _is_convex(points: list[list[float]]) -> bool:
    """Return whether a polygon of four corners turns the same way at each of them."""
    turns = [_corner2(points[at - 2], points[at - 1], points[at]) for at in range(len(points))]
    return min(turns) > FLAT_M2 or max(turns) < -FLAT_M2


def _area2(points: Array) -> float:
    """Return twice the signed area, positive for anticlockwise."""
    x, y = (points - points[:1]).T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def _corner2(a: list[float], b: list[float], c: list[float]) -> float:
    """Return twice the signed area of one triangle."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _is_empty(a: list[float], b: list[float], c: list[float], x: Array, y: Array, turn: float) -> bool:
    """Return whether no vertex of those left lies inside a triangle; on its border, as its corners, is not inside."""
    inside = _left_of(a, b, x, y, turn)
    if not inside.any():
        return True
    inside &= _left_of(b, c, x, y, turn)
    if not inside.any():
        return True
    inside &= _left_of(c, a, x, y, turn)
    return not inside.any()


def _left_of(start: list[float], end: list[float], x: Array, y: Array, turn: float) -> NDArray[np.bool_]:
    """Return of each vertex whether it lies on the inner side of an edge, in the outline's turn."""
    along_x, along_y = end[0] - start[0], end[1] - start[1]
    return turn * (along_x * (y - start[1]) - along_y * (x - start[0])) > FLAT_M2
