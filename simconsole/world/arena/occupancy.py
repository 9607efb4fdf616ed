"""An arena as an occupancy grid and back: what a ROS map holds.

Rows of a grid go up along y of map, columns along x; the first cell's corner is the grid's origin.
"""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.profiles.world import ArenaPoint, ArenaProfile, Spot, Wall
from simconsole.values.errors import ProfileError
from simconsole.world.arena.outlines import Outlines, bounds, outlines_of

OCCUPIED: Final = 100
FREE: Final = 0
UNKNOWN: Final = -1
"""What nav_msgs/OccupancyGrid calls them."""
MOST_CELLS: Final = 16_000_000
MARGIN_CELLS: Final = 3.5
"""Around everything; the half puts the middles of cells on walls at the edge."""
Places = NDArray[np.int64]
_NEIGHBOURS: Final = ((1, 0), (-1, 0), (0, 1), (0, -1))


class Grid(NamedTuple):
    """An occupancy grid."""

    cells: NDArray[np.int8]  # [rows, columns]: OCCUPIED, FREE or UNKNOWN
    resolution_m: float
    x_m: float  # of the corner of the first cell
    y_m: float


def grid_of(profile: ArenaProfile, resolution_m: float) -> Grid:
    """Return the occupancy of an arena: free is what can be reached from where robots start.

    Raises:
        ProfileError: it would have too many cells.
    """
    outlines = outlines_of(profile)
    west, south, east, north = bounds(outlines)
    margin_m = MARGIN_CELLS * resolution_m
    x_m, y_m = west - margin_m, south - margin_m
    columns = math.ceil((east + margin_m - x_m) / resolution_m)
    rows = math.ceil((north + margin_m - y_m) / resolution_m)
    if columns * rows > MOST_CELLS:
        raise ProfileError(f"resolution: value {resolution_m:g}: {columns} x {rows} cells: at most {MOST_CELLS} in all")
    cells = np.full((rows, columns), UNKNOWN, dtype=np.int8)
    for place in _touched(outlines, resolution_m, x_m, y_m, cells.shape):
        cells[place] = OCCUPIED
    starts = [(int((spot.y_m - y_m) / resolution_m), int((spot.x_m - x_m) / resolution_m)) for spot in profile.starts]
    cells[_reached(cells != OCCUPIED, starts)] = FREE
    return Grid(cells, resolution_m, x_m, y_m)


def _touched(
    outlines: Outlines, resolution_m: float, x_m: float, y_m: float, shape: tuple[int, ...]
) -> list[tuple[Places, Places]]:
    """Return the cells, rows and columns, that each obstacle reaches into."""
    found = []
    for ax, ay, bx, by in outlines.segments.tolist():
        count = 2 + int(4.0 * math.hypot(bx - ax, by - ay) / resolution_m)
        shares = np.linspace(0.0, 1.0, count)
        columns = np.floor((ax + shares * (bx - ax) - x_m) / resolution_m).astype(np.int64)
        rows = np.floor((ay + shares * (by - ay) - y_m) / resolution_m).astype(np.int64)
        found.append((rows, columns))
    middles_y = y_m + (np.arange(shape[0]) + 0.5) * resolution_m
    middles_x = x_m + (np.arange(shape[1]) + 0.5) * resolution_m
    for cx, cy, radius in outlines.circles.tolist():
        square = (middles_y[:, None] - cy) ** 2 + (middles_x[None, :] - cx) ** 2
        at_rows, at_columns = np.nonzero(square <= (radius + 0.5 * resolution_m) ** 2)
        found.append((at_rows, at_columns))
    return found


def _reached(passable: NDArray[np.bool_], starts: list[tuple[int, int]]) -> NDArray[np.bool_]:
    """Return the cells that can be reached from some of `starts` over sides."""
    reached = np.zeros_like(passable)
    front = [cell for cell in starts if passable[cell]]
    for cell in front:
        reached[cell] = True
    rows, columns = passable.shape
    while front:
        following = []
        for row, column in front:
            for down, right in _NEIGHBOURS:
                at = (row + down, column + right)
                if 0 <= at[0] < rows and 0 <= at[1] < columns and passable[at] and not reached[at]:
                    reached[at] = True
                    following.append(at)
        front = following
    return reached


def arena_of_grid(grid: Grid, title: str) -> ArenaProfile:
    """Return an arena whose walls are the outlines of occupied cells; a robot starts where there is most room.

    Raises:
        ProfileError: nothing is occupied or nothing is free.
    """
    occupied = grid.cells == OCCUPIED
    if not occupied.any() or not (grid.cells == FREE).any():
        raise ProfileError("image: value without occupied or without free cells: some of both")
    row, column = _roomiest(grid.cells == FREE)
    start = Spot(
        name="start",
        x_m=round(grid.x_m + (column + 0.5) * grid.resolution_m, 6),
        y_m=round(grid.y_m + (row + 0.5) * grid.resolution_m, 6),
    )
    return ArenaProfile(schema=1, title=title, walls=tuple(_outlines(occupied, grid)), starts=(start,))


def _outlines(occupied: NDArray[np.bool_], grid: Grid) -> list[Wall]:
    """Return the borders of occupied cells as straight walls, as long as they go."""
    padded = np.pad(occupied, 1)
    walls = []
    for upright in (False, True):
        turned = padded.T if upright else padded
        border = turned[1:] != turned[:-1]  # [lines, places along each]
        for line in np.flatnonzero(border.any(axis=1)).tolist():
            edges = np.flatnonzero(np.diff(np.concatenate(((0,), border[line].astype(np.int8), (0,)))))
            for begin, end in edges.reshape(-1, 2).tolist():
                corners = [(line, along - 1) for along in (begin, end)]
                places = [(across, along) if upright else (along, across) for across, along in corners]
                walls.append(
                    Wall(
                        points=tuple(
                            ArenaPoint(
                                x_m=round(grid.x_m + column * grid.resolution_m, 6),
                                y_m=round(grid.y_m + row * grid.resolution_m, 6),
                            )
                            for column, row in places
                        )
                    )
                )
    return walls


def _roomiest(free: NDArray[np.bool_]) -> tuple[int, int]:
    """Return the free cell that is furthest from others, row and column: what is left when the free area shrinks."""
    left = np.pad(free, 1)
    while True:
        inner = left.copy()
        for axis in (0, 1):
            for way in (1, -1):
                inner &= np.roll(left, way, axis=axis)
        if not inner.any():
            break
        left = inner
    row, column = np.argwhere(left)[0].tolist()
    return row - 1, column - 1
