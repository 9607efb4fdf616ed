"""What ground is taken: a grid of roads, so that nothing is built on them and a kerb knows its outer side."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from simconsole.world.triangles import Indices

Array = NDArray[np.float64]

CELL_M: Final = 0.5
MARGIN_M: Final = 60.0


class Occupancy:
    """A grid over `map`: True where something stands or a road runs."""

    def __init__(self, low: Array, high: Array) -> None:
        """Span the rectangle from `low` to `high` [2] in m, and MARGIN_M around it."""
        self._low = low - MARGIN_M
        shape = np.ceil((high + MARGIN_M - self._low) / CELL_M).astype(int) + 1
        self._taken = np.zeros(shape, dtype=bool)

    def add(self, points: Array, triangles: Indices) -> None:
        """Take the ground under triangles [M, 3] of points [N, 2], and half a cell around it."""
        for corners in points[triangles]:
            first, last = self._cells(corners.min(axis=0)), self._cells(corners.max(axis=0)) + 1
            x, y = (np.arange(first[i], last[i]) * CELL_M + self._low[i] for i in (0, 1))
            along, beside = corners[1] - corners[0], corners[2] - corners[0]
            turn = float(np.sign(along[0] * beside[1] - along[1] * beside[0]))
            inside = np.ones((len(x), len(y)), dtype=bool)
            for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
                edge = end - start
                left_of_edge = edge[0] * (y[None, :] - start[1]) - edge[1] * (x[:, None] - start[0])
                inside &= turn * left_of_edge >= -0.5 * CELL_M * float(np.abs(edge).sum())
            self._taken[first[0] : last[0], first[1] : last[1]] |= inside

    def is_taken(self, points: Array) -> NDArray[np.bool_]:
        """Return for each point [N, 2] whether its ground is taken; outside of the grid nothing is."""
        cells = self._cells(points)
        within = ((cells >= 0) & (cells < self._taken.shape)).all(axis=1)
        clipped = np.clip(cells, 0, np.array(self._taken.shape) - 1)
        return np.asarray(within & self._taken[clipped[:, 0], clipped[:, 1]])

    def take_disc(self, x_m: float, y_m: float, radius_m: float) -> bool:
        """Take a disc of ground if all of it is free; return whether it was."""
        first, last = (self._cells(np.array((x_m + sign * radius_m, y_m + sign * radius_m))) for sign in (-1.0, 1.0))
        if (first < 0).any() or (last >= self._taken.shape).any():
            return False
        part = self._taken[first[0] : last[0] + 1, first[1] : last[1] + 1]
        if part.any():
            return False
        part[:] = True
        return True

    def _cells(self, points: Array) -> NDArray[np.int64]:
        return np.asarray(np.floor((points - self._low) / CELL_M + 0.5).astype(np.int64))
