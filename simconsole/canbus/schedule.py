"""When each message is due: absolute deadlines on ticks, so that lateness does not add up and no thread keeps time.

Deadline k of a message is the first tick at or after `k * period`: at 250 Hz a 100 Hz message leaves at ticks 0, 3, 5,
8, 10: exactly 100 a second. A reader that skipped ticks sends once, not for every deadline it missed.
"""

from collections.abc import Sequence
from typing import Final

_MS_PER_S = 1000


class Schedule:
    """Deadlines of several messages.

    Attributes:
        missed: by message, deadlines that passed unserved because ticks were skipped.
    """

    def __init__(self, periods_ms: Sequence[int], tick_hz: int) -> None:
        """Plan messages with these periods, all beginning at tick 0; one shorter than a tick is due every tick."""
        self._tick_hz = tick_hz
        self._periods_ms = [max(period_ms, _MS_PER_S // tick_hz) for period_ms in periods_ms]
        self._served = [0] * len(periods_ms)
        self._tick: int | None = None
        self.missed = [0] * len(periods_ms)

    def due(self, tick: int) -> list[int]:
        """Return the indices of the messages to send now; a tick that is not newer than the last has none."""
        before = self._tick
        if before is not None and tick <= before:
            return []
        self._tick = tick
        found = []
        for index, period_ms in enumerate(self._periods_ms):
            passed = tick * _MS_PER_S // (period_ms * self._tick_hz) + 1
            new = passed - self._served[index]
            self._served[index] = passed
            if new <= 0:
                continue
            found.append(index)
            if before is not None:
                self.missed[index] += new - 1
        return found

    def next_tick(self) -> int | None:
        """Return the tick of the next deadline, None where nothing is planned."""
        deadlines = zip(self._served, self._periods_ms, strict=True)
        ticks = (-(-served * period_ms * self._tick_hz // _MS_PER_S) for served, period_ms in deadlines)
        return min(ticks, default=None)


class Phase:
    """When a tick can be expected, in s of the reader's clock: the core's deadlines as seen from outside.

    The earliest tick seen so far sets the phase; it drifts later by a little each time, so that it follows a core that
    slipped. So reading one tick late never delays the next read, and no clock is shared between the processes.
    """

    _DRIFT: Final = 0.01
    """Share of a tick by which the phase drifts with each tick seen."""

    def __init__(self, tick_hz: int) -> None:
        self._tick_s = 1.0 / tick_hz
        self._base_s: float | None = None

    def saw(self, tick: int, now_s: float) -> None:
        """Note that tick `tick` was new at `now_s`."""
        base_s = now_s - tick * self._tick_s
        if self._base_s is not None:
            base_s = min(base_s, self._base_s + self._DRIFT * self._tick_s)
        self._base_s = base_s

    def expected_s(self, tick: int) -> float:
        """Return when `tick` is expected; 0 before any was seen."""
        return 0.0 if self._base_s is None else self._base_s + tick * self._tick_s
