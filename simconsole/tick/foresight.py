"""Ticks made at once: those whose inputs are all known already, and at which nobody looks in between.

A script, a trace or the pause between two answers of a controller in lockstep: several ticks are then one compiled
call, one block in the log and one look of each output. What comes out is the same to the bit.
"""

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple, Protocol, Self, runtime_checkable

import numpy as np

from simconsole.tick.advance import Console, ConsoleState, advance_block
from simconsole.values.kernels import Row
from simconsole.values.latency import LatencyStatistics
from simconsole.values.protocols import NobodyCommands, NobodySeated, Output
from simconsole.values.signals import NO_AHEAD, AheadInput, Button, Event
from simconsole.values.state_vector import LAYOUT

BLOCK_TICKS: Final = 64
"""At most so many ticks are made at once: more would save next to nothing, and a killed program loses them."""

_SAMPLE: Final = LAYOUT.sample.slice
_ROS: Final = LAYOUT.ros.slice
_ECU: Final = LAYOUT.ecu.slice
_AHEAD: Final = LAYOUT.ahead.slice
_COLLISION_AT: Final = LAYOUT.rules.at("collision")
_EVENTS_AT: Final = LAYOUT.events.at("events")
_EDGES_AT: Final = LAYOUT.driver.at("edges")
_BUTTON_PAUSE: Final = int(Button.PAUSE)
_PAUSE: Final = int(Event.PAUSE)
_COLLISION: Final = int(Event.COLLISION)


@runtime_checkable
class ForeseeingDevices(Protocol):
    """A cockpit whose coming samples are known, like a script's."""

    def foresee(self, tick: int, samples: Row) -> int:
        """Write what `poll` will return for `tick` and the ticks after it into the rows of `samples`.

        It may be asked again for the same ticks. Return for how many it is known; 0: poll.
        """


@runtime_checkable
class ForeseeingCommands(Protocol):
    """A controller whose coming commands are known, like a script's."""

    def foresee(self, tick: int, commands: Row) -> int:
        """Write the commands that `take` will return for `tick` and the ticks after it into the rows of `commands`.

        It may be asked again for the same ticks. Return for how many they are known and no edge comes; 0: take.
        """


@runtime_checkable
class BlockRecorder(Protocol):
    """A recorder that takes several ticks at once."""

    def write_block(self, tick: int, vectors: Row) -> tuple[int, int]:
        """Keep the ticks from `tick` on; return how many, at least one, and the events that the next one brings.

        Those that are not kept, because recording fails, are made again from these events on.
        """


@runtime_checkable
class PatientOutput(Protocol):
    """An output that looks at some ticks only."""

    def unseen(self, tick: int) -> int:
        """Return how many ticks, from `tick` on, it does not look at: `publish` ignores them."""


class _Parts(NamedTuple):
    """The parts of a drive, as far as they foresee."""

    devices: ForeseeingDevices
    ros: ForeseeingCommands
    ecu: ForeseeingCommands
    recorder: BlockRecorder
    outputs: Sequence[PatientOutput]
    ahead: Callable[[], AheadInput] | None  # None: there is nobody
    others: Callable[[], tuple[float, ...]] | None  # None: likewise


