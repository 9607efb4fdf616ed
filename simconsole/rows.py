"""One tick as one float64 row: the layout that log, hash, shared memory and replay share.

The row is the console's whole state: its first columns are the tick's inputs, then each stage's result, then the
platform's own state. `advance` makes the next row from the last one and new inputs.
"""

from typing import Final, NamedTuple

import numpy as np

from simconsole.kernels import Row
from simconsole.signals import (
    ArbiterMemory,
    Arbitration,
    DeviceSample,
    DriverInput,
    EventInput,
    RemoteCommand,
    VehicleCommand,
    VehicleState,
    WheelMemory,
    WheelTorque,
)
from simconsole.units import tick_time_ns

SAMPLE_WIDTH: Final = len(DeviceSample._fields)
REMOTE_WIDTH: Final = len(RemoteCommand._fields)
EVENTS_WIDTH: Final = len(EventInput._fields)
DRIVER_WIDTH: Final = len(DriverInput._fields)
MEMORY_WIDTH: Final = len(ArbiterMemory._fields)
ARBITRATION_WIDTH: Final = len(Arbitration._fields)
COMMAND_WIDTH: Final = len(VehicleCommand._fields)
VEHICLE_WIDTH: Final = len(VehicleState._fields)
TORQUE_WIDTH: Final = len(WheelTorque._fields)
MOTOR_WIDTH: Final = len(WheelMemory._fields)

SAMPLE_AT: Final = 0
REMOTE_AT: Final = SAMPLE_AT + SAMPLE_WIDTH
EVENTS_AT: Final = REMOTE_AT + REMOTE_WIDTH
INPUT_WIDTH: Final = EVENTS_AT + EVENTS_WIDTH
DRIVER_AT: Final = INPUT_WIDTH
MEMORY_AT: Final = DRIVER_AT + DRIVER_WIDTH
ARBITRATION_AT: Final = MEMORY_AT + MEMORY_WIDTH
COMMAND_AT: Final = ARBITRATION_AT + ARBITRATION_WIDTH
VEHICLE_AT: Final = COMMAND_AT + COMMAND_WIDTH
TORQUE_AT: Final = VEHICLE_AT + VEHICLE_WIDTH
MOTOR_AT: Final = TORQUE_AT + TORQUE_WIDTH
PLATFORM_AT: Final = MOTOR_AT + MOTOR_WIDTH

STAGES: Final[tuple[tuple[str, type[tuple[float, ...]]], ...]] = (
    ("sample", DeviceSample),
    ("remote", RemoteCommand),
    ("events", EventInput),
    ("driver", DriverInput),
    ("memory", ArbiterMemory),
    ("arbitration", Arbitration),
    ("command", VehicleCommand),
    ("vehicle", VehicleState),
    ("torque", WheelTorque),
    ("motor", WheelMemory),
)


class TickInputs(NamedTuple):
    """Everything that comes from outside in one tick; this, and only this, is what a replay feeds back."""

    sample: DeviceSample
    remote: RemoteCommand
    events: EventInput


def columns(platform_state: type[tuple[float, ...]]) -> tuple[str, ...]:
    """Return the name of every column, `stage.field_unit`, for a platform with this state type."""
    stages = (*STAGES, ("platform", platform_state))
    return tuple(f"{stage}.{field}" for stage, record in stages for field in record._fields)  # type: ignore[attr-defined]


def input_row(inputs: TickInputs) -> Row:
    """Return the first INPUT_WIDTH columns of a row."""
    return np.array((*inputs.sample, *inputs.remote, *inputs.events), dtype=np.float64)


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
        return DeviceSample(*self.row[SAMPLE_AT:REMOTE_AT].tolist())

    @property
    def remote(self) -> RemoteCommand:
        """The remote command in force."""
        return RemoteCommand(*self.row[REMOTE_AT:EVENTS_AT].tolist())

    @property
    def events(self) -> EventInput:
        """The edges of this tick."""
        return EventInput(*self.row[EVENTS_AT:INPUT_WIDTH].tolist())

    @property
    def driver(self) -> DriverInput:
        """The person, calibrated."""
        return DriverInput(*self.row[DRIVER_AT:MEMORY_AT].tolist())

    @property
    def arbitration(self) -> Arbitration:
        """Authority, mode and reason."""
        return Arbitration(*self.row[ARBITRATION_AT:COMMAND_AT].tolist())

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
