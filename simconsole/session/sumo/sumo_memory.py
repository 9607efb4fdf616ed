"""What the core and SUMO's worker share: where the vehicle is, who is where, what signals show, and how it goes."""

from enum import IntEnum
from pathlib import Path
from typing import Final, NamedTuple, Self

from simconsole.processes.byte_slot import ByteSlot
from simconsole.processes.shared_memory import Ring, TextQueue
from simconsole.world.roads.road_map import RoadMap, active
from simconsole.world.roads.running import NONE_RUNNING, RunningNow, changes
from simconsole.world.traffic.road_users import RECORD_WIDTH, Box

ASKED: Final = "sumo.asked"
ANSWERED: Final = "sumo.answered"
SIGNALS: Final = "sumo.signals"
SAID: Final = "sumo.said"
PUSHED: Final = "sumo.pushed"
RING: Final = 64
"""Steps that are remembered: of the older ones nobody asks."""
ERROR_AT: Final = RECORD_WIDTH
"""Where an answer has the ego's error, behind the road users."""
_PUSH_BYTES: Final = 64
_SAID_BYTES: Final = 512
_SIGNAL_BYTES: Final = 512
_LETTER_BYTES: Final = 4
"""Of a link in a phase; own programs may have more of both than the map's."""


class How(IntEnum):
    """What SUMO's worker says, as the number of the piece."""

    STARTING = 0  # nothing yet; a process that finds it is not the first, which has ended while SUMO loaded
    RUNS = 1
    REFUSED = 2  # it cannot begin; the piece says why
    LOST = 3  # it has failed; likewise


class SumoMemory(NamedTuple):
    """The files of the run folder."""

    asked: Ring  # one record a step: the ego's box
    answered: Ring  # the road users after it; stamps: which step's, and how often signals have changed
    signals: ByteSlot  # all of them, numbered by their changes
    said: ByteSlot
    pushed: TextQueue  # who has collided: number and change of speed, JSON

    @classmethod
    def create(cls, folder: Path, road_map: RoadMap) -> Self:
        """Make them, as the core has them.

        Raises:
            WorkerError: one cannot be made.
        """
        return cls(
            asked=Ring.create(folder / ASKED, len(Box._fields), RING),
            answered=Ring.create(folder / ANSWERED, RECORD_WIDTH + 1, RING),
            signals=ByteSlot.create(folder / SIGNALS, signal_bytes(road_map)),
            said=ByteSlot.create(folder / SAID, _SAID_BYTES),
            pushed=TextQueue.create(folder / PUSHED, _PUSH_BYTES, RING),
        )

    @classmethod
    def open(cls, folder: Path) -> Self:
        """Open them, as the worker has them.

        Raises:
            WorkerError: one is not there.
        """
        return cls(
            asked=Ring.open(folder / ASKED),
            answered=Ring.open(folder / ANSWERED, writable=True),
            signals=ByteSlot.open(folder / SIGNALS, writable=True),
            said=ByteSlot.open(folder / SAID, writable=True),
            pushed=TextQueue.open(folder / PUSHED, writable=True),
        )

    def say(self, how: How, why: str = "") -> None:
        """Say how it goes; too long a reason is cut."""
        self.said.write(how, why.encode()[:_SAID_BYTES])


def signal_bytes(road_map: RoadMap) -> int:
    """Return how much room the signals of a map need, as JSON."""
    letters = sum(len(phase.state) for signal in road_map.signals for phase in active(signal).phases)
    return _SIGNAL_BYTES * (len(road_map.signals) + 1) + _LETTER_BYTES * letters


def signals_within(signals: RunningNow, room: int) -> bytes:
    """Return all signals as JSON; where programs are too long for the room, without what comes next."""
    content = changes(NONE_RUNNING, signals) or b"{}"
    if len(content) <= room:
        return content
    return changes(NONE_RUNNING, {name: one._replace(phases=()) for name, one in signals.items()}) or b"{}"
