"""The drive loop's recorder: each tick into the log, with the operator's acts that arrived in it."""

from collections.abc import Callable
from typing import Any

from simconsole.bridge.console.operator_acts import ActsSummary
from simconsole.recording.bundles.log import LogWriter
from simconsole.recording.log_header import ACTS
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
            if acts := self._take_acts():
                self._log.append(snapshot.tick, snapshot.vector, [(ACTS, act) for act in acts])
                for act in acts:
                    self._summary.add(act)
            else:  # nearly every tick
                self._log.append(snapshot.tick, snapshot.vector)
        except Exception as error:
            self._log.failure = self._log.failure or f"{type(error).__name__}: {error}"
            raise
        return 0 if self._log.failure is None else _RECORDING_FAILED

    def acts_summary(self) -> dict[str, Any]:
        """Return what the drive's summary says of the acts."""
        return self._summary.summary()
