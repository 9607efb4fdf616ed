"""The samples of coming ticks, for sources that know them: computed some hundred at a time. Pure."""

from collections.abc import Callable
from typing import Final

import numpy as np

from simconsole.values.kernels import Row
from simconsole.values.signals import DeviceSample

TICKS: Final = 256


class SampleTable:
    """A piece of the future, and the next one whenever a tick beyond its end is asked for."""

    def __init__(self, fill: Callable[[int, Row], None]) -> None:
        """Have `fill` write the samples from a tick on into rows, float64 [TICKS, fields of DeviceSample]."""
        self._fill = fill
        self._rows = np.empty((TICKS, len(DeviceSample._fields)))
        self._first: int | None = None

    def sample(self, tick: int) -> DeviceSample:
        """Return one sample."""
        return DeviceSample(*self._rows[self._at(tick)].tolist())

    def foresee(self, tick: int, samples: Row) -> int:
        """Write the samples from `tick` on into rows, as far as this piece goes; return how many."""
        at = self._at(tick)
        count = min(len(samples), TICKS - at)
        samples[:count] = self._rows[at : at + count]
        return count

    def _at(self, tick: int) -> int:
        if self._first is None or not self._first <= tick < self._first + TICKS:
            self._fill(tick, self._rows)
            self._first = tick
        return tick - self._first
