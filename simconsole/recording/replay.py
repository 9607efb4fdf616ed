"""Replay: make every tick again from its recorded inputs and ask for the same bytes."""

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from simconsole.recording.framing import START_OF_CHAIN, Record, chain
from simconsole.recording.log_header import LogHeader
from simconsole.values.errors import RecordingError
from simconsole.values.kernels import Row

AdvanceVector = Callable[[int, Row, Row], Row]
"""`advance(tick, previous, inputs)` makes the state vector of `tick` from the one before it and recorded inputs."""


class Difference(NamedTuple):
    """Where two vectors first differ. `field` is a column, or 'hash' where only the recorded hash does not fit."""

    tick: int
    field: str
    recorded: float
    replayed: float

    def __str__(self) -> str:
        """One line for a person."""
        if self.field == "hash":
            return f"tick {self.tick}: the state vector is equal, but the recorded hash does not belong to it"
        return f"tick {self.tick}: {self.field}: recorded {self.recorded!r}, replayed {self.replayed!r}"


class ReplayResult(NamedTuple):
    """What a replay found: `equal` only if every recorded tick gave the same bytes and the same hash."""

    equal: bool
    ticks: int  # compared and found equal
    difference: Difference | None
    digest: bytes  # chained hash of the replayed state vectors
    problems: tuple[str, ...] = ()  # why equal ticks are not a whole drive: a recording that failed, a damaged log
    remarks: tuple[str, ...] = ()  # worth knowing, but no problem: a torn last tick, other sources

    @property
    def good(self) -> bool:
        """Whether this is a success: the recording is complete, and every tick is equal."""
        return self.equal and not self.problems


def replay(
    records: Iterable[Record],
    header: LogHeader,
    columns: tuple[str, ...],
    initial: Row,
    advance: AdvanceVector,
    first_tick: int | None = None,
    recorded_ticks: int | None = None,
) -> ReplayResult:
    """Make every state vector of `records` again from its first `header.input_columns` columns and compare the bytes.

    Args:
        records: the recorded ticks, in order and without gaps (a `LogReader`).
        header: of the recording.
        columns: of the state vectors that `advance` makes; must be the recorded ones.
        initial: the state vector before the first recorded tick.
        advance: see `AdvanceVector`.
        first_tick: the tick after `initial`, where the caller knows it.
        recorded_ticks: how many ticks were recorded, where the drive was finished and said so.

    Returns:
        The result, up to and including the first differing tick.

    Raises:
        RecordingError: the recording has other columns, its ticks have a gap, or all are equal but some are gone.
    """
    if header.columns != columns:
        unlike = next((pair for pair in zip(header.columns, columns, strict=False) if pair[0] != pair[1]), None)
        detail = f"{unlike[0]!r} where this version has {unlike[1]!r}" if unlike else "another number of columns"
        raise RecordingError(f"the recording's columns are not this version's: {detail}")
    vector, digest, ticks, expected = initial, START_OF_CHAIN, 0, first_tick
    for record in records:
        if expected is not None and record.tick != expected:
            raise RecordingError(f"the recording cannot be replayed from tick {expected} on: it is missing")
        inputs = record.vector[: header.input_columns].copy()  # to numba a read-only view is another type
        vector = advance(record.tick, vector, inputs)
        digest = chain(digest, record.tick, vector.tobytes())
        if (field := first_unequal(record.vector, vector)) is not None:
            found = Difference(record.tick, columns[field], float(record.vector[field]), float(vector[field]))
            return ReplayResult(False, ticks, found, digest)
        if digest != record.digest:
            return ReplayResult(False, ticks, Difference(record.tick, "hash", math.nan, math.nan), digest)
        ticks, expected = ticks + 1, record.tick + 1
    if recorded_ticks is not None and ticks != recorded_ticks:
        raise RecordingError(f"the recording is not whole: {ticks} of {recorded_ticks} ticks could be replayed")
    return ReplayResult(True, ticks, None, digest)


def first_unequal(left: Row, right: Row) -> int | None:
    """Return the index of the first value whose bytes differ (0.0 and -0.0 differ, equal NaNs do not), or None."""
    if left.tobytes() == right.tobytes():
        return None
    return int(np.flatnonzero(left.view(np.uint64) != right.view(np.uint64))[0])
