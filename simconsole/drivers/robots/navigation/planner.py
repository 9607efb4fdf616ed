"""Plans over an occupancy grid: where a robot may stand, what it costs to be near a wall, and the way to a goal."""

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.drivers.robots.navigation.distance_field import distances
from simconsole.drivers.robots.navigation.path_search import NEIGHBOURS, NEVER, Field, Found, search
from simconsole.drivers.robots.navigation.robot_shape import RobotShape
from simconsole.drivers.robots.slam.mapper import Execution
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.world.arena.occupancy import OCCUPIED, UNKNOWN, Grid

Place = tuple[float, float]

KEEP_M: Final = 0.05
"""Least distance of a robot's body from everything."""
COMFORT_M: Final = 0.2
"""Further away than this beside it costs nothing."""
STEP_M: Final = 0.05
"""Between two points of a path."""
_NEAR_COST: Final = 3.0  # at KEEP_M, beside that of the way
_TOO_NEAR_COST: Final = 60.0
_GET_OUT_M: Final = 0.4
"""So far from where it stands a robot may be too near to something: one that was pushed there must get out."""
_UNKNOWN_COST: Final = 1.5
_SMOOTHINGS: Final = 12


class Surface(NamedTuple):
    """What a grid is to one robot."""

    grid: Grid
    away_m: Array  # [rows, columns]: from the nearest obstacle
    field: Field


class Planner:
    """Plans for one robot."""

    def __init__(self, shape: RobotShape, execution: Execution) -> None:
        """Plan for the point about which a robot of this shape turns."""
        self._execution = execution
        self._search = execution(search)
        self.touch_m = shape.radius_m + abs(shape.body_x_m)
        """A robot that turns here needs so much room."""
        self.keep_m = self.touch_m + KEEP_M

    def surface(self, grid: Grid, obstacles_m: Array) -> Surface:
        """Return what a grid is to the robot, with obstacles [N, 2] beside those on it."""
        occupied = grid.cells == OCCUPIED
        rows, columns = cells_of(grid, obstacles_m)
        within = (rows >= 0) & (columns >= 0) & (rows < occupied.shape[0]) & (columns < occupied.shape[1])
        occupied[rows[within], columns[within]] = True
        # From the edge of an occupied cell, for its wall is anywhere in it.
        away = np.maximum(0.0, distances(occupied, self._execution) - 0.5) * grid.resolution_m
        near = np.clip((self.keep_m + COMFORT_M - away) / COMFORT_M, 0.0, 1.0)
        cost = 1.0 + _NEAR_COST * near * near
        cost[away < self.keep_m] = _TOO_NEAR_COST
        cost[grid.cells == UNKNOWN] *= _UNKNOWN_COST
        cost[away < self.touch_m - 0.5 * grid.resolution_m] = NEVER
        return Surface(grid, away, Field(cost.ravel(), cost.shape[1], cost.shape[0]))

    def path(self, surface: Surface, start: Place, goal: Place) -> Array | None:
        """Return the way as points [N, 2] at most STEP_M apart, from start to goal; None where there is none."""
        begin = _open_cell(surface, surface.field, start)
        if begin is None:
            return None
        field = _field_from(surface, begin)
        end = _open_cell(surface, field, goal)
        if end is None:
            return None
        found = self._searched(field, begin, end)
        if found.best[end] >= NEVER:
            return None
        cells = [end]
        while cells[-1] != begin:
            cells.append(int(found.before[cells[-1]]))
        cells.reverse()
        points = _middles(surface.grid, np.array(_corners(surface, cells)))
        points[0] = start
        if end == _cell(surface, goal):
            points[-1] = goal
        return _smoothed(surface, _resampled(points))

    def lengths(self, surface: Surface, start: Place) -> Array:
        """Return the cost of the cheapest way to each cell [rows, columns], in cells; NEVER where there is none."""
        begin = _open_cell(surface, surface.field, start)
        shape = surface.away_m.shape
        if begin is None:
            return np.full(shape, NEVER)
        return np.asarray(self._searched(_field_from(surface, begin), begin, -1).best).reshape(shape)

    def _searched(self, field: Field, begin: int, end: int) -> Found:
        cells = len(field.cost)
        size = NEIGHBOURS * cells + 1
        found = Found(np.empty(cells), np.empty(cells, dtype=np.int64), np.empty(size), np.empty(size, dtype=np.int64))
        self._search(field, begin, end, found)
        return found


