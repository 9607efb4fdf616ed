"""Rate limit of a client's commands: a token bucket without a clock of its own."""

from simconsole.values.units import NS_PER_S


class RateLimiter:
    """A token bucket: `rate_hz` messages a second, and bursts of as many after a second's silence."""

    def __init__(self, rate_hz: float | None) -> None:
        """Start full; None lets everything pass."""
        self._rate_hz = rate_hz
        self._left = rate_hz or 0.0
        self._last_ns: int | None = None

    def allows(self, now_ns: int) -> bool:
        """Return whether a message that comes at `now_ns` may pass, and count it if so."""
        if self._rate_hz is None:
            return True
        if self._last_ns is not None:
            gained = max(0, now_ns - self._last_ns) * self._rate_hz / NS_PER_S
            self._left = min(self._rate_hz, self._left + gained)
        self._last_ns = now_ns
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True
