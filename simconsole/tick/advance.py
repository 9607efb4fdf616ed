"""The life of one tick, in order. The only place that knows the order of the stages.

`advance` is pure: no clock, no files, no randomness. A seated drive, a headless run, a replay and a benchmark are
this same function; only where inputs come from, how ticks are paced and who reads the snapshots differ.
"""

from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.control.arbitration import arbitrate, watched
from simconsole.control.gate import gate
from simconsole.control.requests.commander import ECU
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.tick_context import Moment
from simconsole.devices.calibration.calibrator import calibrate
from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.force_feedback.force_settings import NO_FORCE, ForceSettings
from simconsole.devices.force_feedback.torque import wheel_torque
from simconsole.values.kernels import Row, kernel, put, take
from simconsole.values.latency import Hop, Mark, unheard
from simconsole.values.platform import Platform
from simconsole.values.signals import (
    NO_COMMAND,
    NO_SAMPLE,
    ArbiterMemory,
    Arbitration,
    DeviceSample,
    DriverInput,
    EventInput,
    Link,
    RemoteCommand,
    VehicleCommand,
    VehicleState,
    WheelMemory,
    WheelTorque,
)
from simconsole.values.state_vector import (
    ARBITRATION_AT,
    ARBITRATION_WIDTH,
    COMMAND_AT,
    COMMAND_WIDTH,
    DRIVER_AT,
    DRIVER_WIDTH,
    ECU_AT,
    ECU_LINK_AT,
    EVENTS_AT,
    EVENTS_WIDTH,
    INPUT_WIDTH,
    LINK_WIDTH,
    MEMORY_AT,
    MEMORY_WIDTH,
    MOTOR_AT,
    MOTOR_WIDTH,
    PLATFORM_AT,
    REMOTE_WIDTH,
    ROS_AT,
    ROS_LINK_AT,
    SAMPLE_AT,
    SAMPLE_WIDTH,
    TORQUE_AT,
    TORQUE_WIDTH,
    VEHICLE_AT,
    VEHICLE_WIDTH,
    Snapshot,
    TickInputs,
    columns,
)

Execution = Callable[[Callable[..., Any]], Callable[..., Any]]
"""How kernels run: `compiling.compiled` or `compiling.plain`."""

COCKPIT_AT: Final = 0
COCKPIT_WIDTH: Final = len(CockpitSettings._fields)
CONTROL_AT: Final = COCKPIT_WIDTH
CONTROL_WIDTH: Final = len(ControlSettings._fields)
FORCE_AT: Final = CONTROL_AT + CONTROL_WIDTH
FORCE_WIDTH: Final = len(ForceSettings._fields)
_ROS_AGE_AT: Final = ROS_AT + RemoteCommand._fields.index("age_ticks")
_ECU_AGE_AT: Final = ECU_AT + RemoteCommand._fields.index("age_ticks")
_RESTARTED_AT: Final = ARBITRATION_AT + Arbitration._fields.index("restarted")
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
    feel: Callable[[Row, Row, Row, float], None] | None  # None: the wheel has no motor

    @property
    def columns(self) -> tuple[str, ...]:
        """Name of every column of a row of this drive."""
        return columns(self.platform.state)


class ConsoleState(NamedTuple):
    """Everything one tick hands to the next: the row is the whole state."""

    tick: int
    row: Row


