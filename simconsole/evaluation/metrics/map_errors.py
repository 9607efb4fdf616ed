"""How well an occupancy grid shows the walls that really stand."""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.metrics.table import Array
from simconsole.world.arena.occupancy import OCCUPIED, Grid
from simconsole.world.arena.outlines import Outlines

_PER_CELL: Final = 4.0
"""Places along a wall for each cell that it goes through."""

Mask = NDArray[np.bool_]


class MapErrors(NamedTuple):
    """Of the occupied cells of a map, against the outlines of what stands."""

    precision: float  # share of them with an outline in them or in a neighbour
    recall: float  # share of the cells with an outline that are occupied, or have an occupied neighbour
    wall_m: float  # mean distance of their middles from the nearest outline


def map_errors(grid: Grid, outlines: Outlines) -> MapErrors:
    """Return the errors of a map that is given in the frame of the outlines.

    Raises:
        ValueError: nothing is occupied.
    """
    found = grid.cells == OCCUPIED
    if not found.any():
        raise ValueError("a map without an occupied cell")
    places = _along(outlines, grid.resolution_m / _PER_CELL)
    at = np.floor((places - (grid.x_m, grid.y_m)) / grid.resolution_m).astype(np.int64)
    # Outlines outside the grid count as missed: it is made larger to hold them.
    low = np.minimum(at.min(axis=0), 0)
    high = np.maximum(at.max(axis=0) + 1, found.shape[::-1])
    columns, rows = (high - low).tolist()
    true, whole = np.zeros((rows, columns), dtype=bool), np.zeros((rows, columns), dtype=bool)
    true[at[:, 1] - low[1], at[:, 0] - low[0]] = True
    whole[-low[1] : found.shape[0] - low[1], -low[0] : found.shape[1] - low[0]] = found
    cells = np.argwhere(found)
    middles = np.empty((len(cells), 2))
    middles[:, 0] = grid.x_m + (cells[:, 1] + 0.5) * grid.resolution_m
    middles[:, 1] = grid.y_m + (cells[:, 0] + 0.5) * grid.resolution_m
    return MapErrors(
        precision=float(_widened(true)[whole].mean()),
        recall=float(_widened(whole)[true].mean()),
        wall_m=float(to_outlines(middles, outlines).mean()),
    )


def _along(outlines: Outlines, step_m: float) -> Array:
    """Return places [N, 2] along all outlines, at most a step apart."""
    places = []
    for ax, ay, bx, by in outlines.segments.tolist():
        shares = np.linspace(0.0, 1.0, 2 + int(math.hypot(bx - ax, by - ay) / step_m))
        places.append(np.column_stack((ax + shares * (bx - ax), ay + shares * (by - ay))))
    for x, y, radius in outlines.circles.tolist():
        angles = np.linspace(0.0, 2.0 * np.pi, 8 + int(2.0 * np.pi * radius / step_m))
        places.append(np.column_stack((x + radius * np.cos(angles), y + radius * np.sin(angles))))
    return np.concatenate(places)


def _widened(mask: Mask) -> Mask:
    """Return a mask with the eight neighbours of its cells."""
    padded = np.pad(mask, 1)
    rows, columns = mask.shape
    wide = np.zeros_like(mask)
    for down in range(3):
        for right in range(3):
            wide |= padded[down : down + rows, right : right + columns]
    return wide


def to_outlines(places: Array, outlines: Outlines) -> Array:
    """Return the distance of each place [N, 2] from the nearest outline."""
    nearest = np.full(len(places), np.inf)
    for ax, ay, bx, by in outlines.segments.tolist():
        way = np.array((bx - ax, by - ay))
        share = np.clip((places - (ax, ay)) @ way / max(float(way @ way), 1e-12), 0.0, 1.0)
        away = places - (ax, ay) - share[:, None] * way
        nearest = np.minimum(nearest, np.hypot(away[:, 0], away[:, 1]))
    for x, y, radius in outlines.circles.tolist():
        nearest = np.minimum(nearest, np.abs(np.hypot(places[:, 0] - x, places[:, 1] - y) - radius))
    return nearest
