"""The loop of one drive: inputs in, one tick, outputs out. It opens and closes nothing (session/lifecycle.py does)."""

from collections.abc import Callable, Iterator, Sequence
from typing import Final, NamedTuple, Protocol

from simconsole.tick.advance import Console, ConsoleState, advance, looked_ahead
from simconsole.tick.foresight import Foresight, first_touch
from simconsole.values.latency import Hop, LatencyStatistics, unheard
from simconsole.values.protocols import CommandSource, DeviceSource, NobodyCommands, Output, Seat
from simconsole.values.signals import (
    NO_AHEAD,
    NO_COMMAND,
    NO_EVENTS,
    NO_IMPACT,
    NO_SAMPLE,
    AheadInput,
    Button,
    Event,
    EventInput,
    ImpactInput,
)
from simconsole.values.state_vector import Snapshot, TickInputs


class Recorder(Protocol):
    """Gets every finished tick, before the outputs."""

    def write(self, snapshot: Snapshot) -> int:
        """Keep one tick and return the events (mask) that the next one brings; a failing disk must not raise."""


class Pace(Protocol):
    """When the next tick is due. One with a true attribute `never_waits` may be left out of foreseen ticks."""

    def wait(self) -> int:
        """Sleep until the next tick and return the events (mask) that pacing itself raised."""


class RoadUsers(Protocol):
    """Everybody else on the road."""

    def ahead(self) -> AheadInput:
        """Return whom the vehicle follows, as of the last step."""

    def take_impact(self) -> ImpactInput:
        """Return what a collision has done to the vehicle since the last call."""


class Faults(Protocol):
    """The schedule of the faults that a scenario puts into a drive."""

    def turn(self, tick: int, before: Snapshot) -> float:
        """Decide which faults are on in the coming `tick`; return them as a mask."""


Standby = Callable[[Snapshot], None]
"""Serves, listens or sleeps for a short time; called with the last snapshot while simulated time stands."""

AT_REST_S: Final = 20.0
"""Simulated time after which a drive ends even if the vehicle still rolls."""
REST_MPS: Final = 0.05

_COLLISION: Final = int(Event.COLLISION)
_END: Final = int(Event.END)
_EMERGENCY: Final = int(Event.EMERGENCY_STOP)
_PAUSE: Final = int(Event.PAUSE)
_START: Final = int(Event.START)
_BUTTON_PAUSE: Final = int(Button.PAUSE)
_BUTTON_EMERGENCY: Final = int(Button.EMERGENCY_STOP)


class Components(NamedTuple):
    """The parts of a drive that the loop works with."""

    devices: DeviceSource
    commands: CommandSource  # of the ROS side
    recorder: Recorder
    outputs: Sequence[Output]
    pace: Pace
    seat: Seat | None = None
    faults: Faults | None = None
    ecu: CommandSource = NobodyCommands()
    latencies: LatencyStatistics | None = None
    road_users: RoadUsers | None = None
    others: Callable[[], tuple[float, ...]] | None = None  # where the other platforms are
    standby: Sequence[Standby] = ()  # called again and again while simulated time stands


def run(
    console: Console,
    state: ConsoleState,
    components: Components,
    ticks: int,
    finished: Callable[[Snapshot], bool] = lambda snapshot: False,
    on_request: bool = False,
    at_once: bool = True,
) -> ConsoleState:
    """Drive until `ticks` have passed or `finished` says so; return the last state: `steps` to their end."""
    last = state
    for now in steps(console, state, components, ticks, finished, on_request, at_once):
        last = now
    return last


