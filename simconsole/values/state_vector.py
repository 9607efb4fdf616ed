"""The state vector, one tick as float64 values: the layout that log, hash, shared memory and replay share.

It is the console's whole state: its first columns are the tick's inputs, then each stage's result, then the platform's
own state. Of a session with several platforms the last columns are inputs, too: where the others are that this one
reacts to (docs/decisions/0046-several-platforms.md). `advance` makes the next state vector from the last one and new
inputs.
"""

from typing import Final, NamedTuple

import numpy as np

from simconsole.values.kernels import Row
from simconsole.values.layout import Part, lay_out, read
from simconsole.values.signals import (
    NO_AHEAD,
    NO_COMMAND,
    NO_IMPACT,
    AheadInput,
    ArbiterMemory,
    Arbitration,
    Commander,
    DeviceSample,
    DriverInput,
    Event,
    EventInput,
    ImpactInput,
    Link,
    LinkState,
    Mode,
    MotorPipe,
    Notice,
    ObstacleImpact,
    RemoteCommand,
    Rules,
    Situation,
    VehicleCommand,
    VehicleState,
    WheelMemory,
    WheelTorque,
)
from simconsole.values.units import tick_time_ns


class Layout(NamedTuple):
    """The parts of a state vector that every platform has, in their order."""

    sample: Part[DeviceSample]
    ros: Part[RemoteCommand]
    events: Part[EventInput]
    ecu: Part[RemoteCommand]
    ahead: Part[AheadInput]
    impact: Part[ImpactInput]
    driver: Part[DriverInput]
    memory: Part[ArbiterMemory]
    ros_link: Part[Link]
    ecu_link: Part[Link]
    arbitration: Part[Arbitration]
    command: Part[VehicleCommand]
    vehicle: Part[VehicleState]
    torque: Part[WheelTorque]
    motor: Part[WheelMemory]
    pipe: Part[MotorPipe]
    situation: Part[Situation]
    rules: Part[Rules]
    obstacle: Part[ObstacleImpact]


LAYOUT: Final = lay_out(Layout)
INPUT_WIDTH: Final = LAYOUT.impact.stop
"""The first columns: what comes from outside."""
PLATFORM_AT: Final = LAYOUT.obstacle.stop
"""Where the platform's own state begins."""

_RECORDING_FAILED: Final = int(Event.RECORDING_FAILED)
_NOTICE_AT: Final = LAYOUT.arbitration.at("notice")
_MODE_AT: Final = LAYOUT.arbitration.at("mode")
_TRAFFIC_LOST_AT: Final = LAYOUT.ahead.at("traffic_lost")
_RULES_AT: Final = LAYOUT.rules.start
_RULES: Final = (
    Notice.COLLISION,
    Notice.RED_LIGHT,
    Notice.WRONG_WAY,
    Notice.OFF_ROAD,
    Notice.SPEEDING,
    Notice.FAILING_TO_YIELD,
)
"""The notices of the first columns of `Rules`, in their order."""


class TickInputs(NamedTuple):
    """Everything that comes from outside in one tick; this, and only this, is what a replay feeds back."""

    sample: DeviceSample
    ros: RemoteCommand
    events: EventInput
    ecu: RemoteCommand = NO_COMMAND
    ahead: AheadInput = NO_AHEAD
    impact: ImpactInput = NO_IMPACT
    others: tuple[float, ...] = ()
    """The session's other platforms, each as `OTHER`."""


OTHER: Final = ("x", "y", "radius")
"""What a platform is told of another one, in m of map: a circle around its body."""


def columns(platform_state: type[tuple[float, ...]], others: int = 0) -> tuple[str, ...]:
    """Return the name of every column, `stage.field_unit`.

    Args:
        platform_state: the platform's state type.
        others: how many other platforms it reacts to.
    """
    parts = LAYOUT._asdict() | {"platform": Part(platform_state, PLATFORM_AT)}
    names = tuple(f"{stage}.{field}" for stage, part in parts.items() for field in part.names)
    return (*names, *other_columns(others))


