"""When the next tick is due: absolute deadlines for a person in the seat, none for a headless drive.

A deadline is `start + tick * period`, never "now + period": a late tick does not make all later ones late. After a
stall at most CATCH_UP_TICKS late ticks run at once; the rest never happen (a slip: simulated time falls behind the
wall by that much, and is counted). dt never stretches.
"""

import gc
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Final

from simconsole.values.latency import Histogram
from simconsole.values.signals import Event
from simconsole.values.units import NS_PER_S

CATCH_UP_TICKS: Final = 5
STALL_NS: Final = 100_000_000
"""A longer stall is an event that the arbiter answers with a safe stop."""

_PR_SET_TIMERSLACK: Final = 29  # linux/prctl.h
_MCL_CURRENT: Final = 1  # sys/mman.h; not MCL_FUTURE: the log of a long drive must not be locked
_MCL_ONFAULT: Final = 4  # Linux 4.4; without it, what libraries reserve and never use is brought in: gigabytes
_PRIORITY: Final = 50
_FINE_S: Final = 1e-4


class Pacer:
    """Deadlines of a drive in real time. The first `wait` starts the clock.

    Attributes:
        lateness: how late each tick began.
        work: how long each tick took, from its beginning to the next `wait`.
        slipped_ticks: ticks that never happened because the loop stood still.
        stalls: how often it stood still for more than 100 ms.
    """

    def __init__(
        self,
        tick_hz: int,
        now_ns: Callable[[], int] = time.monotonic_ns,
        sleep_s: Callable[[float], None] = time.sleep,
    ) -> None:
        self._tick_hz = tick_hz
        self._now_ns = now_ns
        self._sleep_s = sleep_s
        self._start_ns: int | None = None
        self._due = 0
        self._woken_ns: int | None = None
        self.lateness = Histogram()
        self.work = Histogram()
        self.slipped_ticks = 0
        self.stalls = 0

    def wait(self) -> int:
        """Sleep until the next tick is due; return `Event.LOOP_STALL` if the loop stood still, else 0."""
        now_ns = self._now_ns()
        if self._start_ns is None:
            self._start_ns = now_ns
        if self._woken_ns is not None:
            self.work.add(now_ns - self._woken_ns)
        deadline_ns = self._deadline_ns()
        while now_ns < deadline_ns:
            self._sleep_s((deadline_ns - now_ns) / NS_PER_S)
            now_ns = self._now_ns()
        self._woken_ns = now_ns
        late_ns = now_ns - deadline_ns
        self.lateness.add(late_ns)
        events = self._catch_up(late_ns)
        self._due += 1
        return events

    def summary(self) -> dict[str, Any]:
        """Return percentiles of lateness and work in us and the counters, for manifest and table."""
        late = self.lateness.summary_us()
        return {
            "lateness": f"p50 {late['p50']:.0f} us, p99 {late['p99']:.0f} us, max {late['max']:.0f} us",
            "lateness_us": late,
            "work_us": self.work.summary_us(),
            "slipped_ticks": self.slipped_ticks,
            "stalls": self.stalls,
        }

    def _deadline_ns(self) -> int:
        assert self._start_ns is not None
        return self._start_ns + self._due * NS_PER_S // self._tick_hz

    def _catch_up(self, late_ns: int) -> int:
        behind = late_ns * self._tick_hz // NS_PER_S
        if behind > CATCH_UP_TICKS:
            # The ticks given up become part of the start, so every later deadline stays exact.
            slipped = behind - CATCH_UP_TICKS
            self._due += slipped
            self.slipped_ticks += slipped
        if late_ns <= STALL_NS:
            return 0
        self.stalls += 1
        return int(Event.LOOP_STALL)


class UnpacedPacer:
    """No deadlines: the next tick is always due."""

    never_waits = True

    def wait(self) -> int:
        """Return at once, without events."""
        return 0

    def summary(self) -> dict[str, Any]:
        """Return that the drive was not paced, for manifest and table."""
        return {"lateness": "not paced"}


@contextmanager
def realtime_hints() -> Iterator[list[str]]:
    """Ask the system for real-time behaviour where permitted, undo it afterwards; yield what was not granted.

    SCHED_FIFO scheduling (reset on fork, so that no worker inherits it), locked memory, a timer slack of
    1 ns and a garbage collector that ignores the objects made before the drive. All of it is optional.
    """
    gc.collect()
    gc.freeze()
    try:
        with _system_hints() as missing:
            yield missing
    finally:
        gc.unfreeze()


def _coarse_clock() -> list[str]:
    resolution_s = time.get_clock_info("monotonic").resolution
    if resolution_s <= _FINE_S:
        return []
    return [f"a clock with steps of {1000.0 * resolution_s:.1f} ms: on Windows Python 3.13 or later has a fine one"]


@contextmanager
def _system_hints() -> Iterator[list[str]]:
    import ctypes
    import os

    if sys.platform == "linux":
        missing = []
        libc = ctypes.CDLL(None, use_errno=True)
        libc.prctl(_PR_SET_TIMERSLACK, 1, 0, 0, 0)
        if libc.mlockall(_MCL_CURRENT | _MCL_ONFAULT) != 0:
            missing.append("locked memory: not permitted")
        before, parameters = os.sched_getscheduler(0), os.sched_getparam(0)
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(_PRIORITY))
        except OSError as error:
            missing.append(f"real-time scheduling: {error.strerror}")
        try:
            yield missing
        finally:
            # Only a privileged process may clear reset-on-fork again, so it stays.
            os.sched_setscheduler(0, before | os.SCHED_RESET_ON_FORK, parameters)
            libc.munlockall()
            libc.prctl(_PR_SET_TIMERSLACK, 0, 0, 0, 0)
    else:
        yield ["real-time scheduling, locked memory and timer slack: only on Linux", *_coarse_clock()]
