"""What the numbers of a tick mean: enumerations and masks. The state vector holds their values: none ever changes."""

from enum import IntEnum, IntFlag


class Validity(IntEnum):
    """How far an input may be trusted. Nothing is commanded before ARMED."""

    UNKNOWN = 0
    ARMED = 1
    LIVE = 2
    STALE = 3
    LOST = 4


class Mode(IntEnum):
    """Who drives. The transitions are those of control/modes/mode_table.py and no others."""

    PARKED = 0
    MANUAL = 1
    SHARED = 2
    AUTONOMOUS = 3
    TAKEOVER_REQUESTED = 4
    MINIMAL_RISK = 5
    STOPPED = 6
    EMERGENCY_STOP = 7


class Reason(IntEnum):
    """Why the mode last changed, or why a request to change it was refused."""

    START = 0
    PERSON_ASKED = 1
    OPERATOR_ASKED = 2
    REMOTE_ASKED = 3
    STEERING_OVERRIDE = 4
    BRAKE_OVERRIDE = 5
    THROTTLE_OVERRIDE = 6
    COMMAND_STALE = 7
    COMMAND_INVALID = 8
    DEVICE_LOST = 9
    NO_REACTION = 10
    STANDSTILL = 11
    EMERGENCY = 12
    RESET = 13
    ARMED = 14
    LOOP_STALL = 15
    COMMANDER_LOST = 16
    OPERATOR_EMERGENCY = 17
    OPERATOR_RESET = 18
    REFUSED_NO_COMMAND = 20
    REFUSED_BRAKE_PRESSED = 21
    REFUSED_TOO_FAST = 22
    REFUSED_LATERAL_ACCELERATION = 23
    REFUSED_NOT_ARMED = 24
    REFUSED_EMERGENCY = 25
    REFUSED_DEVIATION = 26
    REFUSED_MODE = 27
    REFUSED_THROTTLE_PRESSED = 28
    REFUSED_MOVING = 29
    REFUSED_NOT_STABLE = 30
    REFUSED_NOT_COMMANDER = 31
    REFUSED_WHEEL_NOT_CENTRED = 32
    REFUSED_PEDAL_PRESSED = 33
    REFUSED_IMPLAUSIBLE = 34
    REFUSED_OVERRULED = 35
    REFUSED_WHEEL_UNKNOWN = 36


class Notice(IntEnum):
    """A condition that a person is told of while it lasts, without a change of mode."""

    NONE = 0
    THROTTLE_HELD = 1  # the accelerator has overridden the controller for long
    CENTRING_WHEEL = 2  # by its motor, before a restart
    CENTRE_WHEEL = 3  # the same, where it has no motor
    RELEASE_PEDALS = 4
    RECORDING_FAILED = 5  # this and those below are said by the console itself (Snapshot.notice), not by the arbiter
    NOT_ENGAGED = 6  # a controller commands a parked car, and nobody has asked for autonomy
    RED_LIGHT = 7  # this and the next: a rule of the road is broken
    WRONG_WAY = 8
    OFF_ROAD = 9
    SPEEDING = 10
    FAILING_TO_YIELD = 11
    COLLISION = 12
    TRAFFIC_LOST = 13  # the simulator that moved the others has failed


class SignalState(IntEnum):
    """What a signal shows to a movement: MovementPhaseState of SAE J2735 and ETSI TS 103 301, names and numbers."""

    UNAVAILABLE = 0  # no signal
    DARK = 1
    STOP_THEN_PROCEED = 2  # as a stop sign
    STOP_AND_REMAIN = 3  # red
    PRE_MOVEMENT = 4  # red and yellow
    PERMISSIVE_MOVEMENT_ALLOWED = 5  # green, but others have the right of way
    PROTECTED_MOVEMENT_ALLOWED = 6  # green
    PERMISSIVE_CLEARANCE = 7  # yellow
    PROTECTED_CLEARANCE = 8  # yellow, nobody else may come
    CAUTION_CONFLICTING_TRAFFIC = 9  # flashing yellow


class Commander(IntEnum):
    """Which controller is the remote side: control/requests/commander.py has the rule."""

    NOBODY, ROS, ECU = range(3)


class LinkState(IntEnum):
    """How far a controller's commands may be relied on."""

    NEVER, UNSTEADY, STEADY, STALE, INVALID = range(5)  # unsteady: fresh, but not for long enough to engage


class RemoteKind(IntEnum):
    """What a remote command means; control/requests/remote.py turns each kind into one request."""

    NONE = 0
    ACCELERATION = 1
    SPEED = 2
    TWIST = 3
    ACTUATION = 4
    POSE = 5


class Event(IntFlag):
    """Edges that happened since the last tick, whoever raised them; RECORDING_FAILED alone lasts."""

    EMERGENCY_STOP = 1
    RESET = 2
    REQUEST_MANUAL = 4
    REQUEST_AUTONOMOUS = 8
    REQUEST_TAKEOVER = 16
    REQUEST_SHARED = 32
    COMMANDER_LOST = 64
    MARK = 128
    LOOP_STALL = 256
    NO_ANSWER = 512
    PAUSE = 1024
    START = 2048
    RESTART = 4096
    FAULT = 8192
    TOGGLE_ANTI_LOCK = 16384
    TOGGLE_TRACTION = 32768
    TOGGLE_STABILITY = 65536
    RECORDING_FAILED = 131072  # in every tick from the one after the failure: nothing more is kept
    END = 262144  # somebody has ended the drive by a signal; from here on the console brings the vehicle to rest
    OPERATOR = 524288  # beside the acts that an operator asked for: they are told as the operator's
    COLLISION = 1048576  # the vehicle has touched a road user or a fixed thing that it did not touch before


class Button(IntFlag):
    """What a pressed button means after the device profile has given it a role."""

    AUTONOMOUS = 1
    MANUAL = 2
    EMERGENCY_STOP = 4
    RESET = 8
    SHIFT_UP = 16
    SHIFT_DOWN = 32
    INDICATOR_LEFT = 64
    INDICATOR_RIGHT = 128
    MARK = 256
    PAUSE = 512  # and start again
    RESTART = 1024
    TAKEOVER = 2048
    SHARED = 4096
    FAULT = 8192
    HAZARD = 16384
    HANDBRAKE_BUTTON = 32768  # pulled fully while held
    HORN = 65536


class GearFault(IntFlag):
    """Why a gear does not go in or does not drive: the bits of `VehicleState.gear_fault`, set while it is so."""

    GRIND = 1  # the speeds do not match and the clutch is not pressed: it grates
    MONEY_SHIFT = 2  # the wheels would turn the engine beyond its limit
    MISSED = 4  # no such gear, or one of the other direction
    CLUTCH_HOT = 8  # it is in, but the automatic keeps the clutch open until it has cooled


class GateLimit(IntFlag):
    """What the last gate changed: the bits of `VehicleCommand.gate_active`."""

    NON_FINITE = 1
    RANGE = 2
    RATE = 4
    LATERAL_ACCELERATION = 8
    BRAKE_OVER_THROTTLE = 16
    GEAR = 32
    LATERAL_JERK = 64
