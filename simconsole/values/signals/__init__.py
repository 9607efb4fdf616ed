"""The values of one tick that the packages exchange, with the unit in every field name.

Frames: ISO 8855 / REP-103, x forward, y left, z up, angles left-positive; poses are of `base_link`, the centre of
the rear axle on the ground, in `map`. Every field is a float64, so that one vector holds a whole tick
(state_vector.py) and the same classes serve the compiled functions. Enumerations are stored as their number.
"""

from simconsole.values.signals.codes import (
    Button,
    Commander,
    Event,
    GateLimit,
    GearFault,
    LinkState,
    Mode,
    Notice,
    Reason,
    RemoteKind,
    SignalState,
    Validity,
)
from simconsole.values.signals.inputs import (
    MOTOR_UNKNOWN,
    NEVER_TICKS,
    NO_COMMAND,
    NO_EVENTS,
    NO_SAMPLE,
    DeviceSample,
    EventInput,
    RemoteCommand,
)
from simconsole.values.signals.stages import (
    NO_TORQUE,
    ArbiterMemory,
    Arbitration,
    DriverInput,
    Link,
    MotorPipe,
    Request,
    VehicleCommand,
    VehicleState,
    WheelMemory,
    WheelTorque,
)
from simconsole.values.signals.surroundings import (
    FAR,
    NO_AHEAD,
    NO_RULES_BROKEN,
    NO_SITUATION,
    AheadInput,
    Rules,
    Situation,
)

__all__ = [
    "FAR",
    "MOTOR_UNKNOWN",
    "NEVER_TICKS",
    "NO_AHEAD",
    "NO_COMMAND",
    "NO_EVENTS",
    "NO_RULES_BROKEN",
    "NO_SAMPLE",
    "NO_SITUATION",
    "NO_TORQUE",
    "AheadInput",
    "ArbiterMemory",
    "Arbitration",
    "Button",
    "Commander",
    "DeviceSample",
    "DriverInput",
    "Event",
    "EventInput",
    "GateLimit",
    "GearFault",
    "Link",
    "LinkState",
    "Mode",
    "MotorPipe",
    "Notice",
    "Reason",
    "RemoteCommand",
    "RemoteKind",
    "Request",
    "Rules",
    "SignalState",
    "Situation",
    "Validity",
    "VehicleCommand",
    "VehicleState",
    "WheelMemory",
    "WheelTorque",
]
