"""Commands that act late, late by different times, or never: between what a controller sent and the command slot."""

from simconsole.profiles.link import LinkProfile
from simconsole.values.draws import Channel, even
from simconsole.values.protocols import CommandSource
from simconsole.values.signals import NO_COMMAND, EventInput, RemoteCommand


class LateCommands:
    """A command source whose commands take `delay_ms` and more to arrive. Edges and refusals pass at once.

    The delay runs from the tick before that in which the command is seen first: in lockstep that is the tick whose
    state it answers.
    """

    def __init__(self, source: CommandSource, link: LinkProfile, tick_hz: int) -> None:
        self._source = source
        self._link = link
        self._tick_hz = tick_hz
        self._seen = 0.0
        self._under_way: list[tuple[int, RemoteCommand]] = []  # (tick of arrival, command), in the order of sending
        self._arrived = NO_COMMAND
        self._arrival = 0

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command that has arrived, aged since then, and all edges since the last call."""
        newest, events = self._source.take(tick)
        return self._heard(newest, tick), events

    def _heard(self, newest: RemoteCommand, tick: int) -> RemoteCommand:
        """Return what has arrived, where `newest` is the newest command that was sent."""
        if newest.sequence != self._seen:
            self._seen = newest.sequence
            if not self._is_lost(newest):
                self._under_way.append((self._arrival_of(newest, tick), newest))
        here = [entry for entry in self._under_way if entry[0] <= tick]
        if here:
            arrival, command = here[-1]  # what was sent before it and comes later is out of order
            self._under_way = [entry for entry in self._under_way if entry[1].sequence > command.sequence]
            self._arrived, self._arrival = command, arrival
        return self._now(newest, tick)

    def _is_lost(self, command: RemoteCommand) -> bool:
        share = self._link.loss_share
        return share > 0.0 and even(self._link.seed, Channel.LOSS, int(command.sequence)) < share

    def _arrival_of(self, command: RemoteCommand, tick: int) -> int:
        late_ms = self._link.delay_ms
        if self._link.jitter_ms:
            late_ms += self._link.jitter_ms * even(self._link.seed, Channel.JITTER, int(command.sequence))
        return max(tick, tick - 1 + round(late_ms * self._tick_hz / 1000.0))

    def _now(self, newest: RemoteCommand, tick: int) -> RemoteCommand:
        """Return the arrived command as of `tick`, with what does not travel with a command: refusals and lights."""
        settings = {
            "refused": newest.refused,
            "turn_indicators": newest.turn_indicators,
            "hazard_lights": newest.hazard_lights,
        }
        if not self._arrived.sequence:
            return NO_COMMAND._replace(**settings)
        age = self._arrived.age_ticks + (tick - self._arrival)
        return self._arrived._replace(age_ticks=age, **settings)


def over_link(source: CommandSource, link: LinkProfile, tick_hz: int) -> CommandSource:
    """Return the source as the arbiter sees it over this link: itself, where the link delays and loses nothing."""
    if link.delay_ms or link.jitter_ms or link.loss_share:
        return LateCommands(source, link, tick_hz)
    return source
