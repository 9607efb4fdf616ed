"""Faults between a controller and the arbiter: each turns a good command into a wrong one, or into none. Pure."""

from collections.abc import Sequence
from typing import Final, Protocol

from simconsole.faults.switched import Switched
from simconsole.profiles.faults import Astray, Disconnected, Fault, LateCommands, NotFinite, Refused, Silent
from simconsole.values.protocols import CommandSource
from simconsole.values.signals import NEVER_TICKS, Event, EventInput, RemoteCommand
from simconsole.values.units import RAD_PER_DEG

_STOPPING: Final = (Silent, Disconnected, Refused)
"""Faults under which no new command is taken."""


class ArmedFault(Protocol):
    """A fault of the list and its switch."""

    @property
    def fault(self) -> Fault:
        """The fault's profile."""

    @property
    def switch(self) -> Switched:
        """Whether it is on, and for how long."""


class FaultyCommands:
    """A command source whose commands pass through faults, in the order of the list."""

    def __init__(self, source: CommandSource, armed: Sequence[ArmedFault], tick_hz: int) -> None:
        self._source = source
        self._armed = armed
        self._tick_hz = tick_hz
        self._held: tuple[RemoteCommand, int] | None = None  # the last accepted command, and its tick
        self._refused = 0.0

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the command that the arbiter gets after all faults, and the edges since the last call."""
        command, events = self._source.take(tick)
        on = [entry for entry in self._armed if entry.switch.ticks > 0]
        if any(isinstance(entry.fault, _STOPPING) for entry in on):
            command = self._stopped(command, tick, any(isinstance(entry.fault, Refused) for entry in on))
        else:
            self._held = command, tick
            command = command._replace(refused=command.refused + self._refused)
        raised = 0
        for entry in on:
            fault = entry.fault
            if isinstance(fault, Disconnected) and entry.switch.ticks == 1:
                raised |= int(Event.COMMANDER_LOST)
            elif isinstance(fault, LateCommands):
                late = min(NEVER_TICKS, command.age_ticks + round(fault.by_ms * self._tick_hz / 1000.0))
                command = command._replace(age_ticks=float(late))
            elif isinstance(fault, NotFinite):
                command = command._replace(road_wheel_rad=float("nan"))
            elif isinstance(fault, Astray):
                command = command._replace(road_wheel_rad=fault.road_wheel_deg * RAD_PER_DEG)
        return command, EventInput(float(int(events.events) | raised))

    def _stopped(self, command: RemoteCommand, tick: int, refusing: bool) -> RemoteCommand:
        """Return the last accepted command with its age now; later ones count as refused, or as never received."""
        held, since = (command, tick) if self._held is None else self._held
        self._held = held, since
        if refusing:
            self._refused = max(self._refused, command.sequence - held.sequence)
        age = min(NEVER_TICKS, held.age_ticks + (tick - since))
        return held._replace(age_ticks=age, refused=held.refused + self._refused)
