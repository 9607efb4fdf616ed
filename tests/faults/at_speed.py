"""A car that a controller drives straight on at 13 m/s, with a person whose hands and feet rest: a start for faults."""

from functools import cache
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.profiles.files.loader import parse
from simconsole.profiles.session import SessionProfile
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.resolution import override, resolve
from simconsole.tick.advance import Console, ConsoleState
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.tick.loop import Components, run
from simconsole.values.host.jit import compiled
from simconsole.values.protocols import CommandSource
from simconsole.values.signals import (
    NO_COMMAND,
    NO_EVENTS,
    DeviceSample,
    Event,
    EventInput,
    Mode,
    Reason,
    RemoteCommand,
    RemoteKind,
)
from simconsole.values.state_vector import Snapshot

SESSION: Final = "schema: 1\nscenario: {vehicle: hatchback}\ndevices: {driver: none}\n"
SPEED_MPS: Final = 13.0
ENGAGED_S: Final = 2.0
READY_S: Final = 14.0
STALE_S: Final = 0.2
LEFT_WITHIN_S: Final = STALE_S + 0.010
"""And a tick: how long after the last plausible command the car may be AUTONOMOUS."""


class Seated:
    """A person with hands and feet at rest."""

    def __init__(self, resolved: ResolvedSession, tick_hz: int) -> None:
        self._rest = raw_sample(Intent(), cockpit_settings(resolved.cockpit, tick_hz))

    def poll(self, tick: int) -> DeviceSample:
        return self._rest

    def close(self) -> None:
        pass


class Steady:
    """A controller that drives straight on and never fails; autonomy is asked for at 2 s."""

    def __init__(self, tick_hz: int) -> None:
        self._tick_hz = tick_hz

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        events = EventInput(float(Event.REQUEST_AUTONOMOUS)) if tick == ENGAGED_S * self._tick_hz else NO_EVENTS
        return said(tick, 0.0, 1.0 + max(0.0, 1.5 * (tick / self._tick_hz - ENGAGED_S))), events


def said(tick: int, road_wheel_rad: float, speed_mps: float = SPEED_MPS) -> RemoteCommand:
    """Return a command that has come in a tick."""
    return NO_COMMAND._replace(
        kind=float(RemoteKind.SPEED),
        sequence=float(tick),
        age_ticks=0.0,
        road_wheel_rad=road_wheel_rad,
        speed_mps=min(SPEED_MPS, speed_mps),
    )


class Driven(NamedTuple):
    """Rows of a drive, the one before its first tick too: row i is that of tick `start` + i."""

    vectors: Any
    columns: tuple[str, ...]
    wheelbase_m: float

    def column(self, name: str) -> Any:
        return self.vectors[:, self.columns.index(name)]


class Ready(NamedTuple):
    """A console with its car at speed, AUTONOMOUS."""

    resolved: ResolvedSession
    console: Console
    state: ConsoleState

    def drive(self, controller: CommandSource, seconds: float) -> Driven:
        """Drive on with another controller."""
        console, ticks = self.console, round(seconds * self.console.tick_hz)
        recorder = MemoryRecorder(ticks, console.width)
        components = Components(Seated(self.resolved, console.tick_hz), controller, recorder, (), UnpacedPacer())
        run(console, ConsoleState(self.state.tick, self.state.vector.copy()), components, ticks)
        return Driven(np.vstack((self.state.vector, recorder.vectors)), console.columns, console.platform.wheelbase_m)


@cache
def ready(tick_hz: int) -> Ready:
    """Return the console of a rate, its car at speed."""
    resolved = resolve(override(parse(SESSION, SessionProfile, "session"), mode={"tick_hz": tick_hz}))
    console, state = assemble(resolved, compiled)
    ticks = round(READY_S * tick_hz)
    recorder = MemoryRecorder(ticks, console.width)
    components = Components(Seated(resolved, tick_hz), Steady(tick_hz), recorder, (), UnpacedPacer())
    state = run(console, state, components, ticks)
    snapshot = Snapshot(state.tick, tick_hz, state.vector)
    assert snapshot.arbitration.mode == Mode.AUTONOMOUS, Reason(int(snapshot.arbitration.reason))
    assert snapshot.vehicle.vx_mps > 0.9 * SPEED_MPS
    return Ready(resolved, console, ConsoleState(state.tick, state.vector.copy()))
