"""A drive kept in memory: its rows, and the chained hash that a log would have."""

import numpy as np

from simconsole.recording.framing import START_OF_CHAIN, chain
from simconsole.rows import Snapshot


class MemoryRecorder:
    """Keeps every row of a drive of at most `ticks` ticks; the hash continues that of an earlier drive."""

    def __init__(self, ticks: int, width: int, digest: bytes = START_OF_CHAIN) -> None:
        self.rows = np.empty((ticks, width))
        self.ticks = 0
        self.digest = digest

    def write(self, snapshot: Snapshot) -> int:
        """Keep one tick."""
        self.rows[self.ticks] = snapshot.row
        self.ticks += 1
        self.digest = chain(self.digest, snapshot.tick, snapshot.row.tobytes())
        return 0
