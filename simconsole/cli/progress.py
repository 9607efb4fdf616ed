"""Progress of long work, on a terminal only."""

import sys
import time
from contextlib import suppress
from types import TracebackType
from typing import Final, Self

from simconsole.cli.outcome import RECORDING_FAILED
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import KMH_PER_MPS

INTERVAL_S: Final = 0.2
TICKS_BETWEEN_LOOKS: Final = 64
"""Number of ticks after which the clock is read again."""


class Progress:
    """One line that is written over; nothing at all where standard error is no terminal."""

    def __init__(self, what: str, length_m: float = 0.0) -> None:
        self._what = what
        self._length_m = length_m
        self._shown = sys.stderr.isatty()
        self._next_s = 0.0
        self._next_tick = TICKS_BETWEEN_LOOKS
        self._shares: dict[str, float] = {}

    def __enter__(self) -> Self:
        """Say what begins."""
        self._write(f"{self._what} ...")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Wipe the line."""
        self._write("")

    def show(self, snapshot: Snapshot) -> None:
        """Show where a drive is, at most every INTERVAL_S."""
        if not self._shown or snapshot.tick < self._next_tick:
            return
        self._next_tick = snapshot.tick + TICKS_BETWEEN_LOOKS
        if time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + INTERVAL_S
            vehicle, mode = snapshot.vehicle, Mode(int(snapshot.arbitration.mode))
            way = f"{vehicle.distance_m:7.1f} m" + (f" of {self._length_m:.0f} m" if self._length_m else "")
            speed = f"{vehicle.vx_mps * KMH_PER_MPS:5.1f} km/h"
            alarm = f"  {RECORDING_FAILED}" if snapshot.recording_failed else ""
            self._write(f"{self._what}: {snapshot.t_s:7.1f} s  {way}  {speed}  {mode_label(float(mode))}{alarm}")

    def count(self, done: int, total: int = 0) -> None:
        """Show how many ticks of `total` (0: unknown) are done, at most every INTERVAL_S."""
        if self._shown and time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + INTERVAL_S
            self._write(f"{self._what}: {done} ticks" + (f" of {total}" if total else ""))

    def done(self, what: str, share: float) -> None:
        """Show how much of something is done, from 0 to 1, beside the other things; at most every INTERVAL_S."""
        self._shares[what] = share
        if self._shown and time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + INTERVAL_S
            shares = ", ".join(f"{name} {share:.0%}" for name, share in sorted(self._shares.items()))
            self._write(f"{self._what}: {shares}")

    def _write(self, line: str) -> None:
        if self._shown:
            with suppress(OSError):  # the terminal was closed
                sys.stderr.write(f"\r\x1b[K{line}")
                sys.stderr.flush()
