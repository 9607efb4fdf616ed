"""The life of one tick, in order. The only place that knows the order of the stages.

`advance` is pure: no clock, no files, no randomness. A seated drive, a headless run, a replay and a benchmark are
this same function; only where inputs come from, how ticks are paced and who reads the snapshots differ.
"""

from collections.abc import Callable
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
from simconsole.values.kernels import Row, kernel, put
from simconsole.values.latency import Hop, Mark, unheard
from simconsole.values.layout import Part, lay_out, read, write
from simconsole.values.platform import Platform
from simconsole.values.signals import NO_COMMAND, NO_SAMPLE, Commander
from simconsole.values.state_vector import INPUT_WIDTH, LAYOUT, PLATFORM_AT, Snapshot, TickInputs, columns

Execution = Callable[[Callable[..., Any]], Callable[..., Any]]
"""How kernels run: `jit.compiled` or `jit.plain`."""


class SettingsLayout(NamedTuple):
    """The settings that stay constant over a drive, one after the other."""

    cockpit: Part[CockpitSettings]
    control: Part[ControlSettings]
    force: Part[ForceSettings]


SETTINGS: Final = lay_out(SettingsLayout)
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
    settings: Row  # CockpitSettings, ControlSettings, ForceSettings
    platform: Platform
    decide: Callable[[Row, Row, Row, float], None]
    step: Callable[[Row, Row, Row, int], None]
    force_feedback: Callable[[Row, Row, Row, float], None] | None  # None: the wheel has no motor

    @property
    def columns(self) -> tuple[str, ...]:
        """Name of every column of a state vector of this drive."""
        return columns(self.platform.state)


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
) -> Console:
    """Put a console together. `execution` is `jit.compiled` or `jit.plain`; both give equal bits.

    Raises:
        ValueError: `tick_hz` does not divide 1000.
    """
    if PHYSICS_HZ % tick_hz:
        raise ValueError(f"tick_hz {tick_hz} does not divide {PHYSICS_HZ}")
    return Console(
        tick_hz=tick_hz,
        tick_s=1.0 / tick_hz,
        substeps=PHYSICS_HZ // tick_hz,
        width=PLATFORM_AT + len(platform.initial_state),
        settings=np.array((*cockpit, *control, *force), dtype=np.float64),
        platform=platform,
        decide=execution(decide),
        step=execution(platform.step),
        force_feedback=execution(force_feedback) if force.max_torque_nm > 0.0 else None,
    )


def initial_state(console: Console) -> ConsoleState:
    """Return the state before the first tick: vehicle in place, nobody armed, parked."""
    row = np.zeros(console.width, dtype=np.float64)
    write(row, LAYOUT.sample, NO_SAMPLE)
    write(row, LAYOUT.ros, NO_COMMAND)
    write(row, LAYOUT.ecu, NO_COMMAND)
    write(row, LAYOUT.vehicle, console.platform.initial_vehicle)
    put(row, PLATFORM_AT, console.platform.initial_state)
    return ConsoleState(0, row)


def advance(
    state: ConsoleState, inputs: TickInputs, console: Console, mark: Mark = unheard
) -> tuple[ConsoleState, Snapshot]:
    """Advance the console by one tick. `state` is not changed; `mark` is called at the end of each stage."""
    row = advance_vector(state.vector, (*inputs.sample, *inputs.ros, *inputs.events, *inputs.ecu), console, mark)
    tick = state.tick + 1
    return ConsoleState(tick, row), Snapshot(tick, console.tick_hz, row)


def advance_vector(previous: Row, inputs: Row | tuple[float, ...], console: Console, mark: Mark = unheard) -> Row:
    """Return the state vector after `previous` for the INPUT_WIDTH values `inputs`, as a replay needs it."""
    row = np.empty(console.width)
    row[:INPUT_WIDTH] = inputs
    console.decide(previous, row, console.settings, console.tick_s)
    if row[_RESTARTED_AT] > 0.0:
        previous = _start_again(previous, console)
        console.decide(previous, row, console.settings, console.tick_s)
        row[_RESTARTED_AT] = 1.0
    mark(Hop.DECIDE)
    console.step(previous, row, console.platform.parameters, console.substeps)
    mark(Hop.STEP)
    if console.force_feedback is None:
        row[LAYOUT.torque.start : PLATFORM_AT] = 0.0
    else:
        console.force_feedback(previous, row, console.settings, console.tick_s)
        mark(Hop.FORCE_FEEDBACK)
    return row


def _start_again(previous: Row, console: Console) -> Row:
    """Return the state vector before the first tick, with the devices as they are."""
    row = initial_state(console).vector
    row[LAYOUT.sample.slice] = previous[LAYOUT.sample.slice]
    row[LAYOUT.driver.slice] = previous[LAYOUT.driver.slice]
    return row


@kernel
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


@kernel
def force_feedback(previous: Row, row: Row, settings: Row, tick_s: float) -> None:
    """Turn what the vehicle does into the torque of the wheel's motor, for the coming tick."""
    sample = read(row, LAYOUT.sample)
    arbitration = read(row, LAYOUT.arbitration)
    cockpit = read(settings, SETTINGS.cockpit)
    torque, memory = wheel_torque(
        read(row, LAYOUT.driver),
        sample.wheel_motor,
        arbitration,
        watched(arbitration.mode),
        read(row, LAYOUT.events).events,
        read(row, LAYOUT.vehicle),
        read(previous, LAYOUT.torque),
        read(previous, LAYOUT.motor),
        read(settings, SETTINGS.force),
        cockpit.wheel_rate_filter_s,
        tick_s,
    )
    write(row, LAYOUT.torque, torque)
    write(row, LAYOUT.motor, memory)
