"""The inputs of coming ticks, for sources that know them: made some hundred at a time, given one by one or at once."""

from collections.abc import Callable
from typing import Final

import numpy as np

from simconsole.values.kernels import Row

TICKS: Final = 256


class InputTable:
    """A piece of the future, and the next one whenever a tick beyond its end is asked for. Time only goes forward."""

    def __init__(self, width: int, fill: Callable[[int, Row], None]) -> None:
        """Have `fill` write the inputs from a tick on into rows, float64 [TICKS, width]."""
        self._fill = fill
        self._rows = np.empty((TICKS, width))
        self._first: int | None = None

    def values(self, tick: int) -> list[float]:
        """Return the inputs of one tick."""
        values: list[float] = self._rows[self._at(tick)].tolist()
        return values

    def foresee(self, tick: int, rows: Row) -> int:
        """Write the inputs from `tick` on into rows, as far as this piece goes; return how many."""
        at = self._at(tick)
        count = min(len(rows), TICKS - at)
        rows[:count] = self._rows[at : at + count]
        return count

    def _at(self, tick: int) -> int:
        if self._first is None or not self._first <= tick < self._first + TICKS:
            self._fill(tick, self._rows)
            self._first = tick
        return tick - self._first
