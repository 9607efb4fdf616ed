import heapq
import math

import numpy as np
import pytest

from simconsole.drivers.robots.navigation.path_search import NEIGHBOURS, NEVER, Field, Found, search
from simconsole.drivers.robots.slam.odometry_track import Array
from simconsole.values.host.jit import compiled, plain
from tests.samples import Sample


def searched(cost: Array, start: int, goal: int, execution: object = compiled) -> Found:
    cells = cost.size
    size = NEIGHBOURS * cells + 1
    found = Found(np.empty(cells), np.empty(cells, dtype=np.int64), np.empty(size), np.empty(size, dtype=np.int64))
    assert callable(execution)
    execution(search)(Field(cost.ravel().copy(), cost.shape[1], cost.shape[0]), start, goal, found)
    return found


def known(cost: Array, start: int) -> Array:
    """Dijkstra's method as books have it."""
    rows, columns = cost.shape
    best = np.full(cost.size, NEVER)
    best[start] = 0.0
    waiting = [(0.0, start)]
    while waiting:
        so_far, cell = heapq.heappop(waiting)
        if so_far > best[cell]:
            continue
        row, column = divmod(cell, columns)
        for r in range(max(0, row - 1), min(rows, row + 2)):
            for c in range(max(0, column - 1), min(columns, column + 2)):
                at = r * columns + c
                further = so_far + math.hypot(r - row, c - column) * 0.5 * (cost[row, column] + cost[r, c])
                if at != cell and cost[r, c] < NEVER and further < best[at] - 1e-12:
                    best[at] = further
                    heapq.heappush(waiting, (further, at))
    return best


def test_ways_are_the_cheapest(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    for _ in range(sample.of(20, 300)):
        cost = 1.0 + 3.0 * rng.random((rng.integers(2, 25), rng.integers(2, 25)))
        cost[rng.random(cost.shape) < 0.3] = NEVER
        start, goal = rng.integers(0, cost.size, 2).tolist()
        cost.ravel()[[start, goal]] = 1.0
        best = known(cost, start)
        assert searched(cost, start, -1).best == pytest.approx(best)
        found = searched(cost, start, goal)
        assert found.best[goal] == pytest.approx(best[goal])
        if best[goal] < NEVER:
            cell, steps = goal, 0
            while cell != start:
                before = int(found.before[cell])
                (row, column), (at_row, at_column) = (divmod(one, cost.shape[1]) for one in (cell, before))
                assert max(abs(row - at_row), abs(column - at_column)) == 1
                cell, steps = before, steps + 1
            assert steps < cost.size


def test_both_executions_agree() -> None:
    cost = np.ones((6, 7))
    cost[1:6, 3] = NEVER
    one, other = searched(cost, 35, 41, plain), searched(cost, 35, 41)
    assert (one.best == other.best).all()
    assert (one.before == other.before).all()