class Foresight:
    """Makes blocks of ticks in one drive."""

    def __init__(self, console: Console, parts: _Parts, latencies: LatencyStatistics | None) -> None:
        self._console = console
        self._parts = parts
        self._latencies = latencies
        # A tick changes no input. So who is not there, and says the same for ever, is written once; and what no
        # foreseen tick has, events and impacts, stays 0.
        self._rows = np.zeros((BLOCK_TICKS, console.width))
        self._seated = not isinstance(parts.devices, NobodySeated)
        self._wired = not isinstance(parts.ecu, NobodyCommands)
        parts.devices.foresee(1, self._rows[:, _SAMPLE])
        parts.ecu.foresee(1, self._rows[:, _ECU])
        self._rows[:, _AHEAD] = NO_AHEAD

    @classmethod
    def of(
        cls,
        console: Console,
        sources: tuple[object, object, object],
        recorder: object,
        outputs: Sequence[Output],
        latencies: LatencyStatistics | None,
        ahead: Callable[[], AheadInput] | None,
        others: Callable[[], tuple[float, ...]] | None = None,
    ) -> Self | None:
        """Return the foresight of a drive with these devices, commands of ROS side and ECU; None if a part has none.

        `ahead` says whom the vehicle follows, None if there is nobody on the road; `others` where the session's other
        platforms are, None if it has one.
        """
        devices, ros, ecu = sources
        if not (
            isinstance(devices, ForeseeingDevices)
            and isinstance(ros, ForeseeingCommands)
            and isinstance(ecu, ForeseeingCommands)
            and isinstance(recorder, BlockRecorder)
        ):
            return None
        patient = [output for output in outputs if isinstance(output, PatientOutput)]
        if len(patient) < len(outputs):
            return None
        return cls(
            console,
            _Parts(devices=devices, ros=ros, ecu=ecu, recorder=recorder, outputs=patient, ahead=ahead, others=others),
            latencies,
        )

    def advance(self, state: ConsoleState, end: int) -> tuple[ConsoleState, int]:
        """Make the coming ticks that are foreseen, up to `end`, and record them.

        Returns: the state after them, `state` itself if there are none, and the events that the next tick brings.
        """
        count = self._foreseen(state.tick + 1, end)
        if count < 1:
            return state, 0
        rows = self._rows[:count]
        if self._parts.ahead is not None:
            rows[:, _AHEAD] = self._parts.ahead()  # the same until the last tick's outputs have looked
        if self._parts.others is not None:
            rows[:, -self._console.others :] = self._parts.others()  # likewise, until all platforms have made the ticks
        advance_block(state.vector, rows, self._console)
        if self._seated:
            count = _up_to_pause(rows)
        count = _up_to_touch(state.vector, rows[:count])
        kept, events = self._parts.recorder.write_block(state.tick + 1, rows[:count])
        events |= first_touch(rows[kept - 2] if kept > 1 else state.vector, rows[kept - 1])
        last = rows[kept - 1].copy()
        if self._seated and int(last[_EDGES_AT]) & _BUTTON_PAUSE:
            events |= _PAUSE
        return ConsoleState(state.tick + kept, last), events

    def _foreseen(self, tick: int, end: int) -> int:
        """Return how many ticks from `tick` on are foreseen, their inputs being in the rows."""
        parts, rows = self._parts, self._rows
        count = min(end - tick + 1, BLOCK_TICKS)
        if self._latencies is not None:
            count = min(count, self._latencies.unseen(tick))
        for output in parts.outputs:
            count = min(count, output.unseen(tick) + 1)  # the last tick of a block is published
        if count > 0 and self._seated:
            count = parts.devices.foresee(tick, rows[:count, _SAMPLE])
        if count > 0:
            count = parts.ros.foresee(tick, rows[:count, _ROS])
        if count > 0 and self._wired:
            count = parts.ecu.foresee(tick, rows[:count, _ECU])
        return count


def _up_to_pause(rows: Row) -> int:
    """Return how many of these ticks there are up to the first in which the button for a pause is pressed."""
    edges = rows[:, _EDGES_AT]
    if not np.count_nonzero(edges):
        return len(rows)
    pressed = np.flatnonzero(edges.astype(np.int64) & _BUTTON_PAUSE)
    return int(pressed[0]) + 1 if len(pressed) else len(rows)


def first_touch(before: Row, after: Row) -> int:
    """Return the event that a fixed thing is touched in a tick; who touches a road user is told with the impulse."""
    if not after[_COLLISION_AT] or before[_COLLISION_AT] or int(after[_EVENTS_AT]) & _COLLISION:
        return 0
    return _COLLISION


def _up_to_touch(before: Row, rows: Row) -> int:
    """Return how many of these ticks there are up to the first in which a fixed thing is touched, all without one."""
    told = rows[:, _COLLISION_AT]
    if not np.count_nonzero(told):
        return len(rows)
    rises = np.flatnonzero(np.diff(told, prepend=before[_COLLISION_AT]) > 0.0)
    return int(rises[0]) + 1 if len(rises) else len(rows)
