"""The bridge on the core's own sockets in lockstep, as the drive loop sees it."""

from collections.abc import Callable, Sequence
from typing import Any, Final, Protocol

from simconsole.bridge.console.input_slots import Question
from simconsole.values.kernels import Row
from simconsole.values.latency import Hop
from simconsole.values.signals import NEVER_TICKS, Event, EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot

_AGE_AT: Final = RemoteCommand._fields.index("age_ticks")
STAND_S = 0.02


class LockstepServer(Protocol):
    """The interface that this module needs of the bridge in lockstep."""

    def exchange(self, snapshot: Snapshot, timeout_s: float, stop: Callable[[], bool]) -> bool:
        """Publish, then wait for the command that answers this very snapshot, until `stop` at most."""

    def publish(self, snapshot: Snapshot) -> None:
        """Publish what is due, without waiting."""

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command and the events."""

    def stand(self, timeout_s: float) -> None:
        """Serve for a short time without publishing anything."""

    def counts(self) -> dict[str, int]:
        """Return how many messages went to and from all clients."""

    @property
    def clients(self) -> int:
        """Connected clients."""

    def take_acts(self) -> list[bytes]:
        """Return what operators have done since the last call, each as JSON."""


class LockstepLink:
    """The bridge as the drive loop sees it: waits for the controller once per control period, never in between.

    After a missing answer (an event in the log) it does not wait again until the controller has spoken: the command
    grows stale in simulated time and the arbiter stops the car.
    """

    hop = Hop.EXCHANGE

    def __init__(
        self,
        bridge: LockstepServer,
        period_ticks: int,
        timeout_s: float,
        stop: Callable[[], bool] = lambda: False,
    ) -> None:
        self._bridge = bridge
        self._period_ticks = period_ticks
        self._timeout_s = timeout_s
        self._stop = stop
        self._silent_at: float | None = None  # the command's sequence number when the controller went silent
        self._sequence = 0.0
        self._raised = 0
        self.exchanges = 0
        self.unanswered = 0

    def publish(self, snapshot: Snapshot) -> None:
        """Publish; at the end of a control period, wait for the answer."""
        if self._waits(snapshot) and not self._bridge.exchange(snapshot, self._timeout_s, self._stop):
            self._miss()

    def _waits(self, snapshot: Snapshot) -> bool:
        """Return whether an answer to this snapshot is to be waited for; if none is, publish what is due."""
        if snapshot.tick % self._period_ticks:
            return False  # sockets are served at fixed ticks only: the drive must not depend on when bytes arrive
        silent = self._silent_at is not None and self._silent_at == self._sequence
        if silent or not self._bridge.clients:
            self._bridge.publish(snapshot)
            return False
        self._silent_at = None
        self.exchanges += 1
        return True

    def _miss(self) -> None:
        """Note that the answer has not come."""
        self.unanswered += 1
        self._silent_at = self._sequence
        self._raised = int(Event.NO_ANSWER)

    def unseen(self, tick: int) -> int:
        """Return how many ticks, from `tick` on, do not end a control period."""
        return -tick % self._period_ticks

    @property
    def clients(self) -> int:
        """Connected clients."""
        return self._bridge.clients

    def stand(self, snapshot: Snapshot) -> None:
        """Serve the clients while simulated time stands."""
        self._bridge.stand(STAND_S)

    def take_acts(self) -> list[bytes]:
        """Return what operators have done since the last call, each as JSON."""
        return self._bridge.take_acts()

    def counters(self) -> dict[str, Any]:
        """Return how often the drive waited for the controller, how often in vain, and what the bridge counted."""
        return {"exchanges": self.exchanges, "unanswered": self.unanswered, "bridge": self._bridge.counts()}

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command, its age in ticks, and the edges, a missing answer among them."""
        remote = self._look(tick)
        raised, self._raised = self._raised, 0
        return remote, EventInput(events=float(raised))

    def foresee(self, tick: int, commands: Row) -> int:
        """Write the newest command, growing older, into the rows of this control period, if no edge has come."""
        remote = self._look(tick)
        if self._raised:
            return 0
        count = min(len(commands), self.unseen(tick) + 1)
        commands[:count] = remote
        if remote.age_ticks < NEVER_TICKS:
            for later in range(1, count):
                commands[later, _AGE_AT] = remote.age_ticks + later
        return count

    def _look(self, tick: int) -> RemoteCommand:
        """Return the newest command and keep the edges until a tick takes them."""
        remote, events = self._bridge.take(tick)
        self._sequence = remote.sequence
        self._raised |= int(events.events)
        return remote


class AskingServer(LockstepServer, Protocol):
    """Likewise, of a bridge that several platforms share."""

    def ask(self, snapshot: Snapshot) -> Question:
        """Publish; return what answers this very snapshot."""

    def hear(self, asked: Sequence[Question], timeout_s: float, stop: Callable[[], bool]) -> list[bool]:
        """Wait for the answers to questions of any platforms; return of each whether it has come."""


class AskingLink(LockstepLink):
    """The bridge as one platform of several sees it: asks its controller, and waits with all others (`hear_all`)."""

    def __init__(
        self,
        bridge: AskingServer,
        period_ticks: int,
        timeout_s: float,
        stop: Callable[[], bool] = lambda: False,
    ) -> None:
        """Take the platform's port of the bridge; the rest as of `LockstepLink`."""
        super().__init__(bridge, period_ticks, timeout_s, stop)
        self._port = bridge
        self._asked: Question | None = None

    def publish(self, snapshot: Snapshot) -> None:
        """Publish; at the end of a control period, with the question that `hear_all` waits for."""
        if self._waits(snapshot):
            self._asked = self._port.ask(snapshot)

    @staticmethod
    def hear_all(links: "Sequence[AskingLink]") -> None:
        """Wait for the answers to all that has been asked on one bridge, in whatever order they come."""
        asking = [(link, link._asked) for link in links if link._asked is not None]
        if not asking:
            return
        first = asking[0][0]
        heard = first._port.hear([asked for _, asked in asking], first._timeout_s, first._stop)
        for (link, _), has_answered in zip(asking, heard, strict=True):
            link._asked = None
            if not has_answered:
                link._miss()
