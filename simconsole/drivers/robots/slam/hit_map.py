"""A map of cells, each with the odds that it is occupied and with the sums of the echoes in it.

The odds say what is free, occupied and unknown (Moravec and Elfes, ICRA 1985). The sums give the line that the echoes
of a neighbourhood lie on, far finer than a cell: that is what scans are matched with (`scan_matching`).
"""

import math
from math import sqrt
from typing import Final, NamedTuple

import numpy as np

from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.values.kernels import Row, clip, kernel
from simconsole.world.arena.occupancy import FREE, OCCUPIED, UNKNOWN, Grid

HIT: Final = 0.9
MISS: Final = -0.4
MOST: Final = 3.5
"""Log odds that an echo and a ray through a cell add, and where they end: a wall that is gone is forgotten."""
OCCUPIED_ABOVE: Final = 0.5
FREE_BELOW: Final = -0.3
_KEPT_HITS: Final = 60.0
"""Of more echoes in a cell the older ones count less and less."""
_CHUNK: Final = 64


class HitMap(NamedTuple):
    """The arrays go row by row, up along y of map."""

    x_m: float  # of the corner of the first cell
    y_m: float
    cell_m: float
    columns: int
    rows: int
    log_odds: Row  # float64 [cells]
    hits: Row  # float64 [cells, 6]: count, sums of x, y, xx, xy, yy
    seen: Row  # int64 [cells]: number of the last scan that told of it, 0: none


def empty_map(x_m: float, y_m: float, cell_m: float) -> HitMap:
    """Return an unknown map around a place; the corners of its cells lie at multiples of `cell_m`."""
    half = _CHUNK // 2
    column, row = math.floor(x_m / cell_m) - half, math.floor(y_m / cell_m) - half
    return _unknown(column, row, _CHUNK, _CHUNK, cell_m)


def _unknown(column: int, row: int, columns: int, rows: int, cell_m: float) -> HitMap:
    cells = columns * rows
    return HitMap(
        x_m=column * cell_m,
        y_m=row * cell_m,
        cell_m=cell_m,
        columns=columns,
        rows=rows,
        log_odds=np.zeros(cells),
        hits=np.zeros((cells, 6)),
        seen=np.zeros(cells, dtype=np.int64),
    )


def grown(field: HitMap, places_m: Array) -> HitMap:
    """Return the map, larger where `places_m` [N, 2] lie outside it or at its edge."""
    corner = np.array((field.x_m, field.y_m))
    low = np.floor((places_m.min(axis=0) - corner) / field.cell_m).astype(int) - 2
    high = np.floor((places_m.max(axis=0) - corner) / field.cell_m).astype(int) + 3
    before = _CHUNK * -(np.minimum(low, 0) // _CHUNK)
    after = _CHUNK * -(-np.maximum(high - (field.columns, field.rows), 0) // _CHUNK)
    if not before.any() and not after.any():
        return field
    columns, rows = (np.array((field.columns, field.rows)) + before + after).tolist()
    at = np.rint(corner / field.cell_m).astype(int) - before
    larger = _unknown(int(at[0]), int(at[1]), columns, rows, field.cell_m)
    part = (slice(before[1], before[1] + field.rows), slice(before[0], before[0] + field.columns))
    for old, new in ((field.log_odds, larger.log_odds), (field.hits, larger.hits), (field.seen, larger.seen)):
        new.reshape(rows, columns, -1)[part] = old.reshape(field.rows, field.columns, -1)
    return larger


def occupancy(field: HitMap) -> Grid:
    """Return what is known as an occupancy grid, cut to the cells that a scan has told of."""
    seen = (field.seen > 0).reshape(field.rows, field.columns)
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    if not len(rows):
        return Grid(np.full((1, 1), UNKNOWN, dtype=np.int8), field.cell_m, field.x_m, field.y_m)
    part = (slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1))
    odds = field.log_odds.reshape(field.rows, field.columns)[part]
    cells = np.full(odds.shape, UNKNOWN, dtype=np.int8)
    cells[odds < FREE_BELOW] = FREE
    cells[odds > OCCUPIED_ABOVE] = OCCUPIED
    return Grid(
        cells=cells,
        resolution_m=field.cell_m,
        x_m=field.x_m + float(columns[0]) * field.cell_m,
        y_m=field.y_m + float(rows[0]) * field.cell_m,
    )


@kernel
def cell_at(field: HitMap, x_m: float, y_m: float) -> int:
    """Return the cell of a place, -1 outside the map."""
    column = int((x_m - field.x_m) / field.cell_m)
    row = int((y_m - field.y_m) / field.cell_m)
    if x_m < field.x_m or y_m < field.y_m or column >= field.columns or row >= field.rows:
        return -1
    return row * field.columns + column


@kernel
def draw(field: HitMap, lines_m: Row, echo: Row, number: int) -> None:
    """Enter a scan into the map: its echoes, and what lies free before them.

    A cell with an echo stays so: rays that graze a wall would else wipe it out. Each cell counts once a scan.

    Args:
        field: the map, changed in place.
        lines_m: float64 [N, 4]: of each ray x, y where it begins and where it ends, in map.
        echo: float64 [N]: 1 where something is at its end.
        number: of the scan, from 1 on.
    """
    for index in range(len(lines_m)):
        if echo[index] > 0.0:
            _hit(field, lines_m[index, 2], lines_m[index, 3], number)
    for index in range(len(lines_m)):
        _clear(field, lines_m[index, 0], lines_m[index, 1], lines_m[index, 2], lines_m[index, 3], number)


@kernel
def _hit(field: HitMap, x_m: float, y_m: float, number: int) -> None:
    cell = cell_at(field, x_m, y_m)
    if cell < 0:
        return
    if field.seen[cell] != number:
        if field.log_odds[cell] < 0.0:  # what was there before has gone
            for column in range(6):
                field.hits[cell, column] = 0.0
        field.log_odds[cell] = clip(field.log_odds[cell] + HIT, -MOST, MOST)
        field.seen[cell] = number
    if field.hits[cell, 0] >= _KEPT_HITS:
        for column in range(6):
            field.hits[cell, column] = 0.5 * field.hits[cell, column]
    field.hits[cell, 0] += 1.0
    field.hits[cell, 1] += x_m
    field.hits[cell, 2] += y_m
    field.hits[cell, 3] += x_m * x_m
    field.hits[cell, 4] += x_m * y_m
    field.hits[cell, 5] += y_m * y_m


@kernel
def _clear(field: HitMap, from_x: float, from_y: float, to_x: float, to_y: float, number: int) -> None:
    """Lower the odds along a ray, up to a cell before its end."""
    way_x = to_x - from_x
    way_y = to_y - from_y
    length = sqrt(way_x * way_x + way_y * way_y)
    step = 0.5 * field.cell_m
    count = int((length - field.cell_m) / step)
    for index in range(count):
        share = index * step / length
        cell = cell_at(field, from_x + share * way_x, from_y + share * way_y)
        if cell >= 0 and field.seen[cell] != number:
            field.log_odds[cell] = clip(field.log_odds[cell] + MISS, -MOST, MOST)
            field.seen[cell] = number
