"""The only clock of the tests: patience with what happens outside, and times that are told but judged by nothing.

A limit is in simulated time, counts, CPU time or a ratio within one run. A clock ends only what would hang for ever,
and late: the machine may be loaded.
"""

import asyncio
import time
from collections.abc import Callable
from statistics import median
from typing import Final, TypeVar

T = TypeVar("T")

PATIENCE_S: Final = 600.0
"""A time-out against hanging, far above what anything takes beside other work."""


def wait_until(condition: Callable[[], T], what: str) -> T:
    """Look until `condition` holds, and return what it returned. After a costly look others get the processor."""
    began_s = now_s = time.monotonic()
    while not (found := condition()):
        looked_s, now_s = now_s, time.monotonic()
        assert now_s < began_s + PATIENCE_S, f"{what}: not within {PATIENCE_S} s"
        time.sleep(min(max(0.002, 3.0 * (now_s - looked_s)), 1.0))
        now_s = time.monotonic()
    return found


async def until(condition: Callable[[], object]) -> None:
    """Let the event loop turn until `condition` holds."""
    async with asyncio.timeout(PATIENCE_S):
        while not condition():
            await asyncio.sleep(0.001)


def pause(length_s: float) -> None:
    """Let time pass, for a program that is paced by it or until a moment drawn at random; never to wait for a state."""
    time.sleep(length_s)


def stamp_ns() -> int:
    """Return a moment of the clock that all processes share: for the order of events, not for their distance."""
    return time.monotonic_ns()


class Stopwatch:
    """Tells how long something took, in words: a figure for a reader, by which no test can judge."""

    def __init__(self) -> None:
        """Begin."""
        self._laps_s: list[float] = []
        self.start()

    def start(self) -> None:
        """Begin anew, and keep the laps."""
        self._began_s = time.monotonic()

    def lap(self) -> None:
        """Keep the time since the beginning."""
        self._laps_s.append(time.monotonic() - self._began_s)

    @property
    def longest(self) -> str:
        """The longest lap."""
        return f"{max(self._laps_s, default=0.0):.2f} s"

    @property
    def median(self) -> str:
        """The median of the laps."""
        return f"{median(self._laps_s):.3f} s"
