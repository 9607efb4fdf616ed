"""Grids to plan on."""

import numpy as np

from simconsole.world.arena.occupancy import FREE, OCCUPIED, UNKNOWN, Grid

CELL_M = 0.05


def two_rooms(door_m: float = 0.8) -> Grid:
    """4 x 3 m with a wall at x = 2 m up to a door at the top."""
    cells = np.full((60, 80), FREE, dtype=np.int8)
    cells[0, :] = cells[-1, :] = OCCUPIED
    cells[:, 0] = cells[:, -1] = OCCUPIED
    cells[: 60 - round(door_m / CELL_M), 40] = OCCUPIED
    return Grid(cells, CELL_M, 0.0, 0.0)


def half_known() -> Grid:
    """The same, with nothing known of what lies behind the door."""
    grid = two_rooms()
    cells = grid.cells.copy()
    cells[:, 41:] = UNKNOWN
    return grid._replace(cells=cells)
