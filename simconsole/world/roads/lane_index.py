"""Where a pose lies on a road map: the nearest lane, found by a uniform grid over the segments of all lanes."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.kernels import Row, kernel
from simconsole.values.numerics.array_functions import heading
from simconsole.world.roads.road_map import Array, Lane

CELL_M: Final = 25.0
REACH_M: Final = 100.0
"""Further than this from every lane, a pose is off the map."""
HEADING_M: Final = 1.0
"""A lane that leads the opposite way counts as two of these further away: lanes lie upon each other in junctions."""


class LanePosition(NamedTuple):
    """Where a pose lies on a map; off the map the lane is None and the rest 0."""

    lane: int | None
    s_m: float = 0.0  # along the lane from its beginning
    lateral_m: float = 0.0  # left of its centre line
    heading_error_rad: float = 0.0  # turned left of it
    on_lane: bool = False  # no further from the centre line than half the lane's width


class Found(NamedTuple):
    """What the search returns: a segment's row, -1 for none; how far along it, and on which side."""

    segment: float
    along_m: float
    lateral_m: float


class LaneArrays(NamedTuple):
    """What `nearest_segment` searches, for kernels that call it."""

    rows: Row  # float64 [N, 6], those of `_segments`
    owners: Row  # float64 [N], the place of each segment's lane
    starts: Row  # int64 [cells + 1], where each cell's items begin
    items: Row  # int64, segments cell by cell
    grid: Row  # place (x, y), columns, rows


class LaneIndex:
    """The segments of some lanes of a map, ready for queries."""

    def __init__(self, lanes: Sequence[Lane], chosen: Sequence[int], search: Callable[..., Found]) -> None:
        """Sort the lanes `chosen` into a grid; `search` is `nearest_segment` or its compiled twin."""
        rows, owners = [], []
        for place in chosen:
            for row in _segments(lanes[place]):
                rows.append(row)
                owners.append(place)
        self.segments: Array = np.array(rows).reshape(-1, 6)
        self._owners = owners
        self._widths = [lanes[place].width_m for place in owners]
        self._directions = heading(self.segments[:, 3], self.segments[:, 2]).tolist()
        self._starts_m = self.segments[:, 5].tolist()
        self._grid, self._starts, self._items = _grid(self.segments)
        self._search = search

    @property
    def arrays(self) -> LaneArrays:
        """What the search works on."""
        owners = np.array(self._owners, dtype=np.float64)
        return LaneArrays(self.segments, owners, self._starts, self._items, self._grid)

    def locate(self, x_m: float, y_m: float, yaw_rad: float, heading_m: float = HEADING_M) -> LanePosition:
        """Return where a pose lies: on the lane whose distance, plus `heading_m` (1 - cos(heading error)), is least."""
        found = self._search(
            self.segments,
            self._starts,
            self._items,
            self._grid,
            x_m,
            y_m,
            math.cos(yaw_rad),
            math.sin(yaw_rad),
            heading_m,
        )
        row = int(found.segment)
        if row < 0:
            return LanePosition(None)
        return LanePosition(
            lane=self._owners[row],
            s_m=self._starts_m[row] + found.along_m,
            lateral_m=found.lateral_m,
            heading_error_rad=math.remainder(yaw_rad - self._directions[row], math.tau),
            on_lane=abs(found.lateral_m) <= 0.5 * self._widths[row],
        )


def _segments(lane: Lane) -> Iterator[tuple[float, ...]]:
    """Yield (x, y, direction x, direction y, length, distance from the lane's beginning) of each segment."""
    s = 0.0
    for (x, y), (to_x, to_y) in zip(lane.line[:-1, :2].tolist(), lane.line[1:, :2].tolist(), strict=True):
        length = math.hypot(to_x - x, to_y - y)
        if length > 0.0:
            yield x, y, (to_x - x) / length, (to_y - y) / length, length, s
        s += length


