"""Progress of long work: how much is done and how long it still takes; on a terminal, or by `-v`."""

import sys
import time
from contextlib import suppress
from types import TracebackType
from typing import Final, Self

from simconsole.cli.outcome import RECORDING_FAILED
from simconsole.cli.terminal.talk import Talk, level, say
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import KMH_PER_MPS

INTERVAL_S: Final = 0.2
TICKS_BETWEEN_LOOKS: Final = 64
"""Number of ticks after which the clock is read again."""


class Progress:
    """One line that is written over where standard error is a terminal; nothing with `--quiet`.

    With `-v` and no terminal, a line when the work begins; with `-v` always one when it has ended, with its time.
    """

    def __init__(self, what: str, length_m: float = 0.0, duration_s: float | None = None) -> None:
        """Name the work; of a drive the length of its route in m, if it has one, and when it ends in simulated s."""
        self._what = what
        self._duration_s = duration_s
        self._length_m = length_m
        self._shown = sys.stderr.isatty() and level() is not Talk.QUIET
        self._began_s = time.monotonic()
        self._next_s = 0.0
        self._next_tick = TICKS_BETWEEN_LOOKS
        self._shares: dict[str, float] = {}

    def __enter__(self) -> Self:
        """Say what begins."""
        self._write(f"{self._what} ...")
        if level() is Talk.VERBOSE and not self._shown:
            say(f"{self._what} ...")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Wipe the line."""
        self._write("")
        if level() is Talk.VERBOSE:
            say(f"{self._what}: {time.monotonic() - self._began_s:.1f} s")

    def show(self, snapshot: Snapshot) -> None:
        """Show where a drive is, at most every INTERVAL_S."""
        if not self._shown or snapshot.tick < self._next_tick:
            return
        self._next_tick = snapshot.tick + TICKS_BETWEEN_LOOKS
        if self._is_due():
            vehicle, mode = snapshot.vehicle, Mode(int(snapshot.arbitration.mode))
            way = f"{vehicle.distance_m:7.1f} m" + (f" of {self._length_m:.0f} m" if self._length_m else "")
            speed = f"{vehicle.vx_mps * KMH_PER_MPS:5.1f} km/h"
            alarm = f"  {RECORDING_FAILED}" if snapshot.recording_failed else ""
            shares = [vehicle.distance_m / self._length_m] if self._length_m else []
            shares += [snapshot.t_s / self._duration_s] if self._duration_s else []
            left = self._left(max(shares, default=0.0))
            self._write(f"{self._what}: {snapshot.t_s:7.1f} s  {way}  {speed}  {mode_label(float(mode))}{left}{alarm}")

    def count(self, done: int, total: int = 0) -> None:
        """Show how many ticks of `total` (0: unknown) are done, at most every INTERVAL_S."""
        if self._shown and self._is_due():
            of = f" of {total}{self._left(done / total)}" if total else ""
            self._write(f"{self._what}: {done} ticks{of}")

    def done(self, what: str, share: float) -> None:
        """Show how much of something is done, from 0 to 1, beside the other things; at most every INTERVAL_S."""
        self._shares[what] = share
        if self._shown and self._is_due():
            shares = ", ".join(f"{name} {share:.0%}" for name, share in sorted(self._shares.items()))
            left = self._left(min(self._shares.values())).partition(",")[2]  # the last one decides; its share is told
            self._write(f"{self._what}: {shares}{',' if left else ''}{left}")

    def say(self, line: str) -> None:
        """Say a line that stays, in the place of the one that is written over."""
        self._write("")
        say(line)

    def _is_due(self) -> bool:
        now_s = time.monotonic()
        if now_s < self._next_s:
            return False
        self._next_s = now_s + INTERVAL_S
        return True

    def _left(self, share: float) -> str:
        """Return how much is done and how long the rest takes at the pace so far; "" where neither is known yet."""
        if not 0.0 < share <= 1.0:
            return ""
        left_s = (time.monotonic() - self._began_s) * (1.0 - share) / share
        return f"  {share:.0%}, {time_text(left_s)} left"

    def _write(self, line: str) -> None:
        if self._shown:
            with suppress(OSError):  # the terminal was closed
                sys.stderr.write(f"\r\x1b[K{line}")
                sys.stderr.flush()


def time_text(duration_s: float) -> str:
    """Return a duration in s as minutes and seconds, 2:05; from an hour on with hours."""
    minutes, seconds = divmod(round(duration_s), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}" if hours else f"{minutes}:{seconds:02}"
