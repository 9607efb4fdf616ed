"""Whose commands drive: the ROS side's or the CAN bus's, as `features.commander` says, for the whole drive.

The rule is as simple as it can be while arbitration has one remote slot: the chosen side's commands are the remote
command. The other side's are not seen; of its edges all count but the loss of a commander that does not command.
(The CAN node itself passes on only the emergency stop when it is not chosen.)
"""

from simconsole.ports import CommandSource
from simconsole.signals import Event, EventInput, RemoteCommand

_NOT_OTHERS = ~int(Event.COMMANDER_LOST | Event.NO_ANSWER)


class Commander:
    """Two command sources as one."""

    def __init__(self, chosen: CommandSource, other: CommandSource) -> None:
        self._chosen = chosen
        self._other = other

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the chosen side's newest command, and all edges of both."""
        command, events = self._chosen.take(tick)
        _, others = self._other.take(tick)
        mask = int(events.events) | (int(others.events) & _NOT_OTHERS)
        return command, EventInput(events=float(mask))