def _grid(segments: Array) -> tuple[Array, NDArray[np.int64], NDArray[np.int64]]:
    """Return the grid's place (x, y, columns, rows), where each cell's segments begin, and these, cell by cell."""
    if not len(segments):
        return np.zeros(4), np.zeros(1, np.int64), np.zeros(0, np.int64)
    start = segments[:, :2]
    end = start + segments[:, 2:4] * segments[:, 4:5]
    low = np.minimum(start, end).min(axis=0) - 1.0
    size = np.floor((np.maximum(start, end).max(axis=0) - low) / CELL_M).astype(np.int64) + 1
    first, last = (np.floor((side(start, end) - low) / CELL_M).astype(np.int64) for side in (np.minimum, np.maximum))
    within = (first == last).all(axis=1)  # one cell, as most segments
    cells, items = [first[within] @ (1, size[0])], [np.flatnonzero(within)]
    for number in np.flatnonzero(~within).tolist():
        touched = _touched(start[number], end[number], low, size)
        cells.append(touched)
        items.append(np.full(len(touched), number))
    cell, item = np.concatenate(cells), np.concatenate(items)
    order = np.lexsort((item, cell))
    starts = np.searchsorted(cell[order], np.arange(int(size.prod()) + 1))
    return np.array((*low, *size), dtype=np.float64), starts.astype(np.int64), item[order]


def _touched(one: Array, other: Array, low: Array, size: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the cells that a segment may touch: those whose centre lies within half a diagonal of it."""
    first = np.floor((np.minimum(one, other) - low) / CELL_M).astype(np.int64)
    last = np.floor((np.maximum(one, other) - low) / CELL_M).astype(np.int64)
    columns, rows = (np.arange(first[axis], last[axis] + 1) for axis in (0, 1))
    column, row = (grid.ravel() for grid in np.meshgrid(columns, rows))
    centres = low + CELL_M * (np.stack((column, row), axis=1) + 0.5)
    along = other - one
    share = np.clip((centres - one) @ along / float(along @ along), 0.0, 1.0)
    away = np.hypot(*(centres - one - share[:, None] * along).T)
    near = away <= math.sqrt(0.5) * CELL_M + 1e-6
    found: NDArray[np.int64] = (row * size[0] + column)[near]
    return found


@kernel
def nearest_segment(
    segments: Row,
    starts: Row,
    items: Row,
    grid: Row,
    x_m: float,
    y_m: float,
    cosine: float,
    sine: float,
    heading_m: float,
) -> Found:
    """Return the segment of least cost within REACH_M, by rings of cells round the pose's own."""
    columns, rows = int(grid[2]), int(grid[3])
    column, row = (x_m - grid[0]) / CELL_M, (y_m - grid[1]) / CELL_M
    best, segment, along_m, lateral_m = 1e9, -1.0, 0.0, 0.0
    # Also no number, or one too large for an integer, is off the map.
    if not (-10.0 < column < columns + 10.0 and -10.0 < row < rows + 10.0):
        return Found(segment, along_m, lateral_m)
    centre_column, centre_row = int(column + 10.0) - 10, int(row + 10.0) - 10  # rounded down
    for ring in range(int(REACH_M / CELL_M) + 2):
        if best <= (ring - 1) * CELL_M:
            break
        for at_row in range(max(centre_row - ring, 0), min(centre_row + ring, rows - 1) + 1):
            outermost = at_row == centre_row - ring or at_row == centre_row + ring
            step = 1 if outermost or ring == 0 else 2 * ring
            for at_column in range(centre_column - ring, centre_column + ring + 1, step):
                if at_column < 0 or at_column >= columns:
                    continue
                cell = at_row * columns + at_column
                for place in range(starts[cell], starts[cell + 1]):
                    number = items[place]
                    dx, dy = x_m - segments[number, 0], y_m - segments[number, 1]
                    forward_x, forward_y = segments[number, 2], segments[number, 3]
                    along = dx * forward_x + dy * forward_y
                    if along < 0.0:
                        along = 0.0
                    if along > segments[number, 4]:
                        along = segments[number, 4]
                    away_x, away_y = dx - along * forward_x, dy - along * forward_y
                    away = math.sqrt(away_x * away_x + away_y * away_y)
                    cost = away + heading_m * (1.0 - (cosine * forward_x + sine * forward_y))
                    if away <= REACH_M and cost < best:
                        left = forward_x * dy - forward_y * dx
                        best, segment, along_m = cost, float(number), along
                        lateral_m = away if left >= 0.0 else -away
    return Found(segment, along_m, lateral_m)
