"""The drive loop's recorder: each tick into the log, with the operator's acts and the road users that came with it."""

from collections.abc import Callable, Sequence
from typing import Any, Protocol

from simconsole.bridge.console.operator_acts import ActsSummary
from simconsole.recording.log_header import ACTS
from simconsole.values.kernels import Row
from simconsole.values.signals import Event
from simconsole.values.state_vector import Snapshot

_RECORDING_FAILED = int(Event.RECORDING_FAILED)


class Log(Protocol):
    """Where a drive is kept; a failing one says why in `failure`."""

    failure: str | None

    def append(self, tick: int, vector: Row, messages: Sequence[tuple[str, bytes]] = ()) -> None:
        """Keep one tick and the messages that came with it."""

    def append_block(self, tick: int, vectors: Row, messages: Sequence[tuple[str, bytes]] = ()) -> int:
        """Keep ticks, the messages with the first of them, and return how many."""


class NoLog:
    """The log of a drive that somebody else keeps."""

    failure: str | None = None

    def append(self, tick: int, vector: Row, messages: Sequence[tuple[str, bytes]] = ()) -> None:
        """Keep nothing."""

    def append_block(self, tick: int, vectors: Row, messages: Sequence[tuple[str, bytes]] = ()) -> int:
        """Keep nothing."""
        return len(vectors)


class MessageSource(Protocol):
    """Somebody whose messages the log keeps."""

    def take_messages(self, tick: int) -> list[tuple[str, bytes]]:
        """Return the messages since the last call, each with the name of its stream; they come with `tick`."""


class LogRecorder:
    """Logs every tick, and raises an alarm in every tick after the log has failed."""

    def __init__(self, log: Log, take_acts: Callable[[], list[bytes]] = list, *sources: MessageSource | None) -> None:
        """Write to `log`; `take_acts` returns the operator's acts since its last call, each as JSON.

        The `sources` are traffic and a lab's own signals, where there are any.
        """
        self._log = log
        self._take_acts = take_acts
        self._sources = [source for source in sources if source is not None]
        self._summary = ActsSummary()

    def write(self, snapshot: Snapshot) -> int:
        """Append one tick; an exception, as of a failing disk, goes into the log's `failure` and raises an event."""
        try:
            self._log.append(snapshot.tick, snapshot.vector, self._messages(snapshot.tick))
        except Exception as error:
            self._note(error)
            raise
        return self._events()

    def write_block(self, tick: int, vectors: Row) -> tuple[int, int]:
        """Append the ticks from `tick` on and return as `BlockRecorder`; exceptions as of `write`."""
        try:
            kept = self._log.append_block(tick, vectors, self._messages(tick))
        except Exception as error:
            self._note(error)
            raise
        return kept, self._events()

    def _events(self) -> int:
        return 0 if self._log.failure is None else _RECORDING_FAILED

    def _messages(self, tick: int) -> list[tuple[str, bytes]]:
        """Return what the coming tick brings with it."""
        acts = self._take_acts()
        if not acts and not self._sources:
            return []
        for act in acts:
            self._summary.add(act)
        others = (message for source in self._sources for message in source.take_messages(tick))
        return [*((ACTS, act) for act in acts), *others]

    def _note(self, error: Exception) -> None:
        self._log.failure = self._log.failure or f"{type(error).__name__}: {error}"

    def acts_summary(self) -> dict[str, Any]:
        """Return what the drive's summary says of the acts."""
        return self._summary.summary()
