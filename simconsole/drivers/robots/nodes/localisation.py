"""Where SLAM says that odom lies in map, and which map it has: taken at times that do not depend on the network.

In a drive in lockstep every run shall be equal bit for bit, whichever of two programs is faster. So what SLAM makes of
a scan counts from the next scan on, and navigation waits for it there. A program beside a clock takes what comes.
"""

from collections import deque

from simconsole.values.platform import Pose
from simconsole.world.arena.occupancy import Grid


class Localisation:
    """What SLAM has said.

    Attributes:
        correction: of odom, in map; None before the first.
        corrected_ns: the time that it is of.
    """

    def __init__(self, lockstep: bool) -> None:
        """Take what is said at the next scan (`lockstep`), or at once."""
        self.correction: Pose | None = None
        self.corrected_ns = 0
        self._lockstep = lockstep
        self._corrections: deque[tuple[int, Pose]] = deque()
        self._maps: deque[tuple[int, Grid]] = deque()
        self._scanned_ns: int | None = None  # end of the newest scan
        self._due_ns: int | None = None  # end of the scan before it

    def scan(self, end_ns: int) -> None:
        """Take that a scan has come."""
        self._due_ns, self._scanned_ns = self._scanned_ns, end_ns

    def correct(self, time_ns: int, correction: Pose) -> None:
        """Take where odom lies in map."""
        self._corrections.append((time_ns, correction))

    def see_map(self, time_ns: int, grid: Grid) -> None:
        """Take a map."""
        self._maps.append((time_ns, grid))

    @property
    def waits(self) -> bool:
        """Whether what SLAM makes of the scan before the newest is still to come."""
        if not self._lockstep or self._due_ns is None:
            return False
        newest_ns = self._corrections[-1][0] if self._corrections else self.corrected_ns
        return newest_ns < self._due_ns

    def take(self) -> Grid | None:
        """Take what is due; return the newest map of it, None without one."""
        found = None
        while self._corrections and self._is_due(self._corrections[0][0]):
            self.corrected_ns, self.correction = self._corrections.popleft()
        while self._maps and self._is_due(self._maps[0][0]):
            found = self._maps.popleft()[1]
        return found

    def _is_due(self, time_ns: int) -> bool:
        return not self._lockstep or (self._due_ns is not None and time_ns <= self._due_ns)
