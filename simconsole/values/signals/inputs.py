"""What comes from outside in one tick, and what each is when nothing comes."""

from typing import Final, NamedTuple

NEVER_TICKS: Final = 1e9
"""Age of something that has never been received or whose device is gone."""


MOTOR_UNKNOWN: Final = 0.5
"""`wheel_motor` of a motor that obeys, but whose figures nobody has found: it does not turn the wheel by itself."""


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
    wheel_motor: float = 0.0  # 1 while the wheel's motor obeys: then the wheel also moves by itself; or MOTOR_UNKNOWN


class RemoteCommand(NamedTuple):
    """The newest accepted command of the ROS side, or of the ECU on CAN; fields its kind does not use are 0."""

    kind: float = 0.0
    sequence: float = 0.0  # commands accepted since the start; 0 before the first
    refused: float = 0.0  # commands refused since the start
    age_ticks: float = 0.0  # since receipt
    road_wheel_rad: float = 0.0
    road_wheel_radps: float = 0.0
    speed_mps: float = 0.0
    accel_mps2: float = 0.0
    yaw_rate_radps: float = 0.0
    throttle: float = 0.0
    brake: float = 0.0
    x_m: float = 0.0
    y_m: float = 0.0
    yaw_rad: float = 0.0
    direction: float = 0.0  # 1 drive, -1 reverse, 0 neutral (Autoware GearCommand)
    turn_indicators: float = 0.0  # 1 left, -1 right, 0 off
    hazard_lights: float = 0.0  # 1: on


class EventInput(NamedTuple):
    """All edges that came in since the last tick, as masks of `Event`; and what is being done to the drive."""

    events: float  # of operators, the ROS side and the console itself
    faults: float = 0.0  # faults that a test has put on, a bit for each place in the scenario's list
    ecu_events: float = 0.0  # of the ECU on CAN: they count in full only while it commands


NO_SAMPLE: Final = DeviceSample(*(0.0,) * 9, *(NEVER_TICKS,) * 4)
"""A cockpit whose devices are all gone."""

NO_COMMAND: Final = RemoteCommand(age_ticks=NEVER_TICKS, direction=1.0)
"""A controller that has sent nothing; until it does, its direction counts as forwards."""

NO_EVENTS: Final = EventInput(events=0.0)
"""A tick in which nothing happened."""
