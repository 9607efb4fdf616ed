"""One clock for several platforms, which make each tick in turn: the first to come to it waits for all."""

from typing import Any

from simconsole.session.pacing import Pacer


class SharedPace:
    """The pace of a session with several platforms.

    While simulated time stands for one of them it alone asks, again and again, and waits as often: no tick is late when
    the others go on.
    """

    def __init__(self, pacer: Pacer, platforms: int) -> None:
        """Take the clock of so many platforms."""
        self._pacer = pacer
        self._asked = [0] * platforms
        self._events = [0] * platforms
        self._waited = 0

    def of(self, number: int) -> "PaceOfOne":
        """Return what the platform of this number asks."""
        return PaceOfOne(self, number)

    def wait(self, number: int) -> int:
        """Wait for the next tick, unless another platform has; return the events (mask) that came of it."""
        self._asked[number] += 1
        if self._asked[number] > self._waited:
            self._waited = self._asked[number]
            events = self._pacer.wait()
            self._asked = [max(asked, self._waited - 1) for asked in self._asked]
            self._events = [before | events for before in self._events]
        events, self._events[number] = self._events[number], 0
        return events

    def summary(self) -> dict[str, Any]:
        """Return as `Pacer.summary`."""
        return self._pacer.summary()


class PaceOfOne:
    """The pace as one platform's drive loop sees it."""

    def __init__(self, shared: SharedPace, number: int) -> None:
        """Take the shared pace and the platform's number."""
        self._shared, self._number = shared, number

    def wait(self) -> int:
        """Sleep until the next tick, if nobody has for it; return the events (mask) that pacing raised."""
        return self._shared.wait(self._number)

    def summary(self) -> dict[str, Any]:
        """Return as `Pacer.summary`: of all platforms together."""
        return self._shared.summary()