def cells_of(grid: Grid, places_m: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return rows and columns of places [N, 2], also of those outside the grid."""
    at = np.floor((places_m.reshape(-1, 2) - (grid.x_m, grid.y_m)) / grid.resolution_m).astype(np.int64)
    return at[:, 1], at[:, 0]


def _cell(surface: Surface, place: Place) -> int:
    """Return the cell of a place, that at the edge for one outside."""
    field = surface.field
    row, column = (int(found[0]) for found in cells_of(surface.grid, np.array(place)))
    return min(max(row, 0), field.rows - 1) * field.columns + min(max(column, 0), field.columns - 1)


def _field_from(surface: Surface, begin: int) -> Field:
    """Return the costs for a way that begins at a cell: too near to something only about there."""
    cost, columns = surface.field.cost.copy(), surface.field.columns
    narrow = np.flatnonzero((cost >= _TOO_NEAR_COST) & (cost < NEVER))
    row, column = divmod(begin, columns)
    away = np.hypot(narrow // columns - row, narrow % columns - column) * surface.grid.resolution_m
    cost[narrow[away > _GET_OUT_M]] = NEVER
    return surface.field._replace(cost=cost)


def _open_cell(surface: Surface, field: Field, place: Place) -> int | None:
    """Return the cell of a place, or the nearest one within 0.3 m that can be entered; None without one."""
    cell = _cell(surface, place)
    if field.cost[cell] < NEVER:
        return cell
    columns = surface.away_m.shape[1]
    reach = math.ceil(0.3 / surface.grid.resolution_m)
    row, column = divmod(cell, columns)
    top, left = max(0, row - reach), max(0, column - reach)
    window = field.cost.reshape(surface.away_m.shape)[top : row + reach + 1, left : column + reach + 1]
    rows, found = np.nonzero(window < NEVER)
    if not len(rows):
        return None
    nearest = int(np.argmin((rows + top - row) ** 2 + (found + left - column) ** 2))
    return int((rows[nearest] + top) * columns + found[nearest] + left)


def _middles(grid: Grid, cells: Array) -> Array:
    """Return the middles of cells [N, 2], rows and columns, as x and y."""
    return np.column_stack(
        (grid.x_m + (cells[:, 1] + 0.5) * grid.resolution_m, grid.y_m + (cells[:, 0] + 0.5) * grid.resolution_m)
    )


def _corners(surface: Surface, cells: Sequence[int]) -> list[tuple[int, int]]:
    """Return the cells of a way where it turns, without those between which a straight line is as far from walls."""
    columns = surface.away_m.shape[1]
    at = [divmod(cell, columns) for cell in cells]
    away = np.minimum(surface.away_m[tuple(np.array(at).T)], surface.away_m.max())
    corners, index = [at[0]], 0
    while index < len(at) - 1:
        further = len(at) - 1
        while further > index + 1:
            least = min(float(away[index : further + 1].min()), _comfortable(surface))
            if _is_clear(surface, at[index], at[further], least):
                break
            further -= max(1, (further - index) // 8)
        index = max(further, index + 1)
        corners.append(at[index])
    return corners


def _comfortable(surface: Surface) -> float:
    cheap = surface.away_m[surface.field.cost.reshape(surface.away_m.shape) < 1.0 + 0.25 * _NEAR_COST]
    return float(cheap.min()) if cheap.size else 0.0


def _is_clear(surface: Surface, a: tuple[int, int], b: tuple[int, int], least_m: float) -> bool:
    shares = np.linspace(0.0, 1.0, 2 * max(abs(a[0] - b[0]), abs(a[1] - b[1])) + 2)
    rows = np.rint(a[0] + shares * (b[0] - a[0])).astype(np.int64)
    columns = np.rint(a[1] + shares * (b[1] - a[1])).astype(np.int64)
    return bool((surface.away_m[rows, columns] >= least_m).all())


def _resampled(points: Array) -> Array:
    """Return a line with a point at least every STEP_M."""
    lengths = np.hypot(*np.diff(points, axis=0).T)
    along = np.concatenate(((0.0,), np.cumsum(lengths)))
    count = max(2, math.ceil(along[-1] / STEP_M) + 1)
    places = np.linspace(0.0, along[-1], count)
    return np.column_stack([np.interp(places, along, points[:, axis]) for axis in (0, 1)])


def _smoothed(surface: Surface, points: Array) -> Array:
    """Return a line with rounded corners; a point that would come nearer to a wall stays."""
    for _ in range(_SMOOTHINGS):
        moved = points.copy()
        moved[1:-1] = 0.5 * points[1:-1] + 0.25 * (points[:-2] + points[2:])
        worse = _away(surface, moved) < np.minimum(_away(surface, points), _comfortable(surface))
        points = np.where(worse[:, None], points, moved)
    return points


def _away(surface: Surface, points: Array) -> Array:
    rows, columns = cells_of(surface.grid, points)
    height, width = surface.away_m.shape
    return np.asarray(surface.away_m[np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)])


def length_m(points: Array) -> float:
    """Return the length of a line [N, 2]."""
    return float(np.hypot(*np.diff(points, axis=0).T).sum())
