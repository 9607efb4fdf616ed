"""Edges and messages of a scenario that wait for what happens in the drive."""

from collections.abc import Sequence
from typing import Final

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.profiles.scenario import EventStep, MessageStep
from simconsole.tick.triggers import TriggerWatch
from simconsole.values.errors import ProfileError
from simconsole.values.protocols import CommandSource
from simconsole.values.signals import Event, EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot

STANDS_AT_MOST: Final = 100
"""So often simulated time is waited for that stands: then nobody of the scenario starts it."""


class Standing:
    """Counts how often simulated time that stands was waited for."""

    def __init__(self) -> None:
        self._tick, self._stood = 0, 0

    def stand(self, snapshot: Snapshot) -> None:
        """Wait once more; called again and again while simulated time stands."""
        self._stood = self._stood + 1 if snapshot.tick == self._tick else 1
        self._tick = snapshot.tick

    def ends(self, snapshot: Snapshot) -> bool:
        """Return whether simulated time stands and nobody of the scenario will start it."""
        return self._stood > STANDS_AT_MOST and snapshot.tick == self._tick

    def problem(self) -> str | None:
        """Return that it stood for ever, and since when."""
        if self._stood <= STANDS_AT_MOST:
            return None
        return f"tick {self._tick}: simulated time stands after it and nobody starts it"


class TriggeredEvents:
    """A controller's commands, and the scenario's edges with them: an output that sees what triggers them."""

    def __init__(self, events: Sequence[EventStep], commands: CommandSource, tick_hz: int) -> None:
        """Take edges from `events`, commands and further edges from `commands`."""
        self._waiting = [(int(Event[step.event.upper()]), TriggerWatch(step, tick_hz)) for step in events]
        self._commands = commands
        self._raised = 0

    def publish(self, snapshot: Snapshot) -> None:
        """Look at a tick for what triggers an edge in the one after it."""
        self._look(snapshot)

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command, and this tick's edges."""
        remote, edges = self._commands.take(tick)
        raised, self._raised = self._raised, 0
        return remote, EventInput(float(int(edges.events) | raised))

    def _look(self, snapshot: Snapshot) -> None:
        coming, left = snapshot.tick + 1, []
        for event, watch in self._waiting:
            start = watch.turn(coming, snapshot)
            if start is not None and start <= coming:
                self._raised |= event
            else:
                left.append((event, watch))
        self._waiting = left


class ScriptedMessages:
    """A rosbridge client of a scenario: its messages go through the console's own decoder, without a socket.

    Attributes:
        refused: why the console did not take one, the first.
    """

    def __init__(self, steps: Sequence[MessageStep], console: ConsoleBridge, tick_hz: int) -> None:
        """Send `steps` to `console`."""
        self._console, self._tick_hz = console, tick_hz
        self._client = console.router.connect("scenario")
        self._waiting = [(step, TriggerWatch(step, tick_hz)) for step in steps]
        self._sending: list[tuple[MessageStep, int]] = []
        self.refused: str | None = None

    def publish(self, snapshot: Snapshot) -> None:
        """Send what is due after a tick."""
        self._console.inputs.tick = snapshot.tick
        self._console.keep_time(snapshot, snapshot.t_ns)
        left = []
        for step, watch in self._waiting:
            start = watch.turn(snapshot.tick, snapshot)
            if start is not None and start <= snapshot.tick:
                self._sending.append((step, snapshot.tick))
            else:
                left.append((step, watch))
        self._waiting = left
        self._sending = [(step, start) for step, start in self._sending if self._send(step, start, snapshot)]

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command with its age, and the edges that came with messages."""
        return self._console.inputs.take(tick)

    def _send(self, step: MessageStep, start: int, snapshot: Snapshot) -> bool:
        """Send a message if it is due; return whether it will be again."""
        since = snapshot.tick - start
        if step.for_s is not None and since >= round(step.for_s * self._tick_hz):
            return False
        period = 1 if step.period_ms is None else max(1, step.period_ms * self._tick_hz // 1000)
        if since % period == 0:
            outcome = self._console.receive_plain(self._client, step.topic, step.message, snapshot.t_ns)
            if outcome.kind not in ("done", "command") and self.refused is None:
                self.refused = f"messages: {step.topic}: tick {snapshot.tick}: {outcome.kind}: {outcome.text}"
        return step.period_ms is not None


def check_messages(steps: Sequence[MessageStep], taken: bool, origin: str) -> None:
    """Refuse messages beside another controller.

    Raises:
        ProfileError: `taken` says that there is one.
    """
    if steps and taken:
        raise ProfileError(f"{origin}: messages: without `remote` and a session in lockstep: one controller at a time")
