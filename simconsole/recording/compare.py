"""Compare two recordings: the first differing tick and field, with a small readable window around it."""

import math
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from fnmatch import fnmatchcase
from itertools import islice, zip_longest
from typing import Final, NamedTuple

import numpy as np

from simconsole.recording.framing import Record
from simconsole.recording.log_header import LogHeader
from simconsole.values.kernels import Row

CONTEXT_TICKS: Final = 3
SHOWN_FIELDS: Final = 6


class FieldDifference(NamedTuple):
    """One value that differs by more than its tolerance."""

    tick: int
    field: str
    first: float
    second: float

    def __str__(self) -> str:
        """One line for a person."""
        return f"tick {self.tick}: {self.field}: {self.first!r} and {self.second!r}"


class Comparison(NamedTuple):
    """What a comparison found."""

    equal: bool
    ticks: int  # compared and found equal
    difference: FieldDifference | None
    window: str  # text around the difference, or why the recordings cannot be compared; empty if equal


Pair = tuple[Record | None, Record | None]


def compare(
    first: Iterable[Record],
    first_header: LogHeader,
    second: Iterable[Record],
    second_header: LogHeader,
    tolerances: Mapping[str, float] | None = None,
) -> Comparison:
    """Compare two recordings tick by tick.

    Args:
        first: ticks of the one recording (a `LogReader`).
        first_header: its header.
        second: ticks of the other.
        second_header: its header.
        tolerances: column name or pattern (`platform.*`) to the absolute difference allowed, in the column's unit;
            the last match counts. Columns without one must be equal to the byte; `inf` ignores a column.

    Returns:
        The first tick that differs, and its first differing column in the order of the state vector.
    """
    for key in ("columns", "tick_hz"):
        if getattr(first_header, key) != getattr(second_header, key):
            return Comparison(False, 0, None, f"the recordings have different {key} and cannot be compared")
    columns = first_header.columns
    allowed = _allowed(columns, tolerances or {})
    before: deque[Pair] = deque(maxlen=CONTEXT_TICKS)
    pairs: Iterator[Pair] = zip_longest(first, second)
    ticks = 0
    for left, right in pairs:
        if left is None or right is None or left.tick != right.tick:
            return Comparison(False, ticks, None, f"after {ticks} equal ticks: {_name(left)} against {_name(right)}")
        if fields := unequal_fields(left.vector, right.vector, allowed):
            index = fields[0]
            found = FieldDifference(left.tick, columns[index], float(left.vector[index]), float(right.vector[index]))
            around = [*before, (left, right), *islice(pairs, CONTEXT_TICKS)]
            return Comparison(False, ticks, found, _window(around, columns, fields, left.tick))
        before.append((left, right))
        ticks += 1
    return Comparison(True, ticks, None, "")


def unequal_fields(left: Row, right: Row, allowed: Row) -> list[int]:
    """Return the indices of values that differ by more than `allowed` (0: to the byte; NaN equals the same NaN)."""
    differs = left.view(np.uint64) != right.view(np.uint64)
    if not differs.any():
        return []
    with np.errstate(invalid="ignore"):
        beyond = ~(np.abs(left - right) <= allowed) & ~np.isinf(allowed)
    return [int(index) for index in np.flatnonzero(differs & (beyond | (allowed == 0.0)))]


def _allowed(columns: tuple[str, ...], tolerances: Mapping[str, float]) -> Row:
    allowed = np.zeros(len(columns))
    for pattern, tolerance in tolerances.items():
        if math.isnan(tolerance) or tolerance < 0.0:
            raise ValueError(f"tolerance of {pattern!r} is {tolerance}, not 0 or more")
        for index, column in enumerate(columns):
            if fnmatchcase(column, pattern):
                allowed[index] = tolerance
    return allowed


def _name(record: Record | None) -> str:
    return "the end" if record is None else f"tick {record.tick}"


def _window(around: Iterable[Pair], columns: tuple[str, ...], fields: list[int], tick: int) -> str:
    """Draw the differing columns over the ticks around `tick`, first recording above second."""
    pairs = [(left, right) for left, right in around if left is not None and right is not None]
    head = " " * 10 + "".join(f"{('>' if left.tick == tick else '') + str(left.tick):>14}" for left, _ in pairs)
    lines = [head]
    for index in fields[:SHOWN_FIELDS]:
        lines.append(columns[index])
        lines.append("  first   " + "".join(f"{left.vector[index]:>14.6g}" for left, _ in pairs))
        lines.append("  second  " + "".join(f"{right.vector[index]:>14.6g}" for _, right in pairs))
        changes = (right.vector[index] - left.vector[index] for left, right in pairs)
        lines.append("  change  " + "".join(f"{change:>14.3g}" for change in changes))
    if len(fields) > SHOWN_FIELDS:
        lines.append(f"and {len(fields) - SHOWN_FIELDS} more columns at tick {tick}")
    return "\n".join(lines)
