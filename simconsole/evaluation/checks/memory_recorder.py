"""A drive kept in memory: its state vectors, and the chained hash that a log would have."""

from typing import Final

import numpy as np

from simconsole.recording.framing import START_OF_CHAIN, chain
from simconsole.values.kernels import Row
from simconsole.values.state_vector import Snapshot

FIRST_TICKS: Final = 4096
"""Ticks that memory is allocated for at first; it doubles whenever it is full."""


class MemoryRecorder:
    """Keeps every state vector of a drive of at most `ticks` ticks; the hash continues that of an earlier drive."""

    def __init__(self, ticks: int, width: int, digest: bytes = START_OF_CHAIN) -> None:
        self._most = ticks
        self._room = np.empty((min(ticks, FIRST_TICKS), width))
        self.ticks = 0
        self.digest = digest

    @property
    def vectors(self) -> Row:
        """The state vectors so far (ticks, columns)."""
        return self._room[: self.ticks]

    def write(self, snapshot: Snapshot) -> int:
        """Keep one tick."""
        return self.write_block(snapshot.tick, snapshot.vector[np.newaxis])[1]

    def write_block(self, tick: int, vectors: Row) -> tuple[int, int]:
        """Keep the ticks from `tick` on, all of them."""
        ticks = self.ticks + len(vectors)
        if ticks > len(self._room):
            larger = np.empty((min(self._most, max(2 * self.ticks, ticks)), self._room.shape[1]))
            larger[: self.ticks] = self.vectors
            self._room = larger
        self._room[self.ticks : ticks] = vectors
        self.ticks = ticks
        for number, vector in enumerate(vectors, start=tick):
            self.digest = chain(self.digest, number, vector.tobytes())
        return len(vectors), 0