def other_columns(others: int) -> tuple[str, ...]:
    """Return the names of the columns that tell of so many other platforms."""
    return tuple(f"others.{field}_{number}_m" for number in range(others) for field in OTHER)


def input_vector(inputs: TickInputs) -> Row:
    """Return the first INPUT_WIDTH columns of a state vector."""
    return np.array([value for part in inputs for value in part], dtype=np.float64)


class Snapshot(NamedTuple):
    """One finished tick. Views are made when asked for: most readers want one or two."""

    tick: int
    tick_hz: int
    vector: Row

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
        return read(self.vector, LAYOUT.sample)

    @property
    def ros(self) -> RemoteCommand:
        """The ROS side's newest command."""
        return read(self.vector, LAYOUT.ros)

    @property
    def ecu(self) -> RemoteCommand:
        """The ECU's newest command."""
        return read(self.vector, LAYOUT.ecu)

    @property
    def remote(self) -> RemoteCommand:
        """The commander's newest command."""
        return self.ecu if self.arbitration.commander == Commander.ECU else self.ros

    @property
    def ros_link(self) -> Link:
        """How far the ROS side's commands may be relied on."""
        return read(self.vector, LAYOUT.ros_link)

    @property
    def ecu_link(self) -> Link:
        """How far the ECU's commands may be relied on."""
        return read(self.vector, LAYOUT.ecu_link)

    @property
    def events(self) -> EventInput:
        """The edges of this tick."""
        return read(self.vector, LAYOUT.events)

    @property
    def driver(self) -> DriverInput:
        """The person, calibrated."""
        return read(self.vector, LAYOUT.driver)

    @property
    def arbitration(self) -> Arbitration:
        """Authority, mode and reason."""
        return read(self.vector, LAYOUT.arbitration)

    @property
    def recording_failed(self) -> bool:
        """Whether recording has failed: no further tick is kept."""
        return bool(int(self.vector[LAYOUT.events.start]) & _RECORDING_FAILED)

    @property
    def notice(self) -> float:
        """What people are told (`Notice`).

        A failed recording first, then the arbiter's, a broken rule of the road, failed traffic, a missing engagement.
        """
        if self.recording_failed:
            return float(Notice.RECORDING_FAILED)
        notice = float(self.vector[_NOTICE_AT]) or self.broken_rule
        if not notice and self.vector[_TRAFFIC_LOST_AT]:
            return float(Notice.TRAFFIC_LOST)
        if not notice and float(self.vector[_MODE_AT]) == Mode.PARKED and self._is_commanded:
            return float(Notice.NOT_ENGAGED)
        return notice

    @property
    def broken_rule(self) -> float:
        """The worst rule that is broken, as a notice; 0: none."""
        broken = self.vector[_RULES_AT : _RULES_AT + len(_RULES)].tolist()
        return next((float(notice) for notice, is_broken in zip(_RULES, broken, strict=True) if is_broken), 0.0)

    @property
    def _is_commanded(self) -> bool:
        fresh = (LinkState.UNSTEADY, LinkState.STEADY)
        return self.ros_link.state in fresh or self.ecu_link.state in fresh

    @property
    def command(self) -> VehicleCommand:
        """What left the gate."""
        return read(self.vector, LAYOUT.command)

    @property
    def vehicle(self) -> VehicleState:
        """The vehicle after the tick."""
        return read(self.vector, LAYOUT.vehicle)

    @property
    def torque(self) -> WheelTorque:
        """What the wheel's motor is asked for."""
        return read(self.vector, LAYOUT.torque)

    @property
    def situation(self) -> Situation:
        """The road around the vehicle."""
        return read(self.vector, LAYOUT.situation)

    @property
    def rules(self) -> Rules:
        """Which rules of the road it breaks."""
        return read(self.vector, LAYOUT.rules)
