"""From the strips of all roads to the field of heights that a car drives on and a picture shows."""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.height_field import Grid, HeightField
from simconsole.world.relief.strips import STEP_M, Array, Strips

MOST_NODES: Final = 1_000_000
"""16 MB. A larger world gets wider cells."""
LEAST_CELL_M: Final = 1.0
MARGIN_M: Final = 150.0
"""Of ground around the roads; beyond it the ground goes on level."""
SHOULDER_M: Final = 6.0
"""Beside the road the ground goes on as the road lies, as far as this."""
EMBANKMENT_M: Final = 30.0
"""Beyond, it runs out into the land within this."""
FAR_M: Final = 4.0
"""Distances from the edge are kept up to here: no wheel asks for more."""
_LAND_CELLS: Final = 90
_LAND_POINTS: Final = 400
_FINEST_M: Final = 2.0**-20
"""Heights are whole multiples of a micrometre or so: what the last bit of a sine does is not in them."""
_PROBE_M: Final = 0.7
_PROBE_EVERY: Final = 4
_OVERLAP_M: Final = 2.5


class Edges(NamedTuple):
    """What is beside the roads: height of the kerb, and friction there as a share of the road's."""

    kerb_m: float
    off_road_share: float


def height_field(strips: Strips, shape: Strips, edges: Edges) -> HeightField:
    """Return the field of a world.

    Args:
        strips: roads that have heights.
        shape: all roads, for where they end; those of `strips` among them.
        edges: what is beside them.
    """
    grid = _grid(strips, edges)
    x: Array = grid.from_x_m + grid.cell_m * np.arange(int(grid.columns), dtype=np.float64)
    y: Array = grid.from_y_m + grid.cell_m * np.arange(int(grid.rows), dtype=np.float64)
    away = _distances(_opened(shape), x, y, grid.cell_m)
    near, weight = _near_heights(strips, x, y, grid.cell_m)
    share = np.clip((away - SHOULDER_M) / EMBANKMENT_M, 0.0, 1.0)
    share = np.where(weight > 0.0, share * share * (3.0 - 2.0 * share), 1.0)
    heights = near * (1.0 - share) + _land(strips, x, y) * share
    nodes = np.stack((np.round(heights / _FINEST_M) * _FINEST_M, np.clip(away, -FAR_M, FAR_M)), axis=-1)
    return HeightField(grid, nodes)


def _grid(strips: Strips, edges: Edges) -> Grid:
    west, south = float(strips.x_m.min()) - MARGIN_M, float(strips.y_m.min()) - MARGIN_M
    width, height = float(np.ptp(strips.x_m)) + 2.0 * MARGIN_M, float(np.ptp(strips.y_m)) + 2.0 * MARGIN_M
    cell = max(LEAST_CELL_M, math.ceil(8.0 * math.sqrt(width * height / MOST_NODES)) / 8.0)
    return Grid(
        from_x_m=math.floor(west),
        from_y_m=math.floor(south),
        cell_m=cell,
        per_cell_m=1.0 / cell,
        columns=math.ceil(width / cell) + 4.0,
        rows=math.ceil(height / cell) + 4.0,
        kerb_m=edges.kerb_m,
        off_road_share=edges.off_road_share,
    )


def _around(
    strips: Strips, index: int, x: Array, y: Array, cell_m: float, reach_m: float
) -> tuple[tuple[slice, slice], Array, Array]:
    """Return the nodes within reach of a point of the strips, and how far ahead and to the left of it they are."""
    px, py = strips.x_m[index], strips.y_m[index]
    low_x, high_x = (round((px - x[0] + sign * reach_m) / cell_m) for sign in (-1.0, 1.0))
    low_y, high_y = (round((py - y[0] + sign * reach_m) / cell_m) for sign in (-1.0, 1.0))
    window = slice(max(low_y, 0), high_y + 1), slice(max(low_x, 0), high_x + 1)
    dx, dy = x[None, window[1]] - px, y[window[0], None] - py
    cosine, sine = strips.forward_x[index], strips.forward_y[index]
    return window, dx * cosine + dy * sine, dy * cosine - dx * sine


def _near_heights(strips: Strips, x: Array, y: Array, cell_m: float) -> tuple[Array, Array]:
    """Return heights near the roads, and 0 where none is near.

    The mean of the planes through all near points (Shepard's method of first order): a plane road comes out plane, and
    where roads meet one runs into the other.
    """
    total, weight = np.zeros((len(y), len(x))), np.zeros((len(y), len(x)))
    reach = SHOULDER_M + EMBANKMENT_M + float(max(strips.left_m.max(), strips.right_m.max()))
    for index in range(len(strips.x_m)):
        far = index % 8 == 0  # every point near the road, some of them far from it: there they all say the same
        window, ahead, left = _around(strips, index, x, y, cell_m, reach if far else 8.0)
        squares = ahead * ahead + left * left
        near = 1.0 / (1.0 + squares)
        share = near * near * near
        if not far:
            share = share * (np.maximum(0.0, 1.0 - squares / 64.0)) ** 2
        plane = strips.height_m[index] + strips.grade[index] * ahead + strips.bank[index] * left
        total[window] += share * plane
        weight[window] += share
    return np.where(weight > 0.0, total / np.maximum(weight, 1e-300), 0.0), weight


