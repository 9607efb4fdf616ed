"""The text of a bus's error frames, and when a bus that went off is opened again.

The first wait doubles with every failed try, up to the last.
"""

from typing import Final

BUS_OFF: Final = 0x40
_ERRORS: Final = {
    0x001: "transmit time-out",
    0x002: "lost arbitration",
    0x004: "controller problem",
    0x008: "protocol violation",
    0x010: "transceiver problem",
    0x020: "no acknowledgement",
    BUS_OFF: "bus-off",
    0x080: "bus error",
    0x100: "controller restarted",
}
"""Classes of an error frame: the bits of its id (linux/can/error.h)."""


def error_label(can_id: int) -> str:
    """Return the error classes in an error frame's id as text."""
    return ", ".join(label for bit, label in _ERRORS.items() if can_id & bit) or "unspecified error"


class Seldom:
    """A rate limit: lets one through, then none for a while. Times are s of whatever clock the caller has."""

    def __init__(self, gap_s: float) -> None:
        self._gap_s = gap_s
        self._last_s: float | None = None

    def __call__(self, now_s: float) -> bool:
        """Return whether it may pass now."""
        if self._last_s is not None and now_s - self._last_s < self._gap_s:
            return False
        self._last_s = now_s
        return True


class Recovery:
    """The state of one bus, UP at the start. Times are s of whatever clock the caller has.

    Attributes:
        up: whether the bus may be used.
        reason: why it went down last.
        downs: how often it went down.
    """

    def __init__(self, first_s: float, last_s: float) -> None:
        """Wait `first_s` before the first new try, at most `last_s` before any."""
        self._first_s = first_s
        self._last_s = max(first_s, last_s)
        self._wait_s = first_s
        self._next_s = 0.0
        self._up_since_s = 0.0
        self.up = True
        self.reason = ""
        self.downs = 0

    def went_down(self, reason: str, now_s: float) -> None:
        """Note that the bus, or a new try, failed. A bus that was up for `last_s` starts from the first wait again."""
        if self.up:
            self.downs += 1
            if now_s - self._up_since_s >= self._last_s:
                self._wait_s = self._first_s
        self.up = False
        self.reason = reason
        self._next_s = now_s + self._wait_s
        self._wait_s = min(2.0 * self._wait_s, self._last_s)

    def is_due(self, now_s: float) -> bool:
        """Return whether a bus that is down should be tried now."""
        return not self.up and now_s >= self._next_s

    def came_up(self, now_s: float) -> None:
        """Note that a new try succeeded."""
        self.up = True
        self._up_since_s = now_s
