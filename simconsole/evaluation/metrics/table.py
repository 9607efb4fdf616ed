"""A drive as columns: what the report reads from recorded state vectors."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from simconsole.values.errors import RecordingError

Array = NDArray[np.float64]


class Drive(NamedTuple):
    """State vectors of a drive, one per tick from `first_tick`, with their column names (`state_vector.columns`)."""

    vectors: Array  # [ticks, columns]
    places: dict[str, int]  # of each column
    tick_hz: int
    first_tick: int = 1

    def column(self, name: str) -> Array:
        """Return one column, float64 [ticks].

        Raises RecordingError when the drive has no such column.
        """
        if name not in self.places:
            raise RecordingError(f"drive: column {name} is missing: not a recording of this version")
        return self.vectors[:, self.places[name]]

    @property
    def time_s(self) -> Array:
        """Simulated time of every tick in s."""
        return (self.first_tick + np.arange(len(self.vectors))) / self.tick_hz


def drive_of(vectors: ArrayLike, columns: Sequence[str], tick_hz: int, first_tick: int = 1) -> Drive:
    """Return a drive from its state vectors.

    Raises RecordingError when it is empty or its state vectors are not as wide as `columns`.
    """
    values = np.asarray(vectors, dtype=np.float64)
    if values.ndim != 2 or len(values) == 0:
        raise RecordingError("drive: 0 ticks: nothing to report")
    if values.shape[1] != len(columns):
        raise RecordingError(f"drive: state vectors of {values.shape[1]} columns, must be {len(columns)}")
    return Drive(values, {name: at for at, name in enumerate(columns)}, tick_hz, first_tick)
