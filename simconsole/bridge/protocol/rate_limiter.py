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


class ByteMeter:
    """A token bucket for work whose size is known only when it is done: what is too much is paid off by waiting."""

    def __init__(self, bytes_per_s: float) -> None:
        """Start full, with a second's worth."""
        self._bytes_per_s = bytes_per_s
        self._left = bytes_per_s
        self._last_ns = 0
        self.ready_ns = 0
        """When more may be done."""

    def charge(self, size: int, now_ns: int) -> None:
        """Count `size` bytes."""
        gained = max(0, now_ns - self._last_ns) * self._bytes_per_s / NS_PER_S
        self._left = min(self._bytes_per_s, self._left + gained) - size
        self._last_ns = now_ns
        if self._left < 0.0:
            self.ready_ns = now_ns + int(-self._left / self._bytes_per_s * NS_PER_S)