def build_console(
    cockpit: CockpitSettings,
    control: ControlSettings,
    platform: Platform,
    tick_hz: int,
    execution: Execution,
    force: ForceSettings = NO_FORCE,
) -> Console:
    """Put a console together. `execution` is `compiling.compiled` or `compiling.plain`; both give equal bits.

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
        feel=execution(feel) if force.max_torque_nm > 0.0 else None,
    )


def initial_state(console: Console) -> ConsoleState:
    """Return the state before the first tick: vehicle in place, nobody armed, parked."""
    row = np.zeros(console.width, dtype=np.float64)
    put(row, SAMPLE_AT, NO_SAMPLE)
    put(row, ROS_AT, NO_COMMAND)
    put(row, ECU_AT, NO_COMMAND)
    put(row, VEHICLE_AT, console.platform.initial_vehicle)
    put(row, PLATFORM_AT, console.platform.initial_state)
    return ConsoleState(0, row)


def advance(
    state: ConsoleState, inputs: TickInputs, console: Console, mark: Mark = unheard
) -> tuple[ConsoleState, Snapshot]:
    """Advance the console by one tick. Neither `state` nor its row is changed; `mark` is told which stage has ended."""
    row = advance_row(state.row, (*inputs.sample, *inputs.ros, *inputs.events, *inputs.ecu), console, mark)
    tick = state.tick + 1
    return ConsoleState(tick, row), Snapshot(tick, console.tick_hz, row)


def advance_row(previous: Row, inputs: Row | tuple[float, ...], console: Console, mark: Mark = unheard) -> Row:
    """Return the row after `previous` for the INPUT_WIDTH values `inputs`: `advance` as a replay wants it."""
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
    if console.feel is None:
        row[TORQUE_AT:PLATFORM_AT] = 0.0
    else:
        console.feel(previous, row, console.settings, console.tick_s)
        mark(Hop.FEEL)
    return row


def _start_again(previous: Row, console: Console) -> Row:
    """Return the row before the first tick, with the devices as they are."""
    row = initial_state(console).row
    row[SAMPLE_AT:ROS_AT] = previous[SAMPLE_AT:ROS_AT]
    row[DRIVER_AT:MEMORY_AT] = previous[DRIVER_AT:MEMORY_AT]
    return row


@kernel
def decide(previous: Row, row: Row, settings: Row, tick_s: float) -> None:
    """Calibrate, arbitrate and gate: turn the inputs in `row` into the one command the vehicle gets."""
    ros = RemoteCommand(*take(row, ROS_AT, REMOTE_WIDTH))
    ecu = RemoteCommand(*take(row, ECU_AT, REMOTE_WIDTH))
    control = ControlSettings(*take(settings, CONTROL_AT, CONTROL_WIDTH))
    vehicle = VehicleState(*take(previous, VEHICLE_AT, VEHICLE_WIDTH))
    command_before = VehicleCommand(*take(previous, COMMAND_AT, COMMAND_WIDTH))
    motor = WheelMemory(*take(previous, MOTOR_AT, MOTOR_WIDTH))
    driver = calibrate(
        DeviceSample(*take(row, SAMPLE_AT, SAMPLE_WIDTH)),
        DeviceSample(*take(previous, SAMPLE_AT, SAMPLE_WIDTH)),
        DriverInput(*take(previous, DRIVER_AT, DRIVER_WIDTH)),
        vehicle.road_wheel_rad / control.road_wheel_per_hand_wheel,
        CockpitSettings(*take(settings, COCKPIT_AT, COCKPIT_WIDTH)),
        tick_s,
    )
    now = Moment(
        driver=driver,
        ros=ros,
        ecu=ecu,
        events=EventInput(*take(row, EVENTS_AT, EVENTS_WIDTH)),
        vehicle=vehicle,
        memory=ArbiterMemory(*take(previous, MEMORY_AT, MEMORY_WIDTH)),
        ros_before=Link(*take(previous, ROS_LINK_AT, LINK_WIDTH)),
        ecu_before=Link(*take(previous, ECU_LINK_AT, LINK_WIDTH)),
        ros_age_before_ticks=previous[_ROS_AGE_AT],
        ecu_age_before_ticks=previous[_ECU_AGE_AT],
        before=Arbitration(*take(previous, ARBITRATION_AT, ARBITRATION_WIDTH)),
        command_before=command_before,
        explained_rad=motor.explained_rad,
        explained_radps=motor.explained_radps,
        human_nm=WheelTorque(*take(previous, TORQUE_AT, TORQUE_WIDTH)).human_nm,
        wheel_motor=motor.live,
        settings=control,
        tick_s=tick_s,
    )
    memory, ros_link, ecu_link, arbitration, request = arbitrate(now)
    remote = ecu if arbitration.commander == ECU else ros
    events = EventInput(*take(row, EVENTS_AT, EVENTS_WIDTH))
    command = gate(request, remote, arbitration, command_before, vehicle, control, tick_s, events.events)
    put(row, DRIVER_AT, driver)
    put(row, MEMORY_AT, memory)
    put(row, ROS_LINK_AT, ros_link)
    put(row, ECU_LINK_AT, ecu_link)
    put(row, ARBITRATION_AT, arbitration)
    put(row, COMMAND_AT, command)


@kernel
def feel(previous: Row, row: Row, settings: Row, tick_s: float) -> None:
    """Turn what the vehicle does into the torque of the wheel's motor, for the coming tick."""
    sample = DeviceSample(*take(row, SAMPLE_AT, SAMPLE_WIDTH))
    arbitration = Arbitration(*take(row, ARBITRATION_AT, ARBITRATION_WIDTH))
    cockpit = CockpitSettings(*take(settings, COCKPIT_AT, COCKPIT_WIDTH))
    torque, memory = wheel_torque(
        DriverInput(*take(row, DRIVER_AT, DRIVER_WIDTH)),
        sample.wheel_motor,
        arbitration,
        watched(arbitration.mode),
        EventInput(*take(row, EVENTS_AT, EVENTS_WIDTH)).events,
        VehicleState(*take(row, VEHICLE_AT, VEHICLE_WIDTH)),
        WheelTorque(*take(previous, TORQUE_AT, TORQUE_WIDTH)),
        WheelMemory(*take(previous, MOTOR_AT, MOTOR_WIDTH)),
        ForceSettings(*take(settings, FORCE_AT, FORCE_WIDTH)),
        cockpit.wheel_rate_filter_s,
        tick_s,
    )
    put(row, TORQUE_AT, torque)
    put(row, MOTOR_AT, memory)
