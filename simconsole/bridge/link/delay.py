"""Commands that act late, late by different times, or never: between what a controller sent and the command slot."""

from collections.abc import Callable
from typing import Final

from simconsole.bridge.link.ways import Draws, ticks_on_the_way
from simconsole.profiles.link import LinkProfile
from simconsole.values.draws import Channel
from simconsole.values.kernels import Row
from simconsole.values.protocols import CommandSource
from simconsole.values.signals import NO_COMMAND, EventInput, RemoteCommand

_AGE_AT: Final = RemoteCommand._fields.index("age_ticks")


class CommandsUnderWay:
    """Commands between their sending and their arrival; one that a later one has overtaken is dropped."""

    def __init__(self) -> None:
        self._seen = 0.0
        self._under_way: list[tuple[int, RemoteCommand]] = []  # (tick of arrival, command), in the order of sending
        self._arrived = (0, NO_COMMAND)

    def is_new(self, newest: RemoteCommand) -> bool:
        """Whether a command is another one than was seen last, and remember it as seen."""
        is_new = newest.sequence != self._seen
        self._seen = newest.sequence
        return is_new

    def send(self, command: RemoteCommand, arrival: int) -> None:
        """Send a command that arrives in the tick `arrival`, then of the age that it says."""
        self._under_way.append((arrival, command))

    def turn(self, tick: int) -> None:
        """Take what has arrived by `tick`."""
        self._arrived = self._arrived_by(tick)
        arrived = self._arrived[1].sequence  # what was sent before it and comes later is out of order
        self._under_way = [entry for entry in self._under_way if entry[1].sequence > arrived]

    def now(self, newest: RemoteCommand, tick: int) -> RemoteCommand:
        """Return what has arrived by `tick`, aged since, with what does not travel with a command: see `newest`."""
        settings = {
            "refused": newest.refused,
            "turn_indicators": newest.turn_indicators,
            "hazard_lights": newest.hazard_lights,
        }
        arrival, command = self._arrived_by(tick)
        if not command.sequence:
            return NO_COMMAND._replace(**settings)
        return command._replace(age_ticks=command.age_ticks + (tick - arrival), **settings)

    def _arrived_by(self, tick: int) -> tuple[int, RemoteCommand]:
        """Return the newest command that arrives by `tick`, and when it does."""
        here = [entry for entry in self._under_way if entry[0] <= tick]
        return here[-1] if here else self._arrived


class CommandsOverLink:
    """A command source whose commands take `delay_ms` and more to arrive. Edges and refusals pass at once.

    The delay runs from the tick before that in which the command is seen first: in lockstep that is the tick whose
    state it answers.
    """

    def __init__(self, source: CommandSource, link: LinkProfile, tick_hz: int) -> None:
        self._source = source
        self._link = link
        self._draws = Draws(link.seed, Channel.JITTER, Channel.LOSS)
        self._tick_hz = tick_hz
        self._commands = CommandsUnderWay()
        self._foresee: Callable[[int, Row], int] | None = getattr(source, "foresee", None)

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command that has arrived, aged since then, and all edges since the last call."""
        newest, events = self._source.take(tick)
        return self._heard(newest, tick), events

    def foresee(self, tick: int, commands: Row) -> int:
        """Write what `take` will return for `tick` and the ticks after it, as far as the source foresees its own."""
        count = 0 if self._foresee is None else self._foresee(tick, commands)
        if count < 1:
            return 0
        sent = commands[:count].copy()
        changed = sent != sent[0]
        changed[:, _AGE_AT] = False
        if changed.any():
            count = int(changed.any(axis=1).argmax())
        newest = RemoteCommand(*sent[0].tolist())
        commands[0] = self._heard(newest, tick)
        for at in range(1, count):
            commands[at] = self._commands.now(newest, tick + at)
        return count

    def _heard(self, newest: RemoteCommand, tick: int) -> RemoteCommand:
        """Take what was sent and what has arrived, where `newest` is the newest command that was sent; return it."""
        if self._commands.is_new(newest):
            late = ticks_on_the_way(self._link, self._draws, int(newest.sequence), self._tick_hz)
            if late is not None:
                self._commands.send(newest, max(tick, tick - 1 + late))
        self._commands.turn(tick)
        return self._commands.now(newest, tick)


def over_link(source: CommandSource, link: LinkProfile, tick_hz: int) -> CommandSource:
    """Return the source as the arbiter sees it over this link: itself, where the link delays and loses nothing."""
    if link.delay_ms or link.jitter_ms or link.loss_share:
        return CommandsOverLink(source, link, tick_hz)
    return source
