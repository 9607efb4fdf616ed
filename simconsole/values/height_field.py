"""A field of heights over `map`: a regular grid of heights, and of distances from the roads' edges.

Between its nodes both are quadratic B-splines (de Boor, A Practical Guide to Splines): smooth, so that a wheel meets
neither a step nor a bend, and never above or below the nodes around. Distances interpolate well where a raster of
classes would not: an edge lies where the distance is 0, whatever the cells, and kerb and verge rise over it.
"""

from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.kernels import Row, kernel

Array = NDArray[np.float64]

RAMP_M: Final = 0.25
"""Way over which a kerb rises: a wheel of 0.3 m rolls over an edge of 0.12 m in about this way."""
PER_NODE: Final = 2
"""Values of a node: height in m, distance from the road's edge in m, positive beside the road."""


class Grid(NamedTuple):
    """Where the nodes of a field lie, and what is beside its roads; all floats, in the ground's array."""

    from_x_m: float
    from_y_m: float
    cell_m: float
    per_cell_m: float  # 1 / m
    columns: float  # along x
    rows: float  # along y
    kerb_m: float
    off_road_share: float  # of the road's friction


NO_GRID: Final = Grid(
    from_x_m=0.0,
    from_y_m=0.0,
    cell_m=1.0,
    per_cell_m=1.0,
    columns=0.0,
    rows=0.0,
    kerb_m=0.0,
    off_road_share=1.0,
)


class HeightField(NamedTuple):
    """A field: its grid, and float64 [rows, columns, PER_NODE]."""

    grid: Grid
    nodes: Array


class Spot(NamedTuple):
    """The ground at a place."""

    height_m: float
    slope_x: float
    slope_y: float
    friction_share: float


@kernel
def node_before(place: float, count: float) -> float:
    """Return a place in cells, kept where three nodes lie around it: the ground goes on level beyond the grid."""
    if not place > 1.0:  # also no number
        return 1.0
    return place if place < count - 2.0 else count - 2.0


@kernel
def spot_at(ground: Row, first: int, grid: Grid, x_m: float, y_m: float) -> Spot:
    """Return the ground at a place; the nodes begin at `first` of the ground's array."""
    at_x, at_y = (x_m - grid.from_x_m) * grid.per_cell_m, (y_m - grid.from_y_m) * grid.per_cell_m
    u, v = node_before(at_x, grid.columns), node_before(at_y, grid.rows)
    column, row = int(u + 0.5), int(v + 0.5)
    f, g = u - column, v - row
    fl, fr, gl, gr = 0.5 - f, 0.5 + f, 0.5 - g, 0.5 + g
    left, middle, right = 0.5 * fl * fl, 0.75 - f * f, 0.5 * fr * fr
    height = height_x = height_y = edge = edge_x = edge_y = 0.0
    stride = PER_NODE * int(grid.columns)
    at = first + stride * (row - 1) + PER_NODE * (column - 1)
    for line in range(3):
        # Over one row of nodes, and how it changes along x; then the same across the rows.
        here = left * ground[at] + middle * ground[at + 2] + right * ground[at + 4]
        along = fr * (ground[at + 4] - ground[at + 2]) + fl * (ground[at + 2] - ground[at])
        away = left * ground[at + 1] + middle * ground[at + 3] + right * ground[at + 5]
        away_x = fr * (ground[at + 5] - ground[at + 3]) + fl * (ground[at + 3] - ground[at + 1])
        weight = 0.75 - g * g
        change = -2.0 * g
        if line == 0:
            weight, change = 0.5 * gl * gl, -gl
        if line == 2:
            weight, change = 0.5 * gr * gr, gr
        height += weight * here
        height_x += weight * along
        height_y += change * here
        edge += weight * away
        edge_x += weight * away_x
        edge_y += change * away
        at += stride
    inside_x = grid.per_cell_m if u == at_x else 0.0
    inside_y = grid.per_cell_m if v == at_y else 0.0
    if edge <= 0.0:
        return Spot(height, height_x * inside_x, height_y * inside_y, 1.0)
    rise = edge * (1.0 / RAMP_M) if edge < RAMP_M else 1.0
    steep = 6.0 * rise * (1.0 - rise) * (1.0 / RAMP_M) * grid.kerb_m
    return Spot(
        height + grid.kerb_m * rise * rise * (3.0 - 2.0 * rise),
        (height_x + steep * edge_x) * inside_x,
        (height_y + steep * edge_y) * inside_y,
        1.0 + (grid.off_road_share - 1.0) * rise,
    )


def spline_at(field: HeightField, value: int, x_m: Array, y_m: Array) -> Array:
    """Return one value of the nodes at places [N]: 0 the height without kerbs, 1 the distance from the edge, in m."""
    grid, found = field.grid, np.zeros(np.shape(x_m))
    axes: list[tuple[Any, list[Array]]] = []
    for at, start, count in ((x_m, grid.from_x_m, grid.columns), (y_m, grid.from_y_m, grid.rows)):
        place = np.clip((np.asarray(at) - start) * grid.per_cell_m, 1.0, count - 2.0)
        node = np.floor(place + 0.5).astype(np.int64)
        f = place - node
        axes.append((node, [0.5 * (0.5 - f) ** 2, 0.75 - f * f, 0.5 * (0.5 + f) ** 2]))
    (column, across), (row, upwards) = axes
    for i, weight_y in enumerate(upwards):
        for j, weight_x in enumerate(across):
            found += weight_y * weight_x * field.nodes[row + i - 1, column + j - 1, value]
    return found
