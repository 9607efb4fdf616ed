"""Exact casting of rays against straight walls and circles in the plane, for range finders.

A grid over the arena lists for each cell the obstacles that reach into it. A ray walks from cell to cell (Amanatides
and Woo 1987) and ends at the first hit that lies no further than the cell it is in: the same distance as against all
obstacles, at the cost of those near the ray. Others that move are a short list that every ray is tested against.
"""

import math
from collections.abc import Callable, Iterator
from functools import partial
from math import sqrt
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.kernels import Row, clip, kernel
from simconsole.world.arena.outlines import Outlines, bounds

Corner = tuple[float, float]
CELL_M: Final = 0.5
MOST_CELLS: Final = 250_000
NO_HIT_M: Final = 1e9
"""Range of a ray that meets nothing as far as it goes."""
_MARGIN_M: Final = 1e-3
_SLACK: Final = 1e-9
"""Rays that hit a wall's very end count as hits: two walls that meet leave no gap."""


class RayGrid(NamedTuple):
    """Obstacles by cells. Cell (i, j) is number j * columns + i; its obstacles are `items[first[n] : first[n + 1]]`."""

    x_m: float  # of the grid's corner
    y_m: float
    cell_m: float
    columns: int
    rows: int
    first: NDArray[Any]  # int64 [cells + 1]
    items: NDArray[Any]  # int64: below the number of segments a segment, else a circle
    segments: Row  # float64 [N, 4]: x, y of one end, and the way to the other
    circles: Row  # float64 [M, 3]: x, y, radius


def ray_grid(outlines: Outlines) -> RayGrid:
    """Return the obstacles of an arena, ready for rays."""
    west, south, east, north = bounds(outlines)
    west, south, east, north = west - _MARGIN_M, south - _MARGIN_M, east + _MARGIN_M, north + _MARGIN_M
    cell_m = max(CELL_M, math.sqrt((east - west) * (north - south) / MOST_CELLS))
    columns, rows = math.ceil((east - west) / cell_m), math.ceil((north - south) / cell_m)
    segments = outlines.segments.copy()
    segments[:, 2:] -= segments[:, :2]
    cells: list[list[int]] = [[] for _ in range(columns * rows)]
    for item, (low, high, touches) in enumerate(_all(outlines)):
        for j in range(_cell(low[1], south, cell_m, rows), _cell(high[1], south, cell_m, rows) + 1):
            for i in range(_cell(low[0], west, cell_m, columns), _cell(high[0], west, cell_m, columns) + 1):
                if touches(west + (i + 0.5) * cell_m, south + (j + 0.5) * cell_m, 0.5 * cell_m + _MARGIN_M):
                    cells[j * columns + i].append(item)
    counts = [len(cell) for cell in cells]
    return RayGrid(
        x_m=west,
        y_m=south,
        cell_m=cell_m,
        columns=columns,
        rows=rows,
        first=np.concatenate(((0,), np.cumsum(counts))).astype(np.int64),
        items=np.array([item for cell in cells for item in cell], dtype=np.int64),
        segments=segments,
        circles=outlines.circles.copy(),
    )


def _cell(at_m: float, from_m: float, cell_m: float, count: int) -> int:
    return min(max(int((at_m - from_m) / cell_m), 0), count - 1)


def _all(outlines: Outlines) -> Iterator[tuple[Corner, Corner, Callable[[float, float, float], bool]]]:
    """Yield of each obstacle the lower and the upper corner, and a test whether it reaches into a square."""
    for ax, ay, bx, by in outlines.segments.tolist():
        low = (min(ax, bx) - _MARGIN_M, min(ay, by) - _MARGIN_M)
        high = (max(ax, bx) + _MARGIN_M, max(ay, by) + _MARGIN_M)
        yield low, high, partial(_crosses, (ax, ay), (bx, by))
    for x, y, radius in outlines.circles.tolist():
        yield (x - radius, y - radius), (x + radius, y + radius), lambda x, y, half: True


def _crosses(a: Corner, b: Corner, x: float, y: float, half: float) -> bool:
    """Return whether the line through a and b reaches into the square about (x, y)."""
    across_x, across_y = a[1] - b[1], b[0] - a[0]
    return abs((x - a[0]) * across_x + (y - a[1]) * across_y) <= half * (abs(across_x) + abs(across_y))


@kernel
def cast(x_m: float, y_m: float, dx: float, dy: float, most_m: float, grid: RayGrid, others: Row) -> float:
    """Return how far a ray goes, NO_HIT_M if it meets nothing within `most_m`.

    Args:
        x_m: Where it begins.
        y_m: Likewise.
        dx: Its direction, of length 1.
        dy: Likewise.
        most_m: How far it is followed.
        grid: What stands.
        others: Circles that move: float64 [N, 3], x, y, radius in m.
    """
    best = NO_HIT_M
    for index in range(len(others)):
        found = to_circle(x_m, y_m, dx, dy, others[index, 0], others[index, 1], others[index, 2])
        if found < best:
            best = found
    found = _walk(x_m, y_m, dx, dy, most_m if most_m < best else best, grid)
    if found < best:
        best = found
    return best if best <= most_m else NO_HIT_M


@kernel
def cast_all(rays: Row, most_m: float, grid: RayGrid, others: Row, ranges: Row) -> None:
    """Write the range of each ray [N, 4] (x, y, direction x, y) into `ranges` [N]; the rest as `cast`."""
    for index in range(len(rays)):
        ranges[index] = cast(rays[index, 0], rays[index, 1], rays[index, 2], rays[index, 3], most_m, grid, others)


