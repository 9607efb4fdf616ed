"""Latency statistics: how long each hop takes on the way from a hand on the wheel to its torque and its picture.

Stamps are wall-clock: they stay out of the state vectors, so that equal drives stay equal bytes, and end as
percentiles in the bundle's manifest and in the report. Pure: the clock comes in.
"""

import math
from collections.abc import Callable
from enum import StrEnum
from typing import Final

import numpy as np

from simconsole.values.signals import NEVER_TICKS, DeviceSample
from simconsole.values.units import NS_PER_S

_BINS_PER_DECADE: Final = 20
_DECADES: Final = 7  # 100 ns to 1 s
_FLOOR_NS: Final = 100.0


class Hop(StrEnum):
    """The hops in the order of a tick. Each is counted from the end of the one before it."""

    DEVICE = "device"  # from the device's own stamp to its reading, as far as the source knows: in whole ticks
    READ = "read"  # the devices
    TAKE = "take"  # commands and events
    DECIDE = "decide"
    STEP = "step"
    FORCE_FEEDBACK = "force feedback"  # what the wheel's torque shall be
    RECORD = "record"
    TORQUE = "torque out"  # handed to the wheel's driver
    PUBLISH = "publish"  # in shared memory
    EXCHANGE = "exchange"  # in lockstep: published, and the controller's answer waited for
    OTHERS = "others"  # readers of snapshots without a hop of their own
    RECEIVE = "receive"  # by a worker, since it was in shared memory
    DRAW = "draw"  # on the screen, since it was received


class Histogram:
    """Times in logarithmic bins: percentiles of any length of drive in constant memory, to 12 %."""

    def __init__(self) -> None:
        self._bins = [0] * (_BINS_PER_DECADE * _DECADES + 1)
        self._edges = _FLOOR_NS * 10.0 ** (np.arange(len(self._bins)) / _BINS_PER_DECADE)
        self.count = 0
        self.max_ns = 0

    def add(self, time_ns: int) -> None:
        """Count one time; a negative one counts as zero."""
        index = 0
        if time_ns > _FLOOR_NS:  # logarithm and ceiling: takes a tenth of the time of a search in the edges
            index = min(math.ceil(_BINS_PER_DECADE * math.log10(time_ns / _FLOOR_NS)), len(self._bins) - 1)
        self._bins[index] += 1
        self.count += 1
        self.max_ns = max(self.max_ns, time_ns)

    def percentile_ns(self, percent: float) -> float:
        """Return the upper edge of the bin that holds this percentile, at most the largest time; 0 without times."""
        if not self.count:
            return 0.0
        passed = np.cumsum(self._bins)
        index = int(np.searchsorted(passed, percent / 100.0 * self.count))
        if index == len(self._bins) - 1:
            return float(self.max_ns)  # the last bin has no upper edge
        return min(float(self._edges[index]), float(self.max_ns))

    def summary_us(self) -> dict[str, float]:
        """Return p50, p99 and maximum in us."""
        return {
            "p50": self.percentile_ns(50.0) / 1e3,
            "p99": self.percentile_ns(99.0) / 1e3,
            "max": self.max_ns / 1e3,
        }


Mark = Callable[[Hop], None]
"""Called when a hop has ended."""


def unheard(hop: Hop) -> None:
    """Ignore the end of a hop: the mark of a tick that is not timed."""


class LatencyStatistics:
    """Times of the hops of one process."""

    def __init__(self, clock_ns: Callable[[], int], tick_hz: int = 1, every: int = 1) -> None:
        """Begin with empty histograms.

        Args:
            clock_ns: A monotonic clock, the same in all processes of a drive.
            tick_hz: The session's tick rate.
            every: Look at each n-th tick only: in a drive that is not paced timing every tick would slow it.
        """
        self._clock_ns = clock_ns
        self._ns_per_tick = NS_PER_S // tick_hz
        self._every = every
        self._last_ns = 0
        self._looks = True
        self._histograms: dict[Hop, Histogram] = {}

    def begin(self, tick: int) -> Mark:
        """Begin a tick; return the function to call at the end of each of its hops."""
        self._looks = tick % self._every == 0
        if not self._looks:
            return unheard
        self._last_ns = self._clock_ns()
        return self.mark

    def unseen(self, tick: int) -> int:
        """Return how many ticks, from `tick` on, are not looked at."""
        return -tick % self._every

    def mark(self, hop: Hop) -> None:
        """Count the time since the last hop ended."""
        now_ns = self._clock_ns()
        self.add(hop, now_ns - self._last_ns)
        self._last_ns = now_ns

    def sample(self, sample: DeviceSample) -> None:
        """Count how old a reading was: that of the wheel, or of the pedals where there is no wheel."""
        for age_ticks in (sample.wheel_age_ticks, sample.pedals_age_ticks):
            if self._looks and age_ticks < NEVER_TICKS:
                self.add(Hop.DEVICE, int(age_ticks) * self._ns_per_tick)
                return

    def received(self, stamp_ns: int) -> None:
        """Count the time since another process's hop ended at `stamp_ns`; the next hop begins now."""
        self._last_ns = stamp_ns
        self.mark(Hop.RECEIVE)

    def add(self, hop: Hop, time_ns: int) -> None:
        """Count one time of one hop."""
        histogram = self._histograms.get(hop)
        if histogram is None:
            histogram = self._histograms[hop] = Histogram()
        histogram.add(time_ns)

    def summary_us(self) -> dict[str, dict[str, float]]:
        """Return p50, p99, maximum in us and the count of every hop that there was, in order."""
        return {
            str(hop): {**self._histograms[hop].summary_us(), "count": self._histograms[hop].count}
            for hop in Hop
            if hop in self._histograms
        }
