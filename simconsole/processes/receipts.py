"""A worker's part of the latency statistics, in a file of the run folder."""

import contextlib
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import msgspec

from simconsole.processes.shared_memory import Record
from simconsole.values.host.files import write_atomically
from simconsole.values.latency import Hop, LatencyStatistics
from simconsole.values.units import NS_PER_S


class Receipts:
    """A worker's part of the latency statistics, written to a file once a second.

    For the first time a second after the first record: a worker that is restarted leaves there what the one before it
    had counted until it has as much to say, and says nothing of a drive that ends before.
    """

    SAVE_NS: Final = NS_PER_S

    def __init__(self, path: Path, clock_ns: Callable[[], int] = time.monotonic_ns) -> None:
        self._path = path
        self._clock_ns = clock_ns
        self._latencies = LatencyStatistics(clock_ns)
        self._number = 0
        self._fresh = False
        self._saved_ns: int | None = None

    def received(self, record: Record) -> None:
        """Note a record; one that was noted before is not counted again."""
        self._fresh = record.number != self._number
        if self._fresh:
            self._number = record.number
            self._latencies.received(record.second_stamp)
            self._save()

    def drawn(self) -> None:
        """Note that the picture of the record received last is on the screen."""
        if self._fresh:
            self._fresh = False
            self._latencies.mark(Hop.DRAW)

    def _save(self) -> None:
        now_ns = self._clock_ns()
        if self._saved_ns is None:
            self._saved_ns = now_ns
        if now_ns - self._saved_ns < self.SAVE_NS:
            return
        self._saved_ns = now_ns
        with contextlib.suppress(OSError):  # the run folder is gone: the core has ended
            write_atomically(self._path, msgspec.json.encode(self._latencies.summary_us()), durable=False)


def latencies_of(folder: Path, stem: str) -> dict[str, Any]:
    """Return the workers' newest latency statistics, at most a second old, by hop and worker: `receive, hud`.

    Args:
        folder: the run folder.
        stem: how their files' names begin, before the worker's.
    """
    found: dict[str, Any] = {}
    for path in sorted(folder.glob(f"{stem}.*.json")):
        try:
            pages = msgspec.json.decode(path.read_bytes(), type=dict[str, Any])
        except (OSError, msgspec.DecodeError):
            continue
        worker = path.name.split(".")[1]
        found.update({f"{hop}, {worker}": page for hop, page in pages.items()})
    return found