def steps(
    console: Console,
    state: ConsoleState,
    components: Components,
    ticks: int,
    finished: Callable[[Snapshot], bool] = lambda snapshot: False,
    on_request: bool = False,
    at_once: bool = True,
) -> Iterator[ConsoleState]:
    """Drive until `ticks` have passed or `finished` says so; yield the state after each tick or block of ticks.

    The order is fixed: pace, seat, faults, devices, commands, advance, recorder, outputs. Everything that enters
    `advance` is in the state vector that the recorder keeps, so that the drive replays. A tick with the event PAUSE is
    the last one before simulated time stands; the one with START goes on after it. With `on_request` the first tick
    pauses.

    Ticks that all parts foresee are made at once (`Foresight`): `finished` is asked after them, not between them. It is
    asked after each tick without `at_once`.
    """
    carried = _PAUSE if on_request else 0
    carried_ecu = 0
    snapshot = Snapshot(state.tick, console.tick_hz, state.vector)
    end, latencies = state.tick + ticks, components.latencies
    outputs = [(output, getattr(output, "hop", Hop.OTHERS)) for output in components.outputs]
    ahead_now, take_impact = _ahead_of(components), _impact_of(components)
    others = components.others
    foresight = _foresight(console, components) if at_once else None
    while state.tick < end and not finished(snapshot):
        impact = take_impact()
        if impact.first_touch:
            carried |= _COLLISION
        if foresight is not None and not carried and impact is NO_IMPACT:
            state, carried = foresight.advance(state, end)
            if state.tick > snapshot.tick:
                snapshot = Snapshot(state.tick, console.tick_hz, state.vector)
                for output, _ in outputs:
                    output.publish(snapshot)
                yield state
                continue
        raised = components.pace.wait()
        if components.seat is not None:
            components.seat.act(snapshot)
        coming = state.tick + 1
        mark = unheard if latencies is None else latencies.begin(coming)
        faults = 0.0 if components.faults is None else components.faults.turn(coming, snapshot)
        sample = components.devices.poll(coming)
        if latencies is not None:
            latencies.sample(sample)
        mark(Hop.READ)
        ros, events = components.commands.take(coming)
        ecu, ecu_events = components.ecu.take(coming)
        ahead = ahead_now()
        mark(Hop.TAKE)
        carried |= int(events.events) | raised
        if carried & _START:
            carried &= ~_PAUSE
        edges = EventInput(float(carried), faults, float(int(ecu_events.events) | carried_ecu))
        beside = () if others is None else others()
        inputs = TickInputs(sample=sample, ros=ros, events=edges, ecu=ecu, ahead=ahead, impact=impact, others=beside)
        before = state.vector
        state, snapshot = advance(state, inputs, console, mark)
        recorded = components.recorder.write(snapshot) | first_touch(before, snapshot.vector)
        mark(Hop.RECORD)
        for output, hop in outputs:
            output.publish(snapshot)
            mark(hop)
        carried_ecu = 0
        if carried & _PAUSE:
            carried, carried_ecu = _stand(console, state, components, snapshot, finished)
        else:
            carried = _PAUSE if int(snapshot.driver.edges) & _BUTTON_PAUSE else 0
        carried |= recorded
        yield state


def _ahead_of(components: Components) -> Callable[[], AheadInput]:
    return _nobody_ahead if components.road_users is None else components.road_users.ahead


def _nobody_ahead() -> AheadInput:
    return NO_AHEAD


def _impact_of(components: Components) -> Callable[[], ImpactInput]:
    return _nobody_strikes if components.road_users is None else components.road_users.take_impact


def _nobody_strikes() -> ImpactInput:
    return NO_IMPACT


def _foresight(console: Console, components: Components) -> Foresight | None:
    """Return the foresight of a drive; None where somebody must act or wait in every tick."""
    if (
        components.seat is not None
        or components.faults is not None
        or not getattr(components.pace, "never_waits", False)
    ):
        return None
    sources = (components.devices, components.commands, components.ecu)
    ahead = None if components.road_users is None else components.road_users.ahead
    return Foresight.of(
        console, sources, components.recorder, components.outputs, components.latencies, ahead, components.others
    )


def come_to_rest(console: Console, state: ConsoleState, recorder: Recorder) -> ConsoleState:
    """End a drive whose loop has ended early, in the log only and without waiting; return the last state.

    The first tick has the event END and, where the vehicle moves, EMERGENCY_STOP; nobody is in the seat and nobody
    commands. The last tick recorded is the first at rest, or AT_REST_S later. So the log itself shows that the drive
    ended, to a replay and to a drive that goes on from it.
    """
    moves, last = abs(Snapshot(state.tick, console.tick_hz, state.vector).vehicle.vx_mps) > REST_MPS, 1
    if moves:
        last = round(AT_REST_S * console.tick_hz)
    edges = EventInput(float(_END | _EMERGENCY if moves else _END))
    for _ in range(last if state.tick else 0):
        state, snapshot = advance(state, TickInputs(NO_SAMPLE, NO_COMMAND, edges), console)
        recorder.write(snapshot)
        edges = NO_EVENTS
        if abs(snapshot.vehicle.vx_mps) <= REST_MPS:
            break
    return state


def _stand(
    console: Console,
    state: ConsoleState,
    components: Components,
    snapshot: Snapshot,
    finished: Callable[[Snapshot], bool],
) -> tuple[int, int]:
    """Let simulated time stand until somebody starts it; return the edges for the next tick, of ROS and of the ECU.

    Devices and controllers go on being read, so that nothing grows stale, but no tick happens. What is asked for
    meanwhile, an emergency stop above all, acts in the first tick after it.
    """
    held, collected, collected_ecu = int(snapshot.driver.pressed), 0, 0
    while not finished(snapshot):
        components.pace.wait()  # its events are dropped: a loop that waits on purpose cannot stall
        for stand in components.standby:
            stand(snapshot)
        coming = state.tick + 1
        sample = components.devices.poll(coming)
        ros, events = components.commands.take(coming)
        ecu, ecu_events = components.ecu.take(coming)
        collected |= int(events.events)
        collected_ecu |= int(ecu_events.events)
        pressed = int(looked_ahead(state, TickInputs(sample, ros, NO_EVENTS, ecu), console).driver.pressed)
        edges, held = pressed & ~held, pressed
        if edges & _BUTTON_EMERGENCY:
            collected |= int(Event.EMERGENCY_STOP)
        if collected & _START or edges & _BUTTON_PAUSE:
            return collected & ~_PAUSE | _START, collected_ecu
    return collected, collected_ecu
