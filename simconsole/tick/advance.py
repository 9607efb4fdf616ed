"""The life of one tick, in order. The only place that knows the order of the stages.

`advance` is pure: no clock, no files, no randomness. A seated drive, a headless run, a replay and a benchmark are
this same function; only where inputs come from, how ticks are paced and who reads the snapshots differ.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.control.arbitration import arbitrate, watched
from simconsole.control.gate import gate
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.tick_context import TickContext
from simconsole.devices.calibration.calibrator import calibrate
from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.force_feedback.force_settings import NO_FORCE, ForceSettings
from simconsole.devices.force_feedback.torque import wheel_torque
from simconsole.values.kernels import Row, holding, kernel, put, stage
from simconsole.values.latency import Hop, Mark, unheard
from simconsole.values.layout import Part, lay_out, read, write
from simconsole.values.platform import Platform, Step
from simconsole.values.signals import (
    NO_AHEAD,
    NO_COMMAND,
    NO_OBSTACLE_TOUCHED,
    NO_RULES_BROKEN,
    NO_SAMPLE,
    NO_SITUATION,
    Commander,
)
from simconsole.values.state_vector import INPUT_WIDTH, LAYOUT, OTHER, PLATFORM_AT, Snapshot, TickInputs, columns
from simconsole.world.obstacles.sides import FixedThings
from simconsole.world.obstacles.striking import strike
from simconsole.world.rules.road_rules import RoadRules
from simconsole.world.rules.situation import look_around

Execution = Callable[[Callable[..., Any]], Callable[..., Any]]
"""How kernels run: `jit.compiled` or `jit.plain`."""


class SettingsLayout(NamedTuple):
    """The settings that stay constant over a drive, one after the other."""

    cockpit: Part[CockpitSettings]
    control: Part[ControlSettings]
    force: Part[ForceSettings]


SETTINGS: Final = lay_out(SettingsLayout)
Stage = Callable[..., None]
_DECIDE, _STEP, _FORCE_FEEDBACK = Hop.DECIDE, Hop.STEP, Hop.FORCE_FEEDBACK
_TORQUE_AT: Final = LAYOUT.torque.start
_TORQUE_STOP: Final = LAYOUT.pipe.stop
_TICK_AT: Final = LAYOUT.situation.at("tick")
_ROS_AGE_AT: Final = LAYOUT.ros.at("age_ticks")
_ECU_AGE_AT: Final = LAYOUT.ecu.at("age_ticks")
_RESTARTED_AT: Final = LAYOUT.arbitration.at("restarted")
PHYSICS_HZ: Final = 1000
"""The vehicle integrates at a fixed 1 ms whatever the tick."""


class Console(NamedTuple):
    """What stays constant over a drive: the configuration under which `advance` works."""

    tick_hz: int
    tick_s: float
    substeps: int
    width: int
    others: int  # columns at the end that are inputs, too
    settings: Row  # CockpitSettings, ControlSettings, ForceSettings
    platform: Platform
    initial: Row  # the state vector before the first tick
    restarted: Row  # work array: that before the first tick after a restart
    decide: Callable[[Row, Row, Row, float], None]
    strike: Callable[[Row, Row, FixedThings], None] | None  # None: the world has no fixed things
    step: Step
    force_feedback: Callable[[Row, Row, Row, float], None] | None  # None: the wheel has no motor
    roads: RoadRules | None  # None: the world has no rules
    look_around: Callable[[Row, Row, RoadRules, float], None] | None  # None: likewise
    ticks: Stage  # one tick after the other, as `execution` takes it: a kernel, if the platform's step is compiled
    block: Callable[[Row, Row, Row, Row, Row, Row, Row, float, int], None]  # `ticks` at work; it holds the roads

    @property
    def columns(self) -> tuple[str, ...]:
        """Name of every column of a state vector of this drive."""
        return columns(self.platform.state, self.platform.others)


class ConsoleState(NamedTuple):
    """Everything one tick hands to the next: the state vector is the whole state."""

    tick: int
    vector: Row


def build_console(
    cockpit: CockpitSettings,
    control: ControlSettings,
    platform: Platform,
    tick_hz: int,
    execution: Execution,
    force: ForceSettings = NO_FORCE,
    roads: RoadRules | None = None,
) -> Console:
    """Put a console together. `execution` is `jit.compiled` or `jit.plain`; both give equal bits.

    `roads` are the rules of the world, None where it has none.

    Raises:
        ValueError: `tick_hz` does not divide 1000.
    """
    if PHYSICS_HZ % tick_hz:
        raise ValueError(f"tick_hz {tick_hz} does not divide {PHYSICS_HZ}")
    torque = force_feedback if force.max_torque_nm > 0.0 else None
    look, struck = (None, None) if roads is None else (look_around, strike)
    step = execution(platform.step) if platform.compiled else platform.step
    if platform.compiled:
        ticks = _whole(struck, platform.step, look, torque)
        block = execution(ticks)
    else:
        stages = (None if one is None else execution(one) for one in (struck, look, torque))
        struck_at_work, look_at_work, torque_at_work = stages
        ticks = _block_of(in_order(execution(decide), struck_at_work, step, look_at_work, torque_at_work, None))
        block = ticks
    return Console(
        tick_hz=tick_hz,
        tick_s=1.0 / tick_hz,
        substeps=PHYSICS_HZ // tick_hz,
        width=len(_initial(platform)),
        others=len(OTHER) * platform.others,
        settings=np.array((*cockpit, *control, *force), dtype=np.float64),
        platform=platform,
        initial=_initial(platform),
        restarted=_initial(platform),
        decide=execution(decide),
        strike=None if struck is None else execution(struck),
        step=step,
        force_feedback=None if torque is None else execution(torque),
        roads=roads,
        look_around=None if look is None else execution(look),
        ticks=ticks,
        block=holding(block, roads),
    )


@lru_cache(maxsize=8)  # platforms of a session that are alike have one
def _whole(strike: Stage | None, step: Step, look: Stage | None, torque: Stage | None) -> Stage:
    """Return the kernel that makes one tick after the other, to be compiled as a whole."""
    return _block_of(in_order(decide, strike, step, look, torque, None))


def _initial(platform: Platform) -> Row:
    row = np.zeros(PLATFORM_AT + len(platform.initial_state) + len(OTHER) * platform.others, dtype=np.float64)
    write(row, LAYOUT.sample, NO_SAMPLE)
    write(row, LAYOUT.ros, NO_COMMAND)
    write(row, LAYOUT.ecu, NO_COMMAND)
    write(row, LAYOUT.ahead, NO_AHEAD)
    write(row, LAYOUT.vehicle, platform.initial_vehicle)
    write(row, LAYOUT.situation, NO_SITUATION)
    put(row, PLATFORM_AT, platform.initial_state)
    return row


def initial_state(console: Console) -> ConsoleState:
    """Return the state before the first tick: vehicle in place, nobody armed, parked."""
    return ConsoleState(0, console.initial.copy())


def advance(
    state: ConsoleState, inputs: TickInputs, console: Console, mark: Mark = unheard
) -> tuple[ConsoleState, Snapshot]:
    """Advance the console by one tick. `state` is not changed; `mark` is called at the end of each stage."""
    values = (*inputs.sample, *inputs.ros, *inputs.events, *inputs.ecu, *inputs.ahead, *inputs.impact, *inputs.others)
    row = advance_vector(state.vector, values, console, mark)
    tick = state.tick + 1
    return ConsoleState(tick, row), Snapshot(tick, console.tick_hz, row)


def advance_vector(previous: Row, inputs: Row | tuple[float, ...], console: Console, mark: Mark = unheard) -> Row:
    """Return the state vector after `previous`, as a replay needs it.

    `inputs` are the values of its first INPUT_WIDTH columns, and of its last ones where these tell of other platforms;
    without the latter the others stand where they stood.
    """
    row = np.empty(console.width)
    if console.others:
        row[-console.others :] = inputs[INPUT_WIDTH:] if len(inputs) > INPUT_WIDTH else previous[-console.others :]
        inputs = inputs[:INPUT_WIDTH]
    row[:INPUT_WIDTH] = inputs
    stages = console.decide, console.strike, console.step, console.look_around, console.force_feedback
    tick = in_order(*stages, mark)
    tick(console.roads, previous, row, *constants(console))
    return row


def looked_ahead(state: ConsoleState, inputs: TickInputs, console: Console) -> Snapshot:
    """Return the coming tick as far as `decide` writes it, the driver above all; the vehicle is not stepped.

    While simulated time stands, that is all anybody needs; a vehicle with a state that it does not show, an FMU, would
    have to begin anew for each look.
    """
    row = np.zeros(console.width)
    inputs_of_tick = (*inputs.sample, *inputs.ros, *inputs.events, *inputs.ecu, *inputs.ahead, *inputs.impact)
    row[:INPUT_WIDTH] = inputs_of_tick
    console.decide(state.vector, row, console.settings, console.tick_s)
    return Snapshot(state.tick + 1, console.tick_hz, row)


def advance_block(previous: Row, rows: Row, console: Console) -> None:
    """Make as many ticks as there are `rows`, in one compiled call.

    Args:
        previous: the state vector before the first of them.
        rows: float64 [ticks, columns], the inputs in the first INPUT_WIDTH columns, and in the last ones where these
            tell of other platforms; the rest is written.
        console: which console.
    """
    console.block(previous, rows, *constants(console))


def constants(console: Console) -> tuple[Row, Row, Row, Row, Row, float, int]:
    """Return what a tick takes beside the state vectors and the roads."""
    on, start = console.platform, (console.initial, console.restarted)
    return console.settings, on.parameters, on.ground, *start, console.tick_s, console.substeps


def in_order(
    decide: Stage,
    strike: Stage | None,
    step: Stage,
    look_around: Stage | None,
    force_feedback: Stage | None,
    mark: Mark | None,
) -> Stage:
    """Return one tick: its stages in their order. Nowhere else do they stand.

    One text, two executions: of compiled stages, called one by one, with a `mark` that hears the end of each; and of
    the kernels themselves, without a mark, compiled as a whole (`advance_block`). Only `strike` and `look_around` read
    `roads`: without them it is None, for each of its tables would have to be handed over in every call.
    """

    @kernel
    def tick(
        roads: RoadRules,
        previous: Row,
        row: Row,
        settings: Row,
        parameters: Row,
        ground: Row,
        initial: Row,
        restarted: Row,
        tick_s: float,
        substeps: int,
    ) -> None:
        """Write the state vector after `previous` into `row`, whose first columns hold the inputs."""
        decide(previous, row, settings, tick_s)
        if row[_RESTARTED_AT] > 0.0:
            start_again(previous, initial, restarted)
            previous = restarted
            decide(previous, row, settings, tick_s)
            row[_RESTARTED_AT] = 1.0
        if mark is not None:
            mark(_DECIDE)
        if strike is None:
            write(row, LAYOUT.obstacle, NO_OBSTACLE_TOUCHED)
        else:
            strike(previous, row, roads.things)
        step(previous, row, parameters, ground, substeps)
        if look_around is None:
            write(row, LAYOUT.situation, NO_SITUATION)
            write(row, LAYOUT.rules, NO_RULES_BROKEN)
        else:
            look_around(previous, row, roads, tick_s)
        if mark is not None:
            mark(_STEP)
        if force_feedback is None:
            row[_TORQUE_AT:_TORQUE_STOP] = 0.0
        else:
            force_feedback(previous, row, settings, tick_s)
            if mark is not None:
                mark(_FORCE_FEEDBACK)

    return tick


def _block_of(tick: Stage) -> Stage:
    """Return the kernel that makes one tick after the other."""

    @kernel
    def block(
        roads: RoadRules,
        previous: Row,
        rows: Row,
        settings: Row,
        parameters: Row,
        ground: Row,
        initial: Row,
        restarted: Row,
        tick_s: float,
        substeps: int,
    ) -> None:
        for index in range(len(rows)):
            row = rows[index]
            tick(roads, previous, row, settings, parameters, ground, initial, restarted, tick_s, substeps)
            previous = row

    return block


@kernel
def start_again(previous: Row, initial: Row, row: Row) -> None:
    """Write the state vector before the first tick into `row`, with the devices and the time of `previous`."""
    for column in range(len(initial)):
        row[column] = initial[column]
    row[_TICK_AT] = previous[_TICK_AT]
    write(row, LAYOUT.sample, read(previous, LAYOUT.sample))
    write(row, LAYOUT.driver, read(previous, LAYOUT.driver))


@stage
def decide(previous: Row, row: Row, settings: Row, tick_s: float) -> None:
    """Calibrate, arbitrate and gate: turn the inputs in `row` into the one command the vehicle gets."""
    ros = read(row, LAYOUT.ros)
    ecu = read(row, LAYOUT.ecu)
    control = read(settings, SETTINGS.control)
    vehicle = read(previous, LAYOUT.vehicle)
    command_before = read(previous, LAYOUT.command)
    motor = read(previous, LAYOUT.motor)
    driver = calibrate(
        read(row, LAYOUT.sample),
        read(previous, LAYOUT.sample),
        read(previous, LAYOUT.driver),
        vehicle.road_wheel_rad / control.road_wheel_per_hand_wheel,
        read(settings, SETTINGS.cockpit),
        tick_s,
    )
    now = TickContext(
        driver=driver,
        ros=ros,
        ecu=ecu,
        events=read(row, LAYOUT.events),
        vehicle=vehicle,
        memory=read(previous, LAYOUT.memory),
        ros_before=read(previous, LAYOUT.ros_link),
        ecu_before=read(previous, LAYOUT.ecu_link),
        ros_age_before_ticks=previous[_ROS_AGE_AT],
        ecu_age_before_ticks=previous[_ECU_AGE_AT],
        before=read(previous, LAYOUT.arbitration),
        command_before=command_before,
        explained_rad=motor.explained_rad,
        explained_radps=motor.explained_radps,
        human_nm=read(previous, LAYOUT.torque).human_nm,
        hand_wheel_radps2=(driver.hand_wheel_radps - read(previous, LAYOUT.driver).hand_wheel_radps) / tick_s,
        carried_nm=motor.carried_nm,
        wheel_motor=motor.live,
        settings=control,
        tick_s=tick_s,
    )
    memory, ros_link, ecu_link, arbitration, request = arbitrate(now)
    remote = ecu if arbitration.commander == Commander.ECU else ros
    events = read(row, LAYOUT.events)
    command = gate(request, remote, arbitration, command_before, vehicle, control, tick_s, events.events)
    write(row, LAYOUT.driver, driver)
    write(row, LAYOUT.memory, memory)
    write(row, LAYOUT.ros_link, ros_link)
    write(row, LAYOUT.ecu_link, ecu_link)
    write(row, LAYOUT.arbitration, arbitration)
    write(row, LAYOUT.command, command)


@stage
def force_feedback(previous: Row, row: Row, settings: Row, tick_s: float) -> None:
    """Turn what the vehicle does into the torque of the wheel's motor, for the coming tick."""
    sample = read(row, LAYOUT.sample)
    arbitration = read(row, LAYOUT.arbitration)
    cockpit = read(settings, SETTINGS.cockpit)
    torque, memory, pipe = wheel_torque(
        read(row, LAYOUT.driver),
        sample.wheel_motor,
        arbitration,
        watched(arbitration.mode),
        read(row, LAYOUT.events).events,
        read(row, LAYOUT.vehicle),
        read(previous, LAYOUT.torque),
        read(previous, LAYOUT.motor),
        read(previous, LAYOUT.pipe),
        read(settings, SETTINGS.force),
        cockpit.wheel_rate_filter_s,
        tick_s,
    )
    write(row, LAYOUT.torque, torque)
    write(row, LAYOUT.motor, memory)
    write(row, LAYOUT.pipe, pipe)
