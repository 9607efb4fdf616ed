"""A drive as columns of its state vectors, read where they are asked for: a long one never lies in memory whole."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from simconsole.recording.reading import Recording
from simconsole.recording.recorded_advice import AdviceAt, recorded_advice
from simconsole.values.errors import RecordingError

Array = NDArray[np.float64]
Read = Callable[[Sequence[str]], Iterator[Array]]
"""Yields these columns of a drive in blocks [n, columns], in the order of the ticks; each call begins anew."""

IN_MEMORY: Final = 1 << 23
"""Values of a drive, 64 MiB of them, up to which `read_at_once` does."""


class Drive(NamedTuple):
    """A drive of which columns can be read; every method is one pass over it, or a part of one."""

    read: Read
    ticks: int
    tick_hz: int
    first_tick: int = 1
    names: frozenset[str] = frozenset()  # of its columns, where they are known
    advice: tuple[AdviceAt, ...] = ()  # what its driver was advised

    def column(self, name: str) -> Array:
        """Return one column, float64 [ticks].

        Raises:
            RecordingError: the drive has no such column.
        """
        return self.columns(name)[0]

    def columns(self, *names: str) -> tuple[Array, ...]:
        """Return columns, float64 [ticks] each.

        Raises:
            RecordingError: the drive has no such column.
        """
        found = tuple(np.empty(self.ticks) for _ in names)
        at = 0
        for block in self.read(names):
            for column, values in zip(found, block.T, strict=True):
                column[at : at + len(values)] = values
            at += len(block)
        return found

    def windows(self, names: Sequence[str], spans: Iterable[tuple[int, int]]) -> Iterator[dict[str, Array]]:
        """Yield these columns of parts of the drive, which are in memory one after the other.

        Args:
            names: Which columns.
            spans: First index and the one after the last of each part; neither falls from one part to the next.
        """
        parts = deque(spans)
        held: list[Array] = []
        start = end = 0  # of what is held
        for block in self.read(names) if parts else ():
            held.append(block)
            end += len(block)
            while parts and parts[0][1] <= end:
                first, after = parts.popleft()
                rows = np.concatenate(held)[first - start : after - start]
                yield dict(zip(names, rows.T, strict=True))
            if not parts:
                return
            while held and start + len(held[0]) <= parts[0][0]:
                start += len(held.pop(0))

    @property
    def time_s(self) -> Array:
        """Simulated time of every tick in s."""
        return (self.first_tick + np.arange(self.ticks)) / self.tick_hz


class Runs(NamedTuple):
    """Where a value stayed the same: `values[k]` from index `starts[k]` to before `ends[k]`."""

    starts: NDArray[np.int64]
    ends: NDArray[np.int64]
    values: NDArray[np.float64]


def runs(blocks: Iterable[NDArray[Any]]) -> Runs:
    """Return the runs of a value that comes in blocks [n]."""
    starts, values = [np.zeros(0, np.int64)], [np.zeros(0)]
    at, last = 0, np.zeros(0)
    for block in blocks:
        joined = np.concatenate((last, block))  # the first value of a drive has none before it, and begins a run
        begins = np.flatnonzero(joined[1:] != joined[:-1]) + 1 - len(last)
        begins = begins if at else np.insert(begins, 0, 0)
        starts.append(at + begins)
        values.append(block[begins].astype(np.float64))
        at, last = at + len(block), block[-1:]
    found = np.concatenate(starts)
    return Runs(found, np.append(found, at)[1:], np.concatenate(values))


def drive_of(vectors: ArrayLike, columns: Sequence[str], tick_hz: int, first_tick: int = 1) -> Drive:
    """Return a drive from its state vectors.

    Raises:
        RecordingError: it is empty, or its state vectors are not as wide as `columns`.
    """
    values = np.asarray(vectors, dtype=np.float64)
    if values.ndim != 2 or len(values) == 0:
        raise RecordingError("drive: 0 ticks: nothing to report")
    if values.shape[1] != len(columns):
        raise RecordingError(f"drive: state vectors of {values.shape[1]} columns, must be {len(columns)}")
    places = {name: at for at, name in enumerate(columns)}

    def read(names: Sequence[str]) -> Iterator[Array]:
        for name in names:
            if name not in places:
                raise RecordingError(f"drive: column {name} is missing: not a recording of this version")
        yield values[:, [places[name] for name in names]]

    return Drive(read, len(values), tick_hz, first_tick, frozenset(columns))


def recorded_drive(recording: Recording, told: Callable[[float], object] = lambda passes: None) -> Drive:
    """Return a recorded drive; each of its passes is one over the recording.

    Args:
        recording: The drive, in whatever form. It may grow meanwhile: what comes later is not looked at.
        told: Called with the number of passes made so far, a part of one included; the first one counts the ticks.

    Raises:
        RecordingError: it is empty, or what it has of speed advice is none.
    """
    ticks, first, passes = 0, 1, 1
    for block in recording.blocks(()):
        first = int(block.ticks[0]) if not ticks else first
        ticks += len(block.ticks)
    if not ticks:
        raise RecordingError("drive: 0 ticks: nothing to report")
    told(passes)

    def read(names: Sequence[str]) -> Iterator[Array]:
        nonlocal passes
        before, passes, done = passes, passes + 1, 0
        for block in recording.blocks(names):
            part = block.vectors[: ticks - done]
            done += len(part)
            told(before + done / ticks)
            yield part
            if done == ticks:
                break
        if done < ticks:
            raise RecordingError(f"drive: only {done} of its {ticks} ticks were there when it was read again")

    advice = tuple(recorded_advice(recording))
    return Drive(
        read=read,
        ticks=ticks,
        tick_hz=recording.header.tick_hz,
        first_tick=first,
        names=frozenset(recording.header.columns),
        advice=advice,
    )


def read_at_once(recording: Recording, ticks: int) -> Drive:
    """Return a recorded drive of so many ticks: in memory if it is short, for what reads it many times, as metrics do.

    Raises:
        RecordingError: as `recorded_drive`.
    """
    if ticks * len(recording.header.columns) > IN_MEMORY:
        return recorded_drive(recording)
    held = recording.table()  # one pass: `recorded_drive` makes one more, to count the ticks
    drive = drive_of(held.vectors[:ticks], held.columns, held.tick_hz, int(held.ticks[0]) if len(held.ticks) else 1)
    return drive._replace(advice=tuple(recorded_advice(recording)))