@kernel
def _walk(x_m: float, y_m: float, dx: float, dy: float, most_m: float, grid: RayGrid) -> float:
    """Return the range against what stands."""
    at_x = (x_m - grid.x_m) / grid.cell_m
    at_y = (y_m - grid.y_m) / grid.cell_m
    # Distances along the ray, in m: to the grid's next line in x and y, and from line to line.
    step_x = grid.cell_m / abs(dx) if dx != 0.0 else NO_HIT_M
    step_y = grid.cell_m / abs(dy) if dy != 0.0 else NO_HIT_M
    along_x = at_x
    along_y = at_y
    if at_x < 0.0 or at_y < 0.0 or at_x >= grid.columns or at_y >= grid.rows:
        begin = _entered(at_x, at_y, dx, dy, step_x, step_y, grid)
        if begin > most_m:
            return NO_HIT_M
        along_x = clip(at_x + begin / grid.cell_m * dx, 0.0, grid.columns - 0.5)
        along_y = clip(at_y + begin / grid.cell_m * dy, 0.0, grid.rows - 0.5)
    i = int(along_x)
    j = int(along_y)
    way_i = 1 if dx >= 0.0 else -1
    way_j = 1 if dy >= 0.0 else -1
    next_x = ((i + 1 - at_x) if dx >= 0.0 else (at_x - i)) * step_x if dx != 0.0 else NO_HIT_M
    next_y = ((j + 1 - at_y) if dy >= 0.0 else (at_y - j)) * step_y if dy != 0.0 else NO_HIT_M
    best = NO_HIT_M
    while 0 <= i < grid.columns and 0 <= j < grid.rows:
        best = _in_cell(x_m, y_m, dx, dy, j * grid.columns + i, best, grid)
        leave = next_x if next_x < next_y else next_y
        if best <= leave or leave > most_m:
            return best
        if next_x < next_y:
            i += way_i
            next_x += step_x
        else:
            j += way_j
            next_y += step_y
    return best


@kernel
def _entered(at_x: float, at_y: float, dx: float, dy: float, step_x: float, step_y: float, grid: RayGrid) -> float:
    """Return the distance after which the ray is over the grid: 0 from inside, NO_HIT_M if it never is."""
    begin = 0.0
    end = NO_HIT_M
    if dx == 0.0:
        if at_x < 0.0 or at_x > grid.columns:
            return NO_HIT_M
    else:
        near = (-at_x if dx > 0.0 else at_x - grid.columns) * step_x
        far = near + grid.columns * step_x
        begin = near if near > begin else begin
        end = far if far < end else end
    if dy == 0.0:
        if at_y < 0.0 or at_y > grid.rows:
            return NO_HIT_M
    else:
        near = (-at_y if dy > 0.0 else at_y - grid.rows) * step_y
        far = near + grid.rows * step_y
        begin = near if near > begin else begin
        end = far if far < end else end
    return begin if begin <= end else NO_HIT_M


@kernel
def _in_cell(x_m: float, y_m: float, dx: float, dy: float, cell: int, best: float, grid: RayGrid) -> float:
    """Return the nearest hit among a cell's obstacles, `best` if none is nearer."""
    straight = len(grid.segments)
    for place in range(grid.first[cell], grid.first[cell + 1]):
        item = grid.items[place]
        if item < straight:
            found = to_segment(
                x_m, y_m, dx, dy,
                grid.segments[item, 0], grid.segments[item, 1], grid.segments[item, 2], grid.segments[item, 3],
            )  # fmt: skip
        else:
            circle = item - straight
            found = to_circle(
                x_m, y_m, dx, dy, grid.circles[circle, 0], grid.circles[circle, 1], grid.circles[circle, 2]
            )
        if found < best:
            best = found
    return best


@kernel
def to_segment(
    x_m: float, y_m: float, dx: float, dy: float, from_x: float, from_y: float, along_x: float, along_y: float
) -> float:
    """Return the range to a straight piece that begins at (from_x, from_y); seen along its own line it is not hit."""
    turn = dx * along_y - dy * along_x
    if turn == 0.0:
        return NO_HIT_M
    away_x = from_x - x_m
    away_y = from_y - y_m
    share = away_x * dy - away_y * dx  # of the piece, times `turn`: most pieces are missed, and need no division
    if turn < 0.0:
        turn = -turn
        share = -share
        away_x = -away_x
        away_y = -away_y
    if share < -_SLACK * turn or share > (1.0 + _SLACK) * turn:
        return NO_HIT_M
    found = away_x * along_y - away_y * along_x
    return found / turn if found >= 0.0 else NO_HIT_M


@kernel
def to_circle(x_m: float, y_m: float, dx: float, dy: float, centre_x: float, centre_y: float, radius_m: float) -> float:
    """Return the range to a circle's rim, from outside to its near side and from inside to its far side."""
    away_x = centre_x - x_m
    away_y = centre_y - y_m
    ahead = away_x * dx + away_y * dy
    aside = away_x * dy - away_y * dx
    inside = radius_m * radius_m - aside * aside
    if inside < 0.0:
        return NO_HIT_M
    half = sqrt(inside)
    near = ahead - half
    if near >= 0.0:
        return near
    far = ahead + half
    return far if far >= 0.0 else NO_HIT_M
