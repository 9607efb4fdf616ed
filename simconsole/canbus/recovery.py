"""When a bus that went off is tried again: after the first time, then after twice as long each, up to the last."""


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
        """The bus failed, or a new try did. One that held for `last_s` starts from the first wait again."""
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
        """A new try succeeded."""
        self.up = True
        self._up_since_s = now_s
