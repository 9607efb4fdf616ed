"""Exploration: the nearest place from which more of the map can be seen (Yamauchi, CIRA 1997).

A frontier is a row of free cells beside unknown ones. Short ones are shadows of corners, and are left alone.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from simconsole.drivers.robots.navigation.path_search import NEVER
from simconsole.drivers.robots.navigation.planner import Place, Planner, Surface
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.world.arena.occupancy import FREE, UNKNOWN

LEAST_M: Final = 0.5
"""Extent of a frontier that is worth a way."""
SIGHT_M: Final = 0.8
"""From a frontier to where a robot may stand to see it."""
GIVEN_UP_M: Final = 0.35

Mask = NDArray[np.bool_]


def next_view(planner: Planner, surface: Surface, start: Place, given_up: Sequence[Place] = ()) -> Place | None:
    """Return the place to go to next, None where all that can be reached is known.

    Args:
        planner: of the robot.
        surface: the map as it is known.
        start: where the robot is.
        given_up: places of frontiers that could not be seen from where they should have been.
    """
    lengths = planner.lengths(surface, start)
    reached = np.argwhere((lengths < NEVER) & (surface.away_m >= planner.keep_m) & (surface.grid.cells == FREE))
    best, chosen = NEVER, None
    for place in frontiers(surface):
        if any(np.hypot(place[0] - x, place[1] - y) < GIVEN_UP_M for x, y in given_up) or not len(reached):
            continue
        away = _distances_m(surface, reached, place)
        at = int(np.argmin(away))
        cost = lengths[tuple(reached[at])]
        if away[at] <= SIGHT_M and cost < best:
            best, chosen = cost, place
    return chosen


def standing(planner: Planner, surface: Surface, start: Place, place: Place) -> Place:
    """Return where to stand to see the frontier at `place`: the nearest that can be reached; `start` without one."""
    lengths = planner.lengths(surface, start)
    reached = np.argwhere((lengths < NEVER) & (surface.away_m >= planner.keep_m) & (surface.grid.cells == FREE))
    if not len(reached):
        return start
    row, column = reached[int(np.argmin(_distances_m(surface, reached, place)))].tolist()
    grid = surface.grid
    return grid.x_m + (column + 0.5) * grid.resolution_m, grid.y_m + (row + 0.5) * grid.resolution_m


def frontiers(surface: Surface) -> list[Place]:
    """Return of each frontier that is long enough the place of the cell that is nearest to its middle."""
    grid = surface.grid
    unknown = np.pad(grid.cells == UNKNOWN, 1, constant_values=True)
    beside = unknown[2:, 1:-1] | unknown[:-2, 1:-1] | unknown[1:-1, 2:] | unknown[1:-1, :-2]
    found = []
    for cells in _groups((grid.cells == FREE) & beside):
        if (np.ptp(cells, axis=0).max() + 1) * grid.resolution_m < LEAST_M:
            continue
        middle = cells.mean(axis=0)
        row, column = cells[int(np.argmin(((cells - middle) ** 2).sum(axis=1)))].tolist()
        found.append((grid.x_m + (column + 0.5) * grid.resolution_m, grid.y_m + (row + 0.5) * grid.resolution_m))
    return found


def _groups(mask: Mask) -> list[NDArray[np.int64]]:
    """Return the cells [N, 2] of each group of a mask that hangs together over sides or corners."""
    left = {(row, column) for row, column in np.argwhere(mask).tolist()}
    groups = []
    while left:
        front = [left.pop()]
        group = list(front)
        while front:
            row, column = front.pop()
            for at in ((row + down, column + right) for down in (-1, 0, 1) for right in (-1, 0, 1)):
                if at in left:
                    left.remove(at)
                    front.append(at)
                    group.append(at)
        groups.append(np.array(sorted(group)))
    return sorted(groups, key=lambda group: tuple(group[0]))


def _distances_m(surface: Surface, cells: NDArray[np.int64], place: Place) -> Array:
    grid = surface.grid
    x = grid.x_m + (cells[:, 1] + 0.5) * grid.resolution_m - place[0]
    y = grid.y_m + (cells[:, 0] + 0.5) * grid.resolution_m - place[1]
    return np.asarray(np.hypot(x, y))
