"""How far each cell of a grid is from the nearest obstacle: exactly, in time that grows with the number of cells.

The lower envelope of parabolas, along columns, then along rows (Felzenszwalb, Huttenlocher, Theory of Computing 2012).
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from simconsole.drivers.robots.slam.mapper import Execution
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.values.kernels import Row, kernel

FAR: Final = 1e12
"""Of a grid without obstacles, in cells squared."""
_END: Final = 1e18


def distances(obstacles: NDArray[np.bool_], execution: Execution) -> Array:
    """Return for each cell [rows, columns] how far its middle is from that of the nearest obstacle, in cells."""
    rows, columns = obstacles.shape
    squared = np.where(obstacles, 0.0, FAR).ravel()
    most = max(rows, columns)
    scratch = np.empty(most), np.empty(most, dtype=np.int64), np.empty(most + 1)
    execution(spread)(squared, columns, rows, *scratch)
    return np.sqrt(squared).reshape(rows, columns)


@kernel
def spread(squared: Row, columns: int, rows: int, line: Row, at: Row, borders: Row) -> None:
    """Turn 0 at obstacles and FAR elsewhere into squared distances.

    Args:
        squared: float64 [rows * columns].
        columns: of the grid.
        rows: of the grid.
        line: scratch, float64, as long as the longer side.
        at: scratch, int64, likewise.
        borders: scratch, float64, one longer.
    """
    for column in range(columns):
        _envelope(squared, column, columns, rows, line, at, borders)
    for row in range(rows):
        _envelope(squared, row * columns, 1, columns, line, at, borders)


@kernel
def _envelope(values: Row, first: int, stride: int, count: int, line: Row, at: Row, borders: Row) -> None:
    for place in range(count):
        line[place] = values[first + place * stride]
    lowest = 0
    at[0] = 0
    borders[0] = -_END
    borders[1] = _END
    for place in range(1, count):
        cut = _cut(line, at[lowest], place)
        while cut <= borders[lowest]:
            lowest -= 1
            cut = _cut(line, at[lowest], place)
        lowest += 1
        at[lowest] = place
        borders[lowest] = cut
        borders[lowest + 1] = _END
    lowest = 0
    for place in range(count):
        while borders[lowest + 1] < place:
            lowest += 1
        away = place - at[lowest]
        values[first + place * stride] = away * away + line[at[lowest]]


@kernel
def _cut(line: Row, a: int, b: int) -> float:
    """Return where the parabola of b begins to lie below that of a, which is before it."""
    cut: float = ((line[b] + b * b) - (line[a] + a * a)) / (2.0 * (b - a))
    return cut
