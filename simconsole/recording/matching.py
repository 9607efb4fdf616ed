"""Columns of two recordings, or of a recording and this version, matched by their names."""

from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.recording.log_header import LogHeader
from simconsole.values.errors import RecordingError
from simconsole.values.kernels import Row

RENAMED: Final[Mapping[str, str]] = {}
"""Names that columns had in earlier versions, to the names that they have now."""


class Matched(NamedTuple):
    """Which columns two state vectors have in common, and which only one of them has."""

    columns: tuple[str, ...]  # of both, by this version's name, in the order of the second
    first: NDArray[np.intp] | None  # where they stand in the first; None where both are the same throughout
    second: NDArray[np.intp] | None
    only_first: tuple[str, ...]
    only_second: tuple[str, ...]

    def of_first(self, vector: Row) -> Row:
        """Return the common columns of a state vector of the first."""
        return vector if self.first is None else vector[self.first]

    def of_second(self, vector: Row) -> Row:
        """Return the common columns of a state vector of the second."""
        return vector if self.second is None else vector[self.second]


def renamed(header: LogHeader, table: Mapping[str, str] = RENAMED) -> tuple[str, ...]:
    """Return the columns of a recording by the names that they have now.

    Raises:
        RecordingError: two of them would have one name.
    """
    columns = tuple(table.get(column, column) for column in header.columns)
    twice = next((column for at, column in enumerate(columns) if column in columns[:at]), None)
    if twice is not None:
        raise RecordingError(f"the recording has two columns {twice!r}")
    return columns


def matched(first: tuple[str, ...], second: tuple[str, ...]) -> Matched:
    """Match columns by name."""
    if first == second:
        return Matched(second, None, None, (), ())
    places = {column: at for at, column in enumerate(first)}
    common = [(column, places[column], at) for at, column in enumerate(second) if column in places]
    return Matched(
        columns=tuple(column for column, _, _ in common),
        first=np.array([at for _, at, _ in common], np.intp),
        second=np.array([at for _, _, at in common], np.intp),
        only_first=tuple(column for column in first if column not in second),
        only_second=tuple(column for column in second if column not in places),
    )
