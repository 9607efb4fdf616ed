"""The loop of one drive: inputs in, one tick, outputs out. It opens and closes nothing (session.py does)."""

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

from simconsole.ledger import Hop, Ledger, unheard
from simconsole.pipeline import Console, ConsoleState, advance
from simconsole.ports import CommandSource, DeviceSource, NobodyCommands, Seat, Station
from simconsole.rows import Snapshot, TickInputs
from simconsole.signals import EventInput


class Recorder(Protocol):
    """Where every tick goes first."""

    def write(self, snapshot: Snapshot) -> None:
        """Keep one tick; a failing disk must not raise."""


class Pace(Protocol):
    """When the next tick is due."""

    def wait(self) -> int:
        """Sleep until the next tick and return the events (mask) that pacing itself raised."""


class Faults(Protocol):
    """Who puts faults into a drive, for tests."""

    def turn(self, tick: int, before: Snapshot) -> float:
        """Decide which faults are on in the coming `tick`; return them as a mask."""


class Cast(NamedTuple):
    """Everyone who takes part in a drive."""

    devices: DeviceSource
    commands: CommandSource  # of the ROS side
    recorder: Recorder
    stations: Sequence[Station]
    pace: Pace
    seat: Seat | None = None
    faults: Faults | None = None
    ecu: CommandSource = NobodyCommands()
    ledger: Ledger | None = None


def run(
    console: Console,
    state: ConsoleState,
    cast: Cast,
    ticks: int,
    finished: Callable[[Snapshot], bool] = lambda snapshot: False,
) -> ConsoleState:
    """Drive until `ticks` have passed or `finished` says so; return the last state.

    The order is fixed: pace, seat, faults, devices, commands, advance, recorder, stations. Everything that enters
    `advance` is in the row that the recorder keeps, so that the drive replays.
    """
    snapshot = Snapshot(state.tick, console.tick_hz, state.row)
    end, ledger = state.tick + ticks, cast.ledger
    stations = [(station, getattr(station, "hop", Hop.OTHERS)) for station in cast.stations]
    while state.tick < end and not finished(snapshot):
        raised = cast.pace.wait()
        if cast.seat is not None:
            cast.seat.act(snapshot)
        coming = state.tick + 1
        mark = unheard if ledger is None else ledger.begin(coming)
        faults = 0.0 if cast.faults is None else cast.faults.turn(coming, snapshot)
        sample = cast.devices.poll(coming)
        if ledger is not None:
            ledger.sample(sample)
        mark(Hop.READ)
        ros, events = cast.commands.take(coming)
        ecu, ecu_events = cast.ecu.take(coming)
        mark(Hop.TAKE)
        edges = EventInput(float(int(events.events) | raised), faults, ecu_events.events)
        state, snapshot = advance(state, TickInputs(sample, ros, edges, ecu), console, mark)
        cast.recorder.write(snapshot)
        mark(Hop.RECORD)
        for station, hop in stations:
            station.publish(snapshot)
            mark(hop)
    return state
