"""Faults between a controller and the arbiter: each turns a good command into a wrong one, or into none. Pure."""

from collections.abc import Sequence
from typing import Final, Protocol

from simconsole.bridge.link.delay import CommandsUnderWay
from simconsole.faults.switched import Switched
from simconsole.profiles.faults import (
    Astray,
    DelayedCommands,
    Disconnected,
    Fault,
    LateCommands,
    NotFinite,
    Refused,
    Silent,
)
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
        self._held: tuple[RemoteCommand, int] | None = None  # the last accepted command, and its tick
        self._refused = 0.0
        self._tick_hz = tick_hz
        delayed = (at for at, entry in enumerate(armed) if isinstance(entry.fault, DelayedCommands))
        self._under_way = {at: CommandsUnderWay() for at in delayed}  # by the fault's place in the list

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
        for at, entry in enumerate(self._armed):
            fault, is_on = entry.fault, entry.switch.ticks > 0
            if isinstance(fault, DelayedCommands):  # also while it is off: it hears what is sent before
                late = self._ticks(fault.by_ms) if is_on else 0
                command = _delayed(self._under_way[at], command, tick, late)
            elif not is_on:
                continue
            elif isinstance(fault, Disconnected) and entry.switch.ticks == 1:
                raised |= int(Event.COMMANDER_LOST)
            elif isinstance(fault, LateCommands):
                command = _older(command, self._ticks(fault.by_ms))
            elif isinstance(fault, NotFinite):
                command = command._replace(road_wheel_rad=float("nan"))
            elif isinstance(fault, Astray):
                command = command._replace(road_wheel_rad=fault.road_wheel_deg * RAD_PER_DEG)
        return command, EventInput(float(int(events.events) | raised))

    def _ticks(self, time_ms: float) -> int:
        return round(time_ms * self._tick_hz / 1000.0)

    def _stopped(self, command: RemoteCommand, tick: int, refusing: bool) -> RemoteCommand:
        """Return the last accepted command with its age now; later ones count as refused, or as never received."""
        held, since = (command, tick) if self._held is None else self._held
        self._held = held, since
        if refusing:
            self._refused = max(self._refused, command.sequence - held.sequence)
        age = min(NEVER_TICKS, held.age_ticks + (tick - since))
        return held._replace(age_ticks=age, refused=held.refused + self._refused)


def _older(command: RemoteCommand, ticks: int) -> RemoteCommand:
    return command._replace(age_ticks=float(min(NEVER_TICKS, command.age_ticks + ticks)))


def _delayed(under_way: CommandsUnderWay, command: RemoteCommand, tick: int, late: int) -> RemoteCommand:
    """Return what has arrived by `tick`: a command that is new arrives `late` ticks later, and older by that."""
    if under_way.is_new(command):
        under_way.send(_older(command, late), tick + late)
    under_way.turn(tick)
    return under_way.now(command, tick)
