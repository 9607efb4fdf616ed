"""When to reconnect and when a silent connection counts as dead: rules without a clock."""

from typing import Final

FIRST_S: Final = 0.1
CAP_S: Final = 1.5
"""With its jitter below 2 s, so that a server that is back is found again within that."""
JITTER: Final = 0.25
PING_AFTER_S: Final = 1.0
DEAD_AFTER_S: Final = 3.0
HUNG_AFTER_S: Final = 90.0
"""Longer than a console waits for anybody, which is 60 s at most."""
AWAY_S: Final = 1.5
"""Who waits for something to come, and looks again only after longer, was away: a ping is due after 1 s."""


class Backoff:
    """Pauses between attempts: doubled each time up to a cap, and scattered so that not all clients come at once."""

    def __init__(self, first_s: float = FIRST_S, cap_s: float = CAP_S) -> None:
        """Begin with `first_s`, never more than `cap_s` before the scatter."""
        self._first_s = first_s
        self._cap_s = cap_s
        self._next_s = first_s

    def pause_s(self, chance: float) -> float:
        """Return the next pause; `chance`, 0 to 1, places it within 25 % about its middle."""
        pause_s = self._next_s * (1.0 + JITTER * (2.0 * chance - 1.0))
        self._next_s = min(self._cap_s, 2.0 * self._next_s)
        return pause_s

    def reset(self) -> None:
        """Start over: the connection is established."""
        self._next_s = self._first_s


class Liveness:
    """Silence on a connection: after 1 s a ping is due, once a second; after 3 s it counts as dead.

    Only silence that was listened to counts: where this process was stopped, or its whole machine stood still, what the
    other side has sent meanwhile is still to be read, or to be sent.
    """

    def __init__(self, ping_after_s: float = PING_AFTER_S, dead_after_s: float = DEAD_AFTER_S) -> None:
        """Start at time 0; `begin` sets it."""
        self._ping_after_s = ping_after_s
        self._dead_after_s = dead_after_s
        self._heard_s = 0.0
        self._pinged_s = 0.0
        self._looked_s = 0.0

    def begin(self, now_s: float) -> None:
        """Take a new connection."""
        self._heard_s = self._pinged_s = self._looked_s = now_s

    def listen(self, now_s: float) -> None:
        """Note that this side begins to look whether something has come."""
        self._looked_s = now_s

    def look(self, now_s: float) -> None:
        """Note that it has looked again; where that took longer than AWAY_S, silence counts from now on."""
        if now_s - self._looked_s > AWAY_S:
            self.heard(now_s)
        self._looked_s = now_s

    def heard(self, at_s: float) -> None:
        """Note that something arrived."""
        self._heard_s = max(self._heard_s, at_s)

    def is_dead(self, now_s: float) -> bool:
        """Return whether the other side has been silent for too long."""
        return self.silence_s(now_s) >= self._dead_after_s

    def silence_s(self, now_s: float) -> float:
        """Return how long the other side has been silent."""
        return now_s - self._heard_s

    def ping_due(self, now_s: float) -> bool:
        """Return whether to ping now, and take it as done."""
        due = now_s - max(self._heard_s, self._pinged_s) >= self._ping_after_s
        if due:
            self._pinged_s = now_s
        return due

    def patience_s(self, now_s: float) -> float:
        """Return how long until a ping is due or the connection counts as dead; once it does, until the next ping."""
        ask_s = max(self._heard_s, self._pinged_s) + self._ping_after_s
        dead_s = self._heard_s + self._dead_after_s
        return max(0.0, (ask_s if self.is_dead(now_s) else min(ask_s, dead_s)) - now_s)
