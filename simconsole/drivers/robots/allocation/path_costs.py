"""What ways cost on an occupancy grid: shortest paths that keep a robot's radius from everything that is not free."""

import heapq
import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from simconsole.drivers.robots.allocation.problem import Problem

Cell = tuple[int, int]
Place = tuple[float, float]
_STEPS: Final = tuple(
    (down, right, math.hypot(down, right)) for down in (-1, 0, 1) for right in (-1, 0, 1) if down or right
)


class PathGrid:
    """The cells that a robot's middle may pass, of a map whose first cell's corner lies at `origin_m`."""

    def __init__(self, free: NDArray[np.bool_], resolution_m: float, origin_m: Place, radius_m: float) -> None:
        """Keep `radius_m` from every cell of [rows, columns] that is not free."""
        self.resolution_m = resolution_m
        self._origin_m = origin_m
        self.passable = _shrunk(free, radius_m / resolution_m)

    def cell(self, place: Place) -> Cell:
        """Return the cell of a place.

        Raises:
            ValueError: a robot cannot stand there.
        """
        row, column = (math.floor((place[axis] - self._origin_m[axis]) / self.resolution_m) for axis in (1, 0))
        rows, columns = self.passable.shape
        if not (0 <= row < rows and 0 <= column < columns and self.passable[row, column]):
            raise ValueError(f"({place[0]:g}, {place[1]:g}): a robot cannot stand there")
        return row, column

    def lengths_from(self, place: Place, goals: Sequence[Place]) -> list[float]:
        """Return the length in m of the shortest path to each goal, straightened; infinite where there is none.

        Raises:
            ValueError: a robot cannot stand at one of them.
        """
        start = self.cell(place)
        before = self._tree(start)
        lengths = []
        for goal in goals:
            cell = self.cell(goal)
            if cell != start and cell not in before:
                lengths.append(math.inf)
                continue
            path = [cell]
            while path[-1] != start:
                path.append(before[path[-1]])
            lengths.append(self._straightened(path))
        return lengths

    def _tree(self, start: Cell) -> dict[Cell, Cell]:
        """Return for each cell that can be reached the one before it on a shortest way over eight neighbours."""
        best, before = {start: 0.0}, dict[Cell, Cell]()
        waiting = [(0.0, start)]
        rows, columns = self.passable.shape
        while waiting:
            length, cell = heapq.heappop(waiting)
            if length > best[cell]:
                continue
            for down, right, step in _STEPS:
                at = (cell[0] + down, cell[1] + right)
                if not (0 <= at[0] < rows and 0 <= at[1] < columns and self.passable[at]):
                    continue
                further = length + step
                if further < best.get(at, math.inf):
                    best[at], before[at] = further, cell
                    heapq.heappush(waiting, (further, at))
        return before

    def _straightened(self, path: list[Cell]) -> float:
        """Return the length of a path whose corners are left out where the way between their neighbours is free."""
        corners, index = [path[0]], 0
        while index < len(path) - 1:
            further = len(path) - 1
            while further > index + 1 and not self._is_clear(path[index], path[further]):
                further -= max(1, (further - index) // 8)
            index = max(further, index + 1)
            corners.append(path[index])
        steps = zip(corners, corners[1:], strict=False)  # noqa: RUF007
        return self.resolution_m * sum(math.dist(a, b) for a, b in steps)

    def _is_clear(self, a: Cell, b: Cell) -> bool:
        shares = np.linspace(0.0, 1.0, 2 * max(abs(a[0] - b[0]), abs(a[1] - b[1])) + 2)
        rows = np.rint(a[0] + shares * (b[0] - a[0])).astype(np.int64)
        columns = np.rint(a[1] + shares * (b[1] - a[1])).astype(np.int64)
        return bool(self.passable[rows, columns].all())


def _shrunk(free: NDArray[np.bool_], radius_cells: float) -> NDArray[np.bool_]:
    """Return the free cells whose middle is further than the radius from the middle of every other cell."""
    reach = math.floor(radius_cells)
    blocked = np.pad(~free, reach, constant_values=True)
    near = np.zeros_like(free)
    rows, columns = free.shape
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            if math.hypot(down, right) <= radius_cells:
                near |= blocked[reach + down : reach + down + rows, reach + right : reach + right + columns]
    return np.asarray(~near)


def problem_on(grid: PathGrid, robots: Sequence[Place], tasks: Sequence[Place]) -> Problem:
    """Return the problem whose costs are lengths of paths on a grid.

    Raises:
        ValueError: a robot cannot stand at one of the places.
    """
    return Problem(
        start=tuple(tuple(grid.lengths_from(robot, tasks)) for robot in robots),
        between=tuple(tuple(grid.lengths_from(task, tasks)) for task in tasks),
    )
