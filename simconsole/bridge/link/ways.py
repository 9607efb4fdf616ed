"""When a message arrives that takes its time, a time of its own, or never arrives."""

from typing import NamedTuple

from simconsole.profiles.link import WayProfile
from simconsole.values.draws import Channel, even


class Draws(NamedTuple):
    """What is drawn for the messages of one way."""

    seed: int
    jitter: Channel
    loss: Channel


def ticks_on_the_way(way: WayProfile, draws: Draws, number: int, tick_hz: int) -> int | None:
    """Return how many ticks the message of this `number` takes; None: it is lost."""
    if way.loss_share and even(draws.seed, draws.loss, number) < way.loss_share:
        return None
    late_ms = way.delay_ms
    if way.jitter_ms:
        late_ms += way.jitter_ms * even(draws.seed, draws.jitter, number)
    return round(late_ms * tick_hz / 1000.0)
