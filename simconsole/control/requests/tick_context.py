"""The inputs of arbitration in one tick, in one value."""

from typing import NamedTuple

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.values.signals import (
    ArbiterMemory,
    Arbitration,
    DriverInput,
    EventInput,
    Link,
    RemoteCommand,
    VehicleCommand,
    VehicleState,
)


class TickContext(NamedTuple):
    """The inputs of one tick, and the results of the tick before."""

    driver: DriverInput  # the person, calibrated, in this tick
    ros: RemoteCommand  # the ROS side's newest accepted command
    ecu: RemoteCommand  # the ECU's
    events: EventInput  # edges since the last tick
    vehicle: VehicleState  # after the tick before; its fields may be anything
    memory: ArbiterMemory
    ros_before: Link
    ecu_before: Link
    ros_age_before_ticks: float  # of the newest command, in the tick before
    ecu_age_before_ticks: float
    before: Arbitration
    command_before: VehicleCommand  # what left the gate in the tick before: hand-overs and stops start from it
    explained_rad: float  # how far the wheel's motor alone has moved it since engagement; 0 without a motor
    explained_radps: float  # how fast
    human_nm: float  # the person's torque at the rim, estimated; 0 without a motor
    hand_wheel_radps2: float  # its acceleration
    carried_nm: float  # how much of it was held at engagement already and is no take-over
    wheel_motor: float  # 1 while the wheel's motor obeys
    settings: ControlSettings
    tick_s: float
