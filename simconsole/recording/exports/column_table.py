"""Columns of a recorded drive as a table for other tools: which ones, how often, in which units, in which words."""

from collections.abc import Callable, Iterator
from fnmatch import fnmatchcase
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.recording.exports.drive_topics import OnTick
from simconsole.recording.reading import Block, Recording
from simconsole.values.errors import RecordingError
from simconsole.values.labels import (
    commander_label,
    gear_label,
    indicator_label,
    link_label,
    mode_label,
    notice_label,
    reason_label,
    validity_label,
)
from simconsole.values.units import displayed, unit_of

TICK: Final = "tick"
TIME: Final = "time_s"
LABELLED: Final[dict[str, Callable[[float], str]]] = {
    "mode": mode_label,
    "reason": reason_label,
    "refusal": reason_label,
    "notice": notice_label,
    "commander": commander_label,
    "state": link_label,
    "gear": gear_label,
    "turn_indicators": indicator_label,
    "wheel_validity": validity_label,
    "throttle_validity": validity_label,
    "brake_validity": validity_label,
    "clutch_validity": validity_label,
    "shifter_validity": validity_label,
    "handbrake_validity": validity_label,
}
"""Enumerations by the field's name, and what people read for a value."""


class TableChoice(NamedTuple):
    """What of a drive becomes a table.

    `columns` are names, * and ? as in file names; `rate_hz` thins the ticks, None keeps all; `display` turns radians
    into degrees and metres per second into kilometres per hour; `labels` writes enumerations as words.
    """

    columns: tuple[str, ...] = ("*",)
    rate_hz: float | None = None
    display: bool = False
    labels: bool = False


class TableColumn(NamedTuple):
    """One column of the table: `source` is the recording's name of it, empty for tick and time."""

    name: str
    unit: str
    kind: type[int] | type[float] | type[str]
    source: str = ""
    factor: float = 1.0
    label: Callable[[float], str] | None = None


class ColumnTable:
    """The chosen table, read block by block.

    Attributes:
        columns: tick and time first, then the chosen ones in the recording's order.
    """

    def __init__(self, recording: Recording, choice: TableChoice) -> None:
        """Find the columns.

        Raises:
            RecordingError: a pattern that fits no column, or a rate that is none; names what is allowed.
        """
        header = recording.header
        self._recording = recording
        self._rate_hz = choice.rate_hz
        self._tick_hz = header.tick_hz
        if choice.rate_hz is not None and not 0.0 < choice.rate_hz <= header.tick_hz:
            raise RecordingError(f"--rate: value {choice.rate_hz:g}: above 0 to {header.tick_hz}, the drive's ticks")
        for pattern in choice.columns:
            if not any(fnmatchcase(name, pattern) for name in header.columns):
                stages = dict.fromkeys(name.partition(".")[0] for name in header.columns)
                raise RecordingError(f"--columns: value {pattern!r}: fits no column of {', '.join(stages)}")
        chosen = [name for name in header.columns if any(fnmatchcase(name, pattern) for pattern in choice.columns)]
        self.columns = (
            TableColumn(TICK, "ticks", int),
            TableColumn(TIME, unit_of(TIME), float),
            *(_column(name, choice) for name in chosen),
        )

    def blocks(self, on_tick: OnTick = lambda tick: None) -> Iterator[list[Any]]:
        """Yield arrays (of text: lists), one for each column, block by block; memory does not grow with the drive."""
        read = [column.source for column in self.columns if column.source]
        for block in self._recording.blocks(read):
            kept = self._kept(block)
            if len(kept.ticks):
                yield self._values(kept)
            on_tick(int(block.ticks[-1]))

    def _kept(self, block: Block) -> Block:
        """Return the ticks that are due at the rate: as for topics, the phase hangs on the tick's number alone."""
        if self._rate_hz is None:
            return block
        per_tick = self._rate_hz / self._tick_hz
        due = np.floor(block.ticks * per_tick) > np.floor((block.ticks - 1) * per_tick)
        return Block(block.ticks[due], block.vectors[due])

    def _values(self, block: Block) -> list[Any]:
        chosen = [column for column in self.columns if column.source]
        values = [_shown(column, block.vectors[:, index]) for index, column in enumerate(chosen)]
        return [block.ticks, block.ticks / self._tick_hz, *values]


def _column(name: str, choice: TableChoice) -> TableColumn:
    label = LABELLED.get(name.partition(".")[2]) if choice.labels else None
    if label is not None:
        return TableColumn(f"{name}_label", unit_of(""), str, name, label=label)
    shown, factor = displayed(name) if choice.display else (name, 1.0)
    return TableColumn(shown, unit_of(shown), float, name, factor)


def _shown(column: TableColumn, values: NDArray[np.float64]) -> Any:
    if column.label is None:
        return values if column.factor == 1.0 else values * column.factor
    found, places = np.unique(values, return_inverse=True)
    words = [column.label(float(value)) for value in found]
    return [words[place] for place in places]
