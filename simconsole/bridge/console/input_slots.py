"""The newest accepted command and the edges since the last tick: latest wins, however many arrive between two ticks."""

from collections.abc import Callable
from typing import Final, NamedTuple

from simconsole.values.signals import NEVER_TICKS, NO_COMMAND, NO_EVENTS, Event, EventInput, RemoteCommand
from simconsole.values.units import NS_PER_S

_ASKED_FROM: Final = RemoteCommand._fields.index("road_wheel_rad")
_ASKED_TO: Final = RemoteCommand._fields.index("direction")
"""What a command asks for lies between; numbers and age before it, direction and lights behind it are the slot's."""
OnCommand = Callable[[RemoteCommand, int | None], None]
"""Takes the command, its age 0, and when it was received in ns (None before the first)."""
OnEvents = Callable[[int], None]
"""Takes a mask of `signals.Event`."""


class BridgeInputs:
    """A slot for the command and a mask for the events.

    `on_command` and `on_events` see each change at once: the bridge's own process passes writers of shared memory.
    A core that serves the sockets itself calls `take` instead.
    """

    def __init__(self, on_command: OnCommand | None = None, on_events: OnEvents | None = None) -> None:
        """Start with no command and no events."""
        self.command = NO_COMMAND
        self.receipt_ns: int | None = None
        self.stamp_ns: int | None = None
        """The stamp of the newest command, None if it had none."""
        self.tick = 0
        """The last finished tick, set by whoever calls `take`."""
        self.lost_at: float | None = None
        """The command's sequence number when its commander vanished."""
        self._receipt_tick = 0
        self._events = 0
        self._on_command = on_command
        self._on_events = on_events

    def accept(self, command: RemoteCommand, stamp_ns: int | None, now_ns: int) -> None:
        """Put a command into the slot; sequence, refusals, direction, lights and age are this slot's, not the caller's.

        Args:
            command: kind and values; a direction other than 0 is kept for later commands too.
            stamp_ns: the message's own stamp, None without.
            now_ns: when it was received.
        """
        before = self.command
        # In one piece: `_replace` looks up each of the fields by its name.
        numbers = before.sequence + 1.0, before.refused
        lights = before.turn_indicators, before.hazard_lights
        direction = command.direction or before.direction
        self.command = RemoteCommand._make(
            (command.kind, *numbers, 0.0, *command[_ASKED_FROM:_ASKED_TO], direction, *lights)
        )
        self.receipt_ns, self.stamp_ns, self._receipt_tick = now_ns, stamp_ns, self.tick
        self._announce()

    def refuse(self) -> None:
        """Count a refused command."""
        self.command = self.command._replace(refused=self.command.refused + 1.0)
        self._announce()

    def keep(self, **settings: float) -> None:
        """Set what later commands keep: direction of travel or lights. It neither renews the age nor counts as one."""
        self.command = self.command._replace(**settings)
        self._announce()

    def raise_events(self, events: int) -> None:
        """Add edges, a mask of `signals.Event`."""
        self._events |= events
        if self._on_events is not None:
            self._on_events(events)

    def lose(self) -> None:
        """Note that the commander is gone: an event, and no answer of theirs is to be waited for."""
        self.lost_at = self.command.sequence
        self.raise_events(int(Event.COMMANDER_LOST))

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the command with its age for the coming `tick`, and the events since the last call.

        A command received after tick k has age 0 in tick k + 1.
        """
        events, self._events = self._events, 0
        command = self.command
        if self.receipt_ns is not None and tick - 1 > self._receipt_tick:  # fresh, its age is 0 already
            command = command._replace(age_ticks=float(tick - 1 - self._receipt_tick))
        return command, EventInput(float(events)) if events else NO_EVENTS

    def _announce(self) -> None:
        if self._on_command is not None:
            self._on_command(self.command, self.receipt_ns)


class Question(NamedTuple):
    """Odometry that has gone out, and what answers it: a newer command with its stamp, or without any."""

    inputs: BridgeInputs
    sequence: float
    """Of the newest command before."""
    stamp_ns: int | None
    """Of the odometry; None: none has gone out, and no answer is waited for."""

    @property
    def is_answered(self) -> bool:
        """Whether the answer has come, or none is waited for."""
        if self.stamp_ns is None:
            return True
        return self.inputs.command.sequence != self.sequence and self.inputs.stamp_ns in (self.stamp_ns, None)

    @property
    def is_settled(self) -> bool:
        """Whether there is nothing more to wait for: an answer is here, or the commander is gone."""
        return self.is_answered or self.inputs.command.sequence == self.inputs.lost_at


def with_age(command: RemoteCommand, receipt_ns: int | None, now_ns: int, tick_hz: int) -> RemoteCommand:
    """Return a command with its age in whole ticks at `now_ns`, both times from one monotonic clock."""
    if receipt_ns is None:
        return command._replace(age_ticks=NEVER_TICKS)
    return command._replace(age_ticks=float(max(0, now_ns - receipt_ns) * tick_hz // NS_PER_S))
