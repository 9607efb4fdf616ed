"""Goldens: the accepted result of a scripted drive, thinned to a readable table. Pure but for numpy.

A golden is CSV text: one line per sample, every column of the state vector, `repr` of each float (exact), and the
chained hash of the whole drive in the header. Equal hash means every bit of every tick is equal; otherwise the table
says where. It is written and compared line by line, while it is being driven: a drive may be of any length.
"""

import csv
from collections.abc import Iterable, Iterator
from typing import Final, NamedTuple

from simconsole.values.errors import ProfileError
from simconsole.values.kernels import Row

SCHEMA: Final = 1
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


class Comparison:
    """Compares a drive with its golden, sample by sample: the bits of the columns that both have."""

    def __init__(self, accepted: Golden, columns: tuple[str, ...]) -> None:
        self._samples = iter(accepted)
        self._next = next(self._samples, None)
        self._shared = [(at, columns.index(name)) for at, name in enumerate(accepted.columns) if name in columns]
        self._columns = accepted.columns
        self._driven = 0
        self._missing: int | None = None  # the first accepted tick that was not driven, before any other difference
        self._difference: Difference | None = None

    def see(self, tick: int, row: Row) -> None:
        """Look at the next sample that was driven. Raises ProfileError where the golden cannot be read."""
        self._driven += 1
        while self._next is not None and self._next[0] < tick:
            self._skip(self._next[0])
        if self._next is None or self._next[0] != tick:
            return
        values = self._next[1]
        self._next = next(self._samples, None)
        if self._missing is not None or self._difference is not None:
            return
        for at, now in self._shared:
            old, new = values[at], float(row[now])
            if old != new and not (old != old and new != new):
                self._difference = Difference(tick, self._columns[at], old, new)
                return

    def first_difference(self) -> Difference | None:
        """Return the first difference between the finished drive and its golden, None where there is none."""
        while self._next is not None:
            self._skip(self._next[0])
        if self._missing is not None:
            return Difference(self._missing, "tick", float(self._missing), float(self._driven))
        return self._difference

    def _skip(self, tick: int) -> None:
        if self._missing is None and self._difference is None:
            self._missing = tick
        self._next = next(self._samples, None)
