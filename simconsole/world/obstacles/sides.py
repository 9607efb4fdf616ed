"""Fixed things of a map as arrays: the sides of their outlines, sorted into a grid for one look-up in each tick."""

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.kernels import Row
from simconsole.values.layout import Part
from simconsole.values.platform import Platform
from simconsole.world.roads.road_map import CONE, Array, Lane, Obstacle

CELL_M: Final = 25.0
CONE_KG: Final = 4.0
"""Of a traffic cone of 75 cm; whatever else stands beside a road does not move."""
_BESIDE_M: Final = 200.0
"""What lies further outside the box round all lanes is left out."""
_MOST_REACH_M: Final = 0.5 * CELL_M


class Body(NamedTuple):
    """The vehicle as far as fixed things ask; 1 / kg and 1 / (kg m2) are 0 where it takes no impulse."""

    half_length_m: float
    half_width_m: float
    middle_ahead_m: float  # of base_link
    cg_ahead_m: float  # likewise
    per_kg: float
    per_kgm2: float


class Side(NamedTuple):
    """One row of the table of sides: at most CELL_M long, the thing to its left."""

    x_m: float
    y_m: float
    towards_x: float  # its direction, of length 1
    towards_y: float
    length_m: float
    thing: float  # place in the map's obstacles
    per_kg: float  # of the thing; 0: it does not move


class FixedThings(NamedTuple):
    """What a tick looks up of the fixed things of a map."""

    sides: Row  # float64 [N, fields of Side], thing by thing
    starts: Row  # int64 [cells + 1], where each cell's items begin
    items: Row  # int64, sides that base_link may touch from the cell, cell by cell, in the order of their rows
    grid: Row  # place (x, y), columns, rows
    body: Row  # float64 [fields of Body]


BODY: Final = Part(Body)
NOBODY: Final = Body(half_length_m=0.0, half_width_m=0.0, middle_ahead_m=0.0, cg_ahead_m=0.0, per_kg=0.0, per_kgm2=0.0)


def body_of(platform: Platform) -> Body:
    """Return a vehicle as far as fixed things ask."""
    solid = platform.solid
    return Body(
        half_length_m=0.5 * platform.length_m,
        half_width_m=0.5 * platform.width_m,
        middle_ahead_m=0.5 * platform.length_m - platform.rear_overhang_m,
        cg_ahead_m=0.0 if solid is None else solid.cg_ahead_m,
        per_kg=0.0 if solid is None else 1.0 / solid.mass_kg,
        per_kgm2=0.0 if solid is None else 1.0 / solid.yaw_inertia_kgm2,
    )


def fixed_things(obstacles: Sequence[Obstacle], lanes: Sequence[Lane], body: Body = NOBODY) -> FixedThings:
    """Return the fixed things of a map, near its lanes, for a vehicle.

    Raises:
        ValueError: the vehicle is longer than a cell of the grid.
    """
    reach_m = math.hypot(abs(body.middle_ahead_m) + body.half_length_m, body.half_width_m)
    if reach_m > _MOST_REACH_M:
        raise ValueError(f"a vehicle of which a corner is {reach_m:.1f} m from base_link: at most {_MOST_REACH_M:g} m")
    low, high = _box_round(lanes)
    parts = [_sides(place, obstacle) for place, obstacle in enumerate(obstacles)]
    sides = np.vstack((np.zeros((0, len(Side._fields))), *parts))
    near = ((sides[:, :2] > low - CELL_M) & (sides[:, :2] < high + CELL_M)).all(axis=1)
    sides = sides[near]
    grid, starts, items = _sorted(sides, reach_m)
    return FixedThings(sides=sides, starts=starts, items=items, grid=grid, body=np.array(body))


def _box_round(lanes: Sequence[Lane]) -> tuple[Array, Array]:
    if not lanes:
        return np.zeros(2), np.zeros(2)
    points = np.vstack([lane.line[:, :2] for lane in lanes])
    return points.min(axis=0) - _BESIDE_M, points.max(axis=0) + _BESIDE_M


def _sides(place: int, obstacle: Obstacle) -> Array:
    """Return the sides of an outline, to the left round it, cut into pieces; an open line leads there and back."""
    corners = obstacle.outline
    x, y = corners.T
    if float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) < 0.0:
        corners = corners[::-1]
    ends = np.roll(corners, -1, axis=0)
    lengths = np.hypot(*(ends - corners).T)
    corners, ends, lengths = (part[lengths > 0.0] for part in (corners, ends, lengths))
    towards = (ends - corners) / lengths[:, None]
    counts = np.maximum(np.ceil(lengths / CELL_M), 1.0).astype(np.int64)
    whole = np.repeat(np.arange(len(corners)), counts)
    number = np.arange(len(whole)) - np.repeat(np.cumsum(counts) - counts, counts)
    each = (lengths / counts)[whole]
    start = corners[whole] + towards[whole] * (number * each)[:, None]
    own = np.tile((float(place), 1.0 / CONE_KG if obstacle.kind == CONE else 0.0), (len(whole), 1))
    return np.column_stack((start, towards[whole], each, own))


def _sorted(sides: Array, reach_m: float) -> tuple[Array, NDArray[np.int64], NDArray[np.int64]]:
    """Return the grid's place (x, y, columns, rows), where each cell's items begin, and these, cell by cell."""
    if not len(sides):
        return np.zeros(4), np.zeros(1, np.int64), np.zeros(0, np.int64)
    start = sides[:, :2]
    end = start + sides[:, 2:4] * sides[:, 4:5]
    low = np.minimum(start, end).min(axis=0) - reach_m - 1.0
    first = np.floor((np.minimum(start, end) - reach_m - low) / CELL_M).astype(np.int64)
    last = np.floor((np.maximum(start, end) + reach_m - low) / CELL_M).astype(np.int64)
    columns, rows = (last.max(axis=0) + 1).tolist()
    cells, items = [], []
    # A side of one cell, and half a cell on both ends of it, reach into three cells at most.
    for over in range(3):
        for up in range(3):
            at = first + np.array((over, up))
            inside = np.flatnonzero((at <= last).all(axis=1))
            cells.append(at[inside, 1] * columns + at[inside, 0])
            items.append(inside)
    cell, item = np.concatenate(cells), np.concatenate(items)
    order = np.lexsort((item, cell))
    starts = np.searchsorted(cell[order], np.arange(columns * rows + 1)).astype(np.int64)
    return np.array((*low, columns, rows), dtype=np.float64), starts, item[order]
