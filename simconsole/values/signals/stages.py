"""What each stage of a tick made of the inputs, and what it must remember for the next tick."""

from typing import Final, NamedTuple


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
    turn_indicators: float  # 1 left, -1 right, 0 off
    hazard_lights: float  # 1: on


class ArbiterMemory(NamedTuple):
    """What arbitration must remember from one tick to the next."""

    mode_ticks: float  # since the mode was entered, or since the wait that belongs to it began anew
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
    stalk: float  # the person's turn indicators: 1 left, -1 right, 0 off
    hazard_switch: float  # the person's hazard lights, 1: on
    throttle_held_ticks: float  # for how long the accelerator has overridden a controller that drives
    restart_ticks: float  # for how long a restart has waited for wheel and pedals; 0: none does


class Link(NamedTuple):
    """One controller's commands as arbitration sees them, and what it must remember of them."""

    sequence_seen: float
    refused_seen: float
    invalid_run: float  # refused or implausible commands in a row
    fresh_ticks: float  # how long commands have been fresh, plausible, none refused and the controller not invalid
    fresh: float  # 1: there is a command, it is finite, of a known kind and young enough
    invalid: float  # 1: it is not finite, or too many in a row were refused or implausible
    lease_ticks: float  # for how long it may still be the commander without a fresh command
    state: float  # `LinkState`
    implausible: float  # commands since the start that steered too hard to be meant, and were not followed
    implausible_ticks: float  # age of the last plausible command while the newest is not one; 0: the newest is


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
    notice: float  # `Notice`


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
    turn_indicators: float  # 1 left, -1 right, 0 off
    hazard_lights: float  # 1: on
    gate_active: float  # `GateLimit` mask of the limits that changed something
    gate_active_ticks: float  # in how many ticks of the drive they have
    anti_lock_off: float = 0.0  # 1: switched off by hand, whatever the vehicle has
    traction_off: float = 0.0
    stability_off: float = 0.0
    target_yaw_rate_radps: float = 0.0  # beside `target_speed_mps`, of a twist: for platforms that turn in place


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
    car_share: float  # of the car's torque that this motor can bear at this speed without swinging, 0 to 1


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
    answered_rad: float  # the hand wheel's angle that the car's tyres have answered
    yaw_radps: float  # slow part of the car's yaw rate
    carried_nm: float  # of the person's torque, what they held before they could take over by it: it fades


class MotorPipe(NamedTuple):
    """Torque that was asked for and is on its way to the wheel, in N m; the first cell is filled first."""

    cell_1_nm: float
    cell_2_nm: float
    cell_3_nm: float
    cell_4_nm: float
    cell_5_nm: float
    cell_6_nm: float


NO_TORQUE: Final = WheelTorque(*(0.0,) * len(WheelTorque._fields))
"""A wheel that is let go of."""
