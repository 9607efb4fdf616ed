"""Measurements that are told late, by different times, or never: between the state and its topics."""

from operator import itemgetter
from typing import Final, Generic, TypeVar
from zlib import crc32

from simconsole.bridge.link.ways import Draws, ticks_on_the_way
from simconsole.profiles.link import LinkProfile
from simconsole.values.draws import Channel

Told = TypeVar("Told")
_TICK_BITS: Final = 40


class LateMeasurements(Generic[Told]):
    """What a controller is told of the car, on its way to it. Each topic's messages are lost and late by themselves."""

    def __init__(self, link: LinkProfile) -> None:
        self._way = link.measurements
        self._draws = Draws(link.seed, Channel.MEASUREMENT_JITTER, Channel.MEASUREMENT_LOSS)
        self._under_way: list[tuple[int, Told]] = []  # (tick of arrival, what is told), in the order of sending

    def send(self, topic: str, tick: int, tick_hz: int, told: Told) -> None:
        """Send what `topic` tells of `tick`."""
        late = ticks_on_the_way(self._way, self._draws, crc32(topic.encode()) << _TICK_BITS | tick, tick_hz)
        if late is not None:
            self._under_way.append((tick + late, told))

    def arrived(self, tick: int) -> list[Told]:
        """Return what has arrived by `tick` and was not returned before, in the order in which it came."""
        here = sorted((entry for entry in self._under_way if entry[0] <= tick), key=itemgetter(0))
        self._under_way = [entry for entry in self._under_way if entry[0] > tick]
        return [told for _, told in here]
