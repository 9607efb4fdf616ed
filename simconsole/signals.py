"""The values of one tick: what the rooms hand to each other, with the unit in every field name.

Frames: ISO 8855 / REP-103, x forward, y left, z up, angles left-positive; poses are of `base_link`, the centre of
the rear axle on the ground, in `map`. Every field is a float64, so that one row holds a whole tick (rows.py) and
the same classes serve the compiled functions. Enumerations are stored as their number.
"""

from enum import IntEnum, IntFlag
from typing import Final, NamedTuple

NEVER_TICKS: Final = 1e9
"""Age of something that has never been received or whose device is gone."""


class Validity(IntEnum):
    """How far an input may be trusted. Nothing is commanded before ARMED."""

    UNKNOWN = 0
    ARMED = 1
    LIVE = 2
    STALE = 3
    LOST = 4


class Mode(IntEnum):
    """Who drives. The transitions are the table of control/modes.py and nothing else."""

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


class Commander(IntEnum):
    """Which controller is the remote side: control/commander.py holds the rule."""

    NOBODY, ROS, ECU = range(3)


class LinkState(IntEnum):
    """How far a controller's commands may be relied on."""

    NEVER, UNSTEADY, STEADY, STALE, INVALID = range(5)  # unsteady: fresh, but not for long enough to engage


class RemoteKind(IntEnum):
    """What a remote command means; control/remote.py turns each kind into one request."""

    NONE = 0
    ACCELERATION = 1
    SPEED = 2
    TWIST = 3
    ACTUATION = 4
    POSE = 5


class Event(IntFlag):
    """Edges that happened since the last tick, whoever raised them."""

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


class GearFault(IntFlag):
    """Why a gear does not go in: the bits of `VehicleState.gear_fault`, set for as long as the lever asks for it."""

    GRIND = 1  # the speeds do not match and the clutch is not pressed: it grates
    MONEY_SHIFT = 2  # the wheels would turn the engine beyond its limit
    MISSED = 4  # no such gear, or one of the other direction


class GateLimit(IntFlag):
    """What the last gate changed: the bits of `VehicleCommand.gate_active`."""

    NON_FINITE = 1
    RANGE = 2
    RATE = 4
    LATERAL_ACCELERATION = 8
    BRAKE_OVER_THROTTLE = 16
    GEAR = 32
    LATERAL_JERK = 64


class DeviceSample(NamedTuple):
    """The cockpit as read: raw axes -1..1, button masks, ages in ticks since the last good poll (NEVER_TICKS: gone)."""

    wheel_axis: float
    throttle_axis: float
    brake_axis: float
    clutch_axis: float
    handbrake_axis: float
    wheel_buttons: float
    shifter_buttons: float
    hat_x: float
    hat_y: float
    wheel_age_ticks: float
    pedals_age_ticks: float
    shifter_age_ticks: float
    handbrake_age_ticks: float  # of the pedals, where it has no device of its own
    wheel_motor: float = 0.0  # 1 while the wheel's motor obeys: then the wheel also moves by itself


class RemoteCommand(NamedTuple):
    """The newest accepted command of the ROS side, or of the ECU on CAN; fields its kind does not use are 0."""

    kind: float
    sequence: float  # commands accepted since the start; 0 before the first
    refused: float  # commands refused since the start
    age_ticks: float  # since receipt
    road_wheel_rad: float
    road_wheel_radps: float
    speed_mps: float
    accel_mps2: float
    yaw_rate_radps: float
    throttle: float
    brake: float
    x_m: float
    y_m: float
    yaw_rad: float
    direction: float  # 1 drive, -1 reverse, 0 neutral (Autoware GearCommand)


class EventInput(NamedTuple):
    """All edges that came in since the last tick, as masks of `Event`; and what is being done to the drive."""

    events: float  # of operators, the ROS side and the console itself
    faults: float = 0.0  # faults that a test has put on, a bit for each place in the scenario's list
    ecu_events: float = 0.0  # of the ECU on CAN: they count in full only while it commands


class DriverInput(NamedTuple):
    """The person, calibrated: angles left-positive, pedals 0 (released) to 1 (pressed), lever -1 (R), 0 (N), 1..7."""

    hand_wheel_rad: float
    hand_wheel_radps: float
    throttle: float
    brake: float
    clutch: float
    handbrake: float
    gear: float
    pressed: float  # Button mask, held now
    edges: float  # Button mask, pressed since the last tick
    wheel_validity: float
    throttle_validity: float
    brake_validity: float
    clutch_validity: float
    shifter_validity: float
    neutral_ticks: float  # how long the lever has shown no gear (dwell)
    refused_ticks: float = 0.0  # ticks in a row in which a reading was refused (not finite or out of range)
    lever_fault: float = 0.0  # 1: the lever shows two gears at once
    handbrake_validity: float = 0.0


class Request(NamedTuple):
    """What one source asks of the vehicle, in the actuators' own terms."""

    road_wheel_rad: float
    throttle: float
    brake: float
    clutch: float
    handbrake: float
    gear: float
    automatic: float  # 1: the car works clutch and gears itself, in the direction of `gear`


class ArbiterMemory(NamedTuple):
    """What arbitration must remember from one tick to the next."""

    mode_ticks: float  # since the mode was entered
    engage_hand_wheel_rad: float  # where the hand wheel was when autonomy was engaged
    steering_ticks: float  # samples in a row past the take-over threshold; -1: no reference yet
    throttle_override: float  # 1 while the person's accelerator overrides the remote side
    refusal_ticks: float  # since a request was refused
    standstill_ticks: float
    speed_integral_mps2: float
    stop_accel_mps2: float  # deceleration that a safe stop asks for now (<= 0)
    hold_road_wheel_rad: float  # where a safe or emergency stop holds the wheels
    stop_steered: float  # 1: the controller, which is not at fault, still steers the safe stop
    shared_trade: float  # -1: the person has pushed the controller away, 1: it has its full share


