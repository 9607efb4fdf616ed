"""One tick as one float64 row: the layout that log, hash, shared memory and replay share.

The row is the console's whole state: its first columns are the tick's inputs, then each stage's result, then the
platform's own state. `advance` makes the next row from the last one and new inputs.
"""

from typing import Final, NamedTuple

import numpy as np

from simconsole.values.kernels import Row
from simconsole.values.signals import (
    NO_COMMAND,
    ArbiterMemory,
    Arbitration,
    Commander,
    DeviceSample,
    DriverInput,
    Event,
    EventInput,
    Link,
    Notice,
    RemoteCommand,
    VehicleCommand,
    VehicleState,
    WheelMemory,
    WheelTorque,
)
from simconsole.values.units import tick_time_ns

SAMPLE_WIDTH: Final = len(DeviceSample._fields)
REMOTE_WIDTH: Final = len(RemoteCommand._fields)
EVENTS_WIDTH: Final = len(EventInput._fields)
DRIVER_WIDTH: Final = len(DriverInput._fields)
MEMORY_WIDTH: Final = len(ArbiterMemory._fields)
LINK_WIDTH: Final = len(Link._fields)
ARBITRATION_WIDTH: Final = len(Arbitration._fields)
COMMAND_WIDTH: Final = len(VehicleCommand._fields)
VEHICLE_WIDTH: Final = len(VehicleState._fields)
TORQUE_WIDTH: Final = len(WheelTorque._fields)
MOTOR_WIDTH: Final = len(WheelMemory._fields)

SAMPLE_AT: Final = 0
ROS_AT: Final = SAMPLE_AT + SAMPLE_WIDTH
EVENTS_AT: Final = ROS_AT + REMOTE_WIDTH
ECU_AT: Final = EVENTS_AT + EVENTS_WIDTH
INPUT_WIDTH: Final = ECU_AT + REMOTE_WIDTH
DRIVER_AT: Final = INPUT_WIDTH
MEMORY_AT: Final = DRIVER_AT + DRIVER_WIDTH
ROS_LINK_AT: Final = MEMORY_AT + MEMORY_WIDTH
ECU_LINK_AT: Final = ROS_LINK_AT + LINK_WIDTH
ARBITRATION_AT: Final = ECU_LINK_AT + LINK_WIDTH
COMMAND_AT: Final = ARBITRATION_AT + ARBITRATION_WIDTH
VEHICLE_AT: Final = COMMAND_AT + COMMAND_WIDTH
TORQUE_AT: Final = VEHICLE_AT + VEHICLE_WIDTH
MOTOR_AT: Final = TORQUE_AT + TORQUE_WIDTH
PLATFORM_AT: Final = MOTOR_AT + MOTOR_WIDTH

STAGES: Final[tuple[tuple[str, type[tuple[float, ...]]], ...]] = (
    ("sample", DeviceSample),
    ("ros", RemoteCommand),
    ("events", EventInput),
    ("ecu", RemoteCommand),
    ("driver", DriverInput),
    ("memory", ArbiterMemory),
    ("ros_link", Link),
    ("ecu_link", Link),
    ("arbitration", Arbitration),
    ("command", VehicleCommand),
    ("vehicle", VehicleState),
    ("torque", WheelTorque),
    ("motor", WheelMemory),
)


_RECORDING_FAILED: Final = int(Event.RECORDING_FAILED)


class TickInputs(NamedTuple):
    """Everything that comes from outside in one tick; this, and only this, is what a replay feeds back."""

    sample: DeviceSample
    ros: RemoteCommand
    events: EventInput
    ecu: RemoteCommand = NO_COMMAND


def columns(platform_state: type[tuple[float, ...]]) -> tuple[str, ...]:
    """Return the name of every column, `stage.field_unit`, for a platform with this state type."""
    stages = (*STAGES, ("platform", platform_state))
    return tuple(f"{stage}.{field}" for stage, record in stages for field in record._fields)  # type: ignore[attr-defined]


def input_row(inputs: TickInputs) -> Row:
    """Return the first INPUT_WIDTH columns of a row."""
    return np.array((*inputs.sample, *inputs.ros, *inputs.events, *inputs.ecu), dtype=np.float64)


class Snapshot(NamedTuple):
    """One finished tick. Views are made when asked for: most readers want one or two."""

    tick: int
    tick_hz: int
    row: Row

    @property
    def t_ns(self) -> int:
        """Simulated time in ns."""
        return tick_time_ns(self.tick, self.tick_hz)

    @property
    def t_s(self) -> float:
        """Simulated time in s, for displays."""
        return self.tick / self.tick_hz

    @property
    def sample(self) -> DeviceSample:
        """The cockpit as read."""
        return DeviceSample(*self.row[SAMPLE_AT:ROS_AT].tolist())

    @property
    def ros(self) -> RemoteCommand:
        """The ROS side's newest command."""
        return RemoteCommand(*self.row[ROS_AT:EVENTS_AT].tolist())

    @property
    def ecu(self) -> RemoteCommand:
        """The ECU's newest command."""
        return RemoteCommand(*self.row[ECU_AT:INPUT_WIDTH].tolist())

    @property
    def remote(self) -> RemoteCommand:
        """The commander's newest command."""
        return self.ecu if self.arbitration.commander == Commander.ECU else self.ros

    @property
    def ros_link(self) -> Link:
        """How far the ROS side's commands may be relied on."""
        return Link(*self.row[ROS_LINK_AT:ECU_LINK_AT].tolist())

    @property
    def ecu_link(self) -> Link:
        """How far the ECU's commands may be relied on."""
        return Link(*self.row[ECU_LINK_AT:ARBITRATION_AT].tolist())

    @property
    def events(self) -> EventInput:
        """The edges of this tick."""
        return EventInput(*self.row[EVENTS_AT:ECU_AT].tolist())

    @property
    def driver(self) -> DriverInput:
        """The person, calibrated."""
        return DriverInput(*self.row[DRIVER_AT:MEMORY_AT].tolist())

    @property
    def arbitration(self) -> Arbitration:
        """Authority, mode and reason."""
        return Arbitration(*self.row[ARBITRATION_AT:COMMAND_AT].tolist())

    @property
    def recording_failed(self) -> bool:
        """Whether nothing more is kept of this drive."""
        return bool(int(self.row[EVENTS_AT]) & _RECORDING_FAILED)

    @property
    def notice(self) -> float:
        """What people are told (`Notice`): a failed recording before anything that the arbiter tells."""
        return float(Notice.RECORDING_FAILED) if self.recording_failed else self.arbitration.notice

    @property
    def command(self) -> VehicleCommand:
        """What left the gate."""
        return VehicleCommand(*self.row[COMMAND_AT:VEHICLE_AT].tolist())

    @property
    def vehicle(self) -> VehicleState:
        """The vehicle after the tick."""
        return VehicleState(*self.row[VEHICLE_AT:TORQUE_AT].tolist())

    @property
    def torque(self) -> WheelTorque:
        """What the wheel's motor is asked for."""
        return WheelTorque(*self.row[TORQUE_AT:MOTOR_AT].tolist())
