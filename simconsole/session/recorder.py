"""The drive loop's recorder: each tick into the log, with the operator's acts that arrived in it."""

from collections.abc import Callable
from typing import Any

from simconsole.bridge.console.operator_acts import ActsSummary
from simconsole.recording.bundles.log import LogWriter
from simconsole.recording.log_header import ACTS
from simconsole.values.kernels import Row
from simconsole.values.signals import Event
from simconsole.values.state_vector import Snapshot

_RECORDING_FAILED = int(Event.RECORDING_FAILED)


class LogRecorder:
    """Logs every tick, and raises an alarm in every tick after the log has failed."""

    def __init__(self, log: LogWriter, take_acts: Callable[[], list[bytes]] = list) -> None:
        """Write to `log`; `take_acts` returns the operator's acts since its last call, each as JSON."""
        self._log = log
        self._take_acts = take_acts
        self._summary = ActsSummary()

    def write(self, snapshot: Snapshot) -> int:
        """Append one tick; an exception, as of a failing disk, goes into the log's `failure` and raises an event."""
        try:
            self._append(snapshot.tick, snapshot.vector, self._take_acts())
        except Exception as error:
            self._note(error)
            raise
        return 0 if self._log.failure is None else _RECORDING_FAILED

    def write_block(self, tick: int, vectors: Row) -> tuple[int, int]:
        """Append the ticks from `tick` on and return as `BlockRecorder`; exceptions as of `write`."""
        try:
            kept = self._append_block(tick, vectors)
        except Exception as error:
            self._note(error)
            raise
        return kept, 0 if self._log.failure is None else _RECORDING_FAILED

    def _append_block(self, tick: int, vectors: Row) -> int:
        acts = self._take_acts()
        if not acts:
            return self._log.append_block(tick, vectors)
        self._append(tick, vectors[0], acts)
        return 1

    def _append(self, tick: int, vector: Row, acts: list[bytes]) -> None:
        self._log.append(tick, vector, [(ACTS, act) for act in acts])
        for act in acts:
            self._summary.add(act)

    def _note(self, error: Exception) -> None:
        self._log.failure = self._log.failure or f"{type(error).__name__}: {error}"

    def acts_summary(self) -> dict[str, Any]:
        """Return what the drive's summary says of the acts."""
        return self._summary.summary()
