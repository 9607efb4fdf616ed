"""The fields that differ between two drives: since when, how far, how often, and the ticks around the first time.

What is kept does not grow with the drives: a few numbers for each field, and the ticks around its first difference.
"""

import math
from collections import deque
from collections.abc import Mapping
from fnmatch import fnmatchcase
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.errors import RecordingError
from simconsole.values.kernels import Row
from simconsole.values.units import unit_of

CONTEXT_TICKS: Final = 3
"""Ticks shown before and after the first one that differs."""


class FieldDifference(NamedTuple):
    """A field that differs by more than its tolerance, all values in its unit."""

    field: str
    unit: str
    first_tick: int
    largest: float  # of all absolute differences; inf where one of the two is no number
    largest_tick: int
    ticks: int  # in how many it differs
    around: tuple[tuple[int, float, float], ...]  # tick, first and second value, up to CONTEXT_TICKS on both sides

    @property
    def values(self) -> tuple[float, float]:
        """The two values in the first tick that differs."""
        return next((first, second) for tick, first, second in self.around if tick == self.first_tick)


class Differences:
    """Collects what differs, tick by tick."""

    def __init__(self, columns: tuple[str, ...], allowed: Row) -> None:
        """Compare vectors of `columns`; `allowed` is each one's tolerance, as of `allowed_differences`."""
        self._columns = columns
        self._allowed = allowed
        self._exact = not allowed.any()
        self._before: deque[tuple[int, Row, Row]] = deque(maxlen=CONTEXT_TICKS)
        self._ticks = np.zeros(len(columns), np.int64)
        self._first_tick = np.zeros(len(columns), np.int64)
        self._largest = np.full(len(columns), -1.0)
        self._largest_tick = np.zeros(len(columns), np.int64)
        self._around: dict[int, list[tuple[int, float, float]]] = {}
        self._open: list[int] = []  # fields whose first difference lies at most CONTEXT_TICKS back

    def add(self, tick: int, first: Row, second: Row) -> None:
        """Compare one tick; neither vector may be changed afterwards."""
        for index in self._open:
            self._around[index].append((tick, float(first[index]), float(second[index])))
        if self._open:
            self._open = [index for index in self._open if tick - self._first_tick[index] < CONTEXT_TICKS]
        unequal = first.view(np.uint64) != second.view(np.uint64)
        if unequal.any():
            self._note(tick, first, second, unequal)
        self._before.append((tick, first, second))

    def found(self) -> tuple[FieldDifference, ...]:
        """Return all fields that differ, those that differ first in front."""
        order = sorted(self._around, key=lambda index: (int(self._first_tick[index]), index))
        return tuple(
            FieldDifference(
                field=self._columns[index],
                unit=unit_of(self._columns[index]),
                first_tick=int(self._first_tick[index]),
                largest=float(self._largest[index]),
                largest_tick=int(self._largest_tick[index]),
                ticks=int(self._ticks[index]),
                around=tuple(self._around[index]),
            )
            for index in order
        )

    def _note(self, tick: int, first: Row, second: Row, unequal: NDArray[np.bool_]) -> None:
        with np.errstate(invalid="ignore", over="ignore"):
            change = np.abs(first - second)
        change[np.isnan(change)] = np.inf  # a NaN, or two infinities: equal ones have equal bytes
        if not self._exact:
            unequal &= (self._allowed == 0.0) | (change > self._allowed)
        fields = np.flatnonzero(unequal)
        for index in fields[self._ticks[fields] == 0].tolist():
            self._first_tick[index] = tick
            self._around[index] = [(at, float(left[index]), float(right[index])) for at, left, right in self._before]
            self._around[index].append((tick, float(first[index]), float(second[index])))
            self._open.append(index)
        self._ticks[fields] += 1
        larger = fields[change[fields] > self._largest[fields]]
        self._largest[larger] = change[larger]
        self._largest_tick[larger] = tick


def allowed_differences(columns: tuple[str, ...], tolerances: Mapping[str, float]) -> Row:
    """Return the tolerance of each column: 0 for equal to the byte, inf for one that may differ as it likes.

    Args:
        columns: names.
        tolerances: column or pattern (`platform.*`) to an absolute difference in the column's unit; the last match
            counts.

    Raises:
        RecordingError: a pattern fits no column, or its tolerance is below 0 or NaN.
    """
    allowed = np.zeros(len(columns))
    for pattern, tolerance in tolerances.items():
        if math.isnan(tolerance) or tolerance < 0.0:
            raise RecordingError(f"tolerances: {pattern}: value {tolerance}: 0 or more")
        fits = [fnmatchcase(column, pattern) for column in columns]
        if not any(fits):
            raise RecordingError(f"tolerances: {pattern}: no field of both has such a name")
        allowed[fits] = tolerance
    return allowed
