"""Goldens: the accepted result of a scripted drive, thinned to a readable table. Pure but for numpy.

A golden is CSV text: one line per sample, every column of the state vector, `repr` of each float (exact), and the
chained hash of the whole drive in the header. Equal hash means every bit of every tick is equal; otherwise the table
says where. It is written and compared line by line, while it is being driven: a drive may be of any length.
"""

import csv
import math
from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from typing import Final, NamedTuple

import numpy as np

from simconsole.profiles.scenario import Tolerance
from simconsole.values.errors import ProfileError
from simconsole.values.kernels import Row

SCHEMA: Final = 1
SHOWN: Final = 10
"""Columns that differ, as many as a person is shown."""
Sample = tuple[int, tuple[float, ...]]
"""A tick and its state vector."""


class Difference(NamedTuple):
    """The first sample that differs from its golden."""

    tick: int
    column: str
    accepted: float
    driven: float


def step_ticks(tick_hz: int, rate_hz: int) -> int:
    """Return how many ticks lie between two samples; the first is the tick of this number."""
    return max(1, tick_hz // rate_hz)


def head(digest: str, tick_hz: int, columns: tuple[str, ...]) -> str:
    """Return the first two lines; their length depends on the columns only, so they can be overwritten at the end."""
    return f"# simconsole golden schema {SCHEMA} tick_hz {tick_hz} hash {digest}\n{','.join(('tick', *columns))}\n"


def line(tick: int, row: Row) -> str:
    """Return the line of one sample."""
    return f"{tick},{','.join(map(repr, row.tolist()))}\n"


class Golden:
    """An accepted drive. Iterating reads its samples, once.

    Attributes:
        hash: the chained hash of the whole drive.
        tick_hz: ticks per second.
        columns: of a state vector.
    """

    def __init__(self, lines: Iterable[str], name: str) -> None:
        """Read the head.

        Raises:
            ProfileError: the text is not a golden of this schema; the message names `name` and the line.
        """
        rest = iter(lines)
        words = next(rest, "").split()
        if len(words) != 9 or words[:4] != ["#", "simconsole", "golden", "schema"] or words[4] != str(SCHEMA):
            raise ProfileError(f"{name}: line 1: not a golden of schema {SCHEMA}")
        self.hash, self.tick_hz = words[8], int(words[6])
        self._rows = csv.reader(rest)
        self.columns = tuple(next(self._rows, ["tick"])[1:])
        self._name = name

    def __iter__(self) -> Iterator[Sample]:
        """Yield the samples in order.

        Raises:
            ProfileError: a line is not one number for each column; the message names file and line.
        """
        for number, row in enumerate(self._rows, start=3):
            try:
                sample = int(row[0]), tuple(float(value) for value in row[1:])
            except (ValueError, IndexError):
                raise ProfileError(f"{self._name}: line {number}: a value is not a number") from None
            if len(sample[1]) != len(self.columns):
                raise ProfileError(f"{self._name}: line {number}: {len(row)} values, not {len(self.columns) + 1}")
            yield sample


class ColumnDifference(NamedTuple):
    """A column that differs: where first, and where most."""

    first: Difference
    largest: float  # absolute; inf where one of the two is no number
    largest_tick: int


class Comparison:
    """Compares a drive with its golden, sample by sample: the columns that both have.

    Equal is what has equal bits, or is as near as the column's tolerance allows.

    Attributes:
        compared: samples of both.
        unaccepted: the first tick that was driven and has no sample in the golden; None: there is none.
    """

    def __init__(self, accepted: Golden, columns: tuple[str, ...], tolerances: Sequence[Tolerance] = ()) -> None:
        self._samples = iter(accepted)
        self._next = next(self._samples, None)
        absolute, relative = _allowed(accepted.columns, tolerances)
        shared = [at for at, name in enumerate(accepted.columns) if name in columns and absolute[at] < math.inf]
        self._old, self._now = shared, [columns.index(accepted.columns[at]) for at in shared]
        self._absolute, self._relative = absolute[shared], relative[shared]
        self._columns = accepted.columns
        self.compared = 0
        self.unaccepted: int | None = None
        self._driven = 0
        self._missing: int | None = None  # the first accepted tick that was not driven, before any other difference
        self._found: dict[int, ColumnDifference] = {}

    def see(self, tick: int, row: Row) -> None:
        """Look at the next sample that was driven. Raises ProfileError where the golden cannot be read."""
        self._driven += 1
        while self._next is not None and self._next[0] < tick:
            self._skip(self._next[0])
        if self._next is None or self._next[0] != tick:
            self.unaccepted = self.unaccepted or tick
            return
        self.compared += 1
        old = np.array(self._next[1])[self._old]
        self._next = next(self._samples, None)
        new = np.asarray(row)[self._now]
        unequal = (old != new) & ~((old != old) & (new != new))
        if self._missing is None and unequal.any():
            self._note(tick, old, new, np.flatnonzero(unequal).tolist())

    def first_difference(self) -> Difference | None:
        """Return the first difference between the finished drive and its golden, None where there is none."""
        while self._next is not None:
            self._skip(self._next[0])
        if self._missing is not None:
            return Difference(self._missing, "tick", float(self._missing), float(self._driven))
        found = self.differences()
        return found[0].first if found else None

    def differences(self) -> list[ColumnDifference]:
        """Return the columns that differ, by where they do so first."""
        return [self._found[at] for at in sorted(self._found, key=lambda at: (self._found[at].first.tick, at))]

    def _note(self, tick: int, old: Row, new: Row, places: list[int]) -> None:
        for at in places:
            apart = abs(new[at] - old[at])
            apart = apart if math.isfinite(apart) else math.inf
            if apart <= self._absolute[at] + self._relative[at] * abs(old[at]):
                continue
            known = self._found.get(at)
            if known is None:
                column = self._columns[self._old[at]]
                first = Difference(tick, column, float(old[at]), float(new[at]))
                self._found[at] = ColumnDifference(first, float(apart), tick)
            elif apart > known.largest:
                self._found[at] = known._replace(largest=float(apart), largest_tick=tick)

    def _skip(self, tick: int) -> None:
        if self._missing is None and not self._found:
            self._missing = tick
        self._next = next(self._samples, None)


def readable(found: Sequence[ColumnDifference], tick_hz: int) -> list[str]:
    """Return differences as lines of a table, those that come first, and how many more there are."""
    if not found:
        return []
    names = max(len("column"), *(len(one.first.column) for one in found[:SHOWN]))
    lines = [f"{'column':{names}}  {'from':>9}  {'accepted':>12}  {'driven':>12}  {'at most':>10}  {'at':>9}"]
    for first, largest, tick in found[:SHOWN]:
        lines.append(
            f"{first.column:{names}}  {first.tick / tick_hz:7.3f} s  {first.accepted:12.6g}  {first.driven:12.6g}"
            f"  {largest:10.3g}  {tick / tick_hz:7.3f} s"
        )
    more = len(found) - SHOWN
    return [*lines, f"and {more} more columns"] if more > 0 else lines


def _allowed(columns: Sequence[str], tolerances: Sequence[Tolerance]) -> tuple[Row, Row]:
    """Return how far each column may be from its golden, absolutely and as a share of it."""
    absolute, relative = np.zeros(len(columns)), np.zeros(len(columns))
    for one in tolerances:
        for at, name in enumerate(columns):
            if fnmatchcase(name, one.columns):
                absolute[at], relative[at] = math.inf if one.ignore else one.absolute, one.relative
    return absolute, relative