def _distances(strips: Strips, x: Array, y: Array, cell_m: float) -> Array:
    """Return how far each node is from the edge of the nearest road, negative on it."""
    away = np.full((len(y), len(x)), SHOULDER_M + EMBANKMENT_M)
    for index in range(len(strips.x_m)):
        left_m, right_m = strips.left_m[index], strips.right_m[index]
        reach = (SHOULDER_M + EMBANKMENT_M if index % 4 == 0 else FAR_M + 2.0 * cell_m) + max(left_m, right_m)
        window, ahead, left = _around(strips, index, x, y, cell_m, reach)
        beside = np.maximum(left - left_m, -left - right_m)
        beyond = np.maximum(np.abs(ahead) - 0.5 * STEP_M, 0.0)
        # Within the length of the point's piece it is the distance aside, inside and outside; else to its corner.
        outside = np.maximum(beside, 0.0)
        found = np.where(beyond > 0.0, np.sqrt(beyond * beyond + outside * outside) + np.minimum(beside, 0.0), beside)
        away[window] = np.minimum(away[window], found)
    return away


def _opened(strips: Strips) -> Strips:
    """Return the strips, wider on each side where another road lies beside: between two lanes there is no edge."""
    cell = 2.0
    low_x, low_y = float(strips.x_m.min()) - 20.0, float(strips.y_m.min()) - 20.0
    column, row = (
        np.floor((at - low) / cell).astype(np.int64) for at, low in ((strips.x_m, low_x), (strips.y_m, low_y))
    )
    places: dict[tuple[int, int], list[int]] = {}
    for index, key in enumerate(zip(column.tolist(), row.tolist(), strict=True)):
        places.setdefault(key, []).append(index)
    sides = []
    for sign, width in ((1.0, strips.left_m), (-1.0, strips.right_m)):
        reach = sign * (width + _PROBE_M)
        probe_x, probe_y = strips.x_m - strips.forward_y * reach, strips.y_m + strips.forward_x * reach
        is_open = np.zeros(len(width))
        for index in range(0, len(width), _PROBE_EVERY):
            x, y = float(probe_x[index]), float(probe_y[index])
            cells = int((x - low_x) // cell), int((y - low_y) // cell)
            is_open[index : index + _PROBE_EVERY] = _is_road(strips, places, x, y, cells, index)
        sides.append(width + _OVERLAP_M * is_open)
    return strips._replace(left_m=sides[0], right_m=sides[1])


def _is_road(
    strips: Strips, places: dict[tuple[int, int], list[int]], x: float, y: float, cell: tuple[int, int], own: int
) -> bool:
    """Return whether a place lies on the strip of a point other than `own`, by the points in the cells around."""
    around = [place for i in range(-3, 4) for j in range(-3, 4) for place in places.get((cell[0] + i, cell[1] + j), ())]
    near: NDArray[np.int64] = np.array([place for place in around if place != own], dtype=np.int64)
    dx, dy = x - strips.x_m[near], y - strips.y_m[near]
    ahead = dx * strips.forward_x[near] + dy * strips.forward_y[near]
    left = dy * strips.forward_x[near] - dx * strips.forward_y[near]
    inside = (np.abs(ahead) <= STEP_M) & (left < strips.left_m[near]) & (-left < strips.right_m[near])
    return bool(inside.any())


def _land(strips: Strips, x: Array, y: Array) -> Array:
    """Return heights of the land between the roads: the mean of theirs by distance, of few places."""
    few = np.unique(np.linspace(0, len(strips.x_m) - 1, _LAND_POINTS).astype(np.int64))
    wide_x, wide_y = (np.linspace(axis[0], axis[-1], _LAND_CELLS) for axis in (x, y))
    dx = wide_x[None, :, None] - strips.x_m[few]
    dy = wide_y[:, None, None] - strips.y_m[few]
    share = 1.0 / (400.0 + dx * dx + dy * dy) ** 2
    coarse = (share * strips.height_m[few]).sum(axis=2) / share.sum(axis=2)
    across = np.stack([np.interp(x, wide_x, line) for line in coarse])
    return np.stack([np.interp(y, wide_y, line) for line in across.T], axis=1)
