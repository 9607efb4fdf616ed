"""A scripted controller: the remote commands and events of a scenario, tick by tick. Pure."""

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from simconsole.profiles.scenario import EventStep, RemoteStep
from simconsole.values.input_table import InputTable
from simconsole.values.kernels import Row
from simconsole.values.signals import NO_COMMAND, Event, EventInput, RemoteCommand, RemoteKind
from simconsole.values.units import RAD_PER_DEG

_AGE_AT: Final = RemoteCommand._fields.index("age_ticks")


class ScriptedCommands:
    """Plays `RemoteStep`s and `EventStep`s; a command repeats every period and ages in between, as over a network.

    Time only goes forward, tick by tick; one that has been asked for may be asked for again.
    """

    def __init__(self, remote: Sequence[RemoteStep], events: Sequence[EventStep], tick_hz: int) -> None:
        self._steps = [_repeated(step, tick_hz) for step in sorted(remote, key=lambda step: step.start_s)]
        self._edges: dict[int, int] = {}
        for step in events:
            if step.at_s is None:
                continue  # it waits for what happens in the drive (session/scripted/events.py)
            tick = round(step.at_s * tick_hz) + round(step.delay_s * tick_hz)
            self._edges[tick] = self._edges.get(tick, 0) | int(Event[step.event.upper()])
        self._sequence = 0
        self._received_tick: int | None = None
        self._command = NO_COMMAND
        self._table = InputTable(len(NO_COMMAND), self._fill)

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the command in force at `tick`, its age, and this tick's edges."""
        return RemoteCommand(*self._table.values(tick)), EventInput(float(self._edges.get(tick, 0)))

    def foresee(self, tick: int, commands: Row) -> int:
        """Write the commands in force from `tick` on into rows, up to the next edge; return how many."""
        if self._edges:
            quiet = min((edge - tick for edge in self._edges if edge >= tick), default=len(commands))
            commands = commands[:quiet]
        return self._table.foresee(tick, commands) if len(commands) else 0

    def _fill(self, tick: int, rows: Row) -> None:
        end = tick + len(rows)
        while tick < end:
            self._send(tick)
            until = int(min((end, *(step.next(tick + 1) for step in self._steps))))
            some = rows[tick - end : until - end or None]
            some[:] = self._command
            if self._received_tick is not None:
                some[:, _AGE_AT] = np.arange(tick - self._received_tick, until - self._received_tick)
            tick = until

    def _send(self, tick: int) -> None:
        for step in self._steps:
            if step.next(tick) == tick:
                self._sequence += 1
                self._received_tick = tick
                self._command = _command(step.step, self._sequence)


class _Repeated(NamedTuple):
    """A step in ticks: sent at `start` and every `period` after it, before `end`."""

    step: RemoteStep
    start: int
    end: int
    period: int

    def next(self, tick: int) -> float:
        """Return the first tick, from `tick` on, at which it is sent; infinity if it is not."""
        at = max(self.start, tick + (self.start - tick) % self.period)
        return at if at < self.end else math.inf


def _repeated(step: RemoteStep, tick_hz: int) -> _Repeated:
    period = max(1, step.period_ms * tick_hz // 1000)
    return _Repeated(step, round(step.start_s * tick_hz), round(step.end_s * tick_hz), period)


def _command(step: RemoteStep, sequence: int) -> RemoteCommand:
    return NO_COMMAND._replace(
        kind=float(RemoteKind[step.kind.upper()]),
        sequence=float(sequence),
        road_wheel_rad=step.road_wheel_deg * RAD_PER_DEG,
        accel_mps2=step.accel_mps2,
        speed_mps=step.speed_mps,
        yaw_rate_radps=step.yaw_rate_radps,
        throttle=step.throttle,
        brake=step.brake,
        x_m=step.x_m,
        y_m=step.y_m,
        direction=float(step.direction),
        turn_indicators=float(step.turn_indicators),
        hazard_lights=float(step.hazard_lights),
    )