class Link(NamedTuple):
    """One controller's commands as arbitration sees them, and what it must remember of them."""

    sequence_seen: float
    refused_seen: float
    invalid_run: float  # refused commands in a row
    fresh_ticks: float  # how long commands have been fresh with none refused
    fresh: float  # 1: there is a command, it is finite, of a known kind and young enough
    invalid: float  # 1: it is not finite, or too many in a row were refused
    lease_ticks: float  # for how long it may still be the commander without a fresh command
    state: float  # `LinkState`


class Arbitration(NamedTuple):
    """Who had how much authority in this tick, and why. Person's share = 1 - remote's share.

    The remote side is the controller or, in its place, the console's own safe stop, emergency stop or parking hold.
    """

    mode: float
    reason: float  # why the mode last changed
    refusal: float  # why the latest request was refused (`Reason`), shown for a while; 0: none
    remote_lateral: float
    remote_longitudinal: float
    person_road_wheel_rad: float
    person_throttle: float
    person_brake: float
    remote_road_wheel_rad: float
    remote_throttle: float
    remote_brake: float
    takeover_stage: float  # 0 none, 1 asked, 2 escalated
    remote_guidance: float  # the remote side's authority over the wheel's motor while control is shared, 0 to 1
    commander: float  # `Commander`: whose commands are the remote side's
    ros_road_wheel_rad: float  # what the ROS side asks for, whether it commands or not
    ros_throttle: float
    ros_brake: float
    ecu_road_wheel_rad: float  # and the ECU
    ecu_throttle: float
    ecu_brake: float
    restarted: float  # 1: back to the start in this tick


class VehicleCommand(NamedTuple):
    """What leaves the last gate: finite and inside every limit."""

    road_wheel_rad: float
    throttle: float
    brake: float
    clutch: float
    handbrake: float
    gear: float
    automatic: float
    target_speed_mps: float
    target_x_m: float
    target_y_m: float
    target_yaw_rad: float
    gate_active: float  # `GateLimit` mask of the limits that changed something
    gate_active_ticks: float  # in how many ticks of the drive they have
    anti_lock_off: float = 0.0  # 1: switched off by hand, whatever the vehicle has
    traction_off: float = 0.0
    stability_off: float = 0.0


class VehicleState(NamedTuple):
    """The vehicle as others see it; pose and velocity of base_link, accelerations of the centre of gravity."""

    x_m: float
    y_m: float
    z_m: float
    yaw_rad: float
    pitch_rad: float
    roll_rad: float
    vx_mps: float
    vy_mps: float
    yaw_rate_radps: float
    ax_mps2: float
    ay_mps2: float
    road_wheel_rad: float
    hand_wheel_torque_nm: float  # at the rim, left-positive
    engine_radps: float
    engine_running: float
    gear: float  # engaged in the gearbox
    clutch: float  # 0 closed, 1 open, after the automatic
    distance_m: float
    coast_accel_mps2: float  # what released pedals would give now
    full_throttle_accel_mps2: float  # what full throttle would give now
    full_brake_accel_mps2: float  # what full brake would give now (negative)
    gear_fault: float = 0.0  # `GearFault` mask: why the lever's gear does not go in


class WheelTorque(NamedTuple):
    """What the wheel's motor is asked for, at the rim, left-positive; all 0 where the cockpit has no motor."""

    torque_nm: float
    car_nm: float  # the car's part of it, before the limits
    servo_nm: float  # the part that follows the road wheels
    guide_nm: float  # the part that guides the person's hands while control is shared
    ramp: float  # 0 (let go) to 1: torque comes in slowly
    clipped: float  # 1: more is wished for than the motor has
    enabled: float
    human_nm: float  # the person's torque, estimated
    hands_on: float  # 1: somebody holds the wheel


class WheelMemory(NamedTuple):
    """What force feedback must remember from one tick to the next."""

    live: float  # 1: the wheel was there, with its motor
    wheel_rad: float  # as estimated
    wheel_radps: float
    motor_nm: float  # delivered by now
    hands_nm: float
    target_rad: float
    model_rad: float  # where the motor alone would have the wheel
    model_radps: float
    model_nm: float
    explained_rad: float  # how far the motor alone has moved it since a take-over has been possible
    explained_radps: float
    guide_rad: float  # slow part of the angle that the controller asks of the hand wheel


class TickTiming(NamedTuple):
    """Wall-clock facts of one tick: they travel beside the snapshot, so equal drives stay equal bytes."""

    late_ns: int
    work_ns: int


NO_SAMPLE: Final = DeviceSample(*(0.0,) * 9, *(NEVER_TICKS,) * 4)
"""A cockpit that is not there."""

NO_TORQUE: Final = WheelTorque(*(0.0,) * len(WheelTorque._fields))
"""A wheel that is let go of."""

NO_COMMAND: Final = RemoteCommand(*(0.0,) * len(RemoteCommand._fields))._replace(age_ticks=NEVER_TICKS, direction=1.0)
"""A controller that has said nothing; until it does, forwards is the direction it means."""

NO_EVENTS: Final = EventInput(events=0.0)
"""A tick in which nothing happened."""
