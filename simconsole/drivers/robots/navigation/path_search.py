"""The cheapest way over a grid of costs: A* to one cell, or Dijkstra's method to all of them.

Nodes wait in a binary heap of two arrays; one whose cost has fallen meanwhile is passed over when it comes.
"""

from math import sqrt
from typing import Final, NamedTuple

from simconsole.values.kernels import Row, kernel

NEVER: Final = 1e18
"""The cost of what cannot be reached, or entered."""
NEIGHBOURS: Final = 8
_DIAGONAL: Final = 1.4142135623730951


class Field(NamedTuple):
    """What it costs to pass each cell, per cell of way: 1 or more, NEVER where it cannot be entered."""

    cost: Row  # float64 [rows * columns]
    columns: int
    rows: int


class Found(NamedTuple):
    """What a search fills."""

    best: Row  # float64 [cells]: cost of the way to each
    before: Row  # int64 [cells]: the cell before it, -1: none
    keys: Row  # float64 [NEIGHBOURS * cells + 1]: scratch
    items: Row  # int64, likewise


@kernel
def search(field: Field, start: int, goal: int, found: Found) -> None:
    """Fill `found` with the cheapest ways from `start` to `goal`, or to every cell where the goal is -1."""
    for cell in range(len(field.cost)):
        found.best[cell] = NEVER
        found.before[cell] = -1
    found.best[start] = 0.0
    waiting = _pushed(found, 0, 0.0, start)
    while waiting > 0:
        key = found.keys[0]
        cell = found.items[0]
        waiting = _popped(found, waiting)
        if cell == goal:
            return
        so_far = found.best[cell]
        if key > so_far + _left(field, cell, goal):
            continue
        row = cell // field.columns
        column = cell - row * field.columns
        for down in range(-1, 2):
            for right in range(-1, 2):
                at_row = row + down
                at_column = column + right
                if at_row < 0 or at_column < 0 or at_row >= field.rows or at_column >= field.columns:
                    continue
                at = at_row * field.columns + at_column
                if at == cell or field.cost[at] >= NEVER:
                    continue
                way = _DIAGONAL if down != 0 and right != 0 else 1.0
                further = so_far + way * 0.5 * (field.cost[cell] + field.cost[at])
                if further < found.best[at]:
                    found.best[at] = further
                    found.before[at] = cell
                    waiting = _pushed(found, waiting, further + _left(field, at, goal), at)


@kernel
def _left(field: Field, cell: int, goal: int) -> float:
    """Return the least that the rest of the way can cost."""
    if goal < 0:
        return 0.0
    row = cell // field.columns
    goal_row = goal // field.columns
    up = goal_row - row
    right = goal - goal_row * field.columns - (cell - row * field.columns)
    return sqrt(float(up * up + right * right))


@kernel
def _pushed(found: Found, count: int, key: float, item: int) -> int:
    """Put an item into the heap of `count`; return how many there are."""
    place = count
    while place > 0:
        parent = (place - 1) // 2
        if found.keys[parent] <= key:
            break
        found.keys[place] = found.keys[parent]
        found.items[place] = found.items[parent]
        place = parent
    found.keys[place] = key
    found.items[place] = item
    return count + 1


@kernel
def _popped(found: Found, count: int) -> int:
    """Take the first item out of the heap of `count`; return how many are left."""
    left = count - 1
    key = found.keys[left]
    item = found.items[left]
    place = 0
    child = 1
    while child < left:
        if child + 1 < left and found.keys[child + 1] < found.keys[child]:
            child += 1
        if key <= found.keys[child]:
            break
        found.keys[place] = found.keys[child]
        found.items[place] = found.items[child]
        place = child
        child = 2 * place + 1
    found.keys[place] = key
    found.items[place] = item
    return left
