"""What the car remembers between steps: its columns of the state vector, and the same in groups for the kernels."""

from typing import Final, NamedTuple

from simconsole.values.layout import Part
from simconsole.values.state_vector import PLATFORM_AT


class BodyState(NamedTuple):
    """Pose of base_link in map; motion of the centre of gravity along the body; lift and lean above the ground's plane.

    Heave, roll and pitch are measured from the car at rest on level ground: ISO 8855, roll positive left side up,
    pitch positive nose down.
    """

    x_m: float
    y_m: float
    yaw_rad: float
    vx_mps: float
    vy_mps: float
    yaw_rate_radps: float
    ax_mps2: float
    ay_mps2: float
    heave_m: float
    heave_mps: float
    roll_rad: float
    roll_radps: float
    pitch_rad: float
    pitch_radps: float
    distance_m: float


class SteeringState(NamedTuple):
    """The rack, as the mean angle of the front wheels, and what the rim feels."""

    road_wheel_rad: float
    road_wheel_radps: float
    hand_wheel_torque_nm: float
    patch_twist_rad: float  # of the front wheels against their contact patches, left-positive
    rim_friction_share: float  # of the steering's dry friction that acts, left-positive


class Wheel(NamedTuple):
    """One wheel: spin, deflection of its contact patch against the rim, lift from rest, its brake."""

    radps: float
    deflection_x_m: float
    deflection_y_m: float
    lift_m: float
    lift_mps: float
    brake_nm: float  # torque that the pressure at the wheel gives now


class ShaftState(NamedTuple):
    """Engine, and the friction impulses of the last step: the next solution starts from them."""

    engine_radps: float
    engine_running: float
    engine_impulse_nms: float
    clutch_impulse_nms: float
    left_impulse_nms: float  # brake of the left driven wheel
    right_impulse_nms: float
    lock_impulse_nms: float  # of the differential, positive drives the left wheel
    clutch_heat: float  # 0 cold, 1 as hot as it may become
    clutch_hot: float  # 1 while the automatic keeps it open to cool


class Gearbox(NamedTuple):
    """Clutch and gears."""

    gear: float  # engaged
    clutch: float  # pedal position in force, 0 closed, 1 open
    lever_adopted: float  # 0 after automatic driving, until the person takes the gears back
    wanted_gear: float  # of the shift in progress
    shift_left_s: float  # until the shift in progress is over
    since_shift_s: float
    gear_fault: float  # `GearFault` mask: why the lever's gear does not go in


class AidState(NamedTuple):
    """Traction control, stability control, hill hold."""

    throttle_share: float  # what TCS leaves of the throttle, 0..1
    stability_nm: float  # ESC's brake torque: positive turns the car left
    hold_left_s: float  # how long the hill hold still holds
    hold_brake: float  # the pedal that it holds


class Car(NamedTuple):
    """The state in groups, in the order of its columns."""

    body: BodyState
    steering: SteeringState
    fl: Wheel
    fr: Wheel
    rl: Wheel
    rr: Wheel
    shafts: ShaftState
    box: Gearbox
    aids: AidState


class CarState(NamedTuple):
    """The columns: the groups of `Car` one after the other, wheels prefixed by where they are (front left first)."""

    x_m: float
    y_m: float
    yaw_rad: float
    vx_mps: float
    vy_mps: float
    yaw_rate_radps: float
    ax_mps2: float
    ay_mps2: float
    heave_m: float
    heave_mps: float
    roll_rad: float
    roll_radps: float
    pitch_rad: float
    pitch_radps: float
    distance_m: float
    road_wheel_rad: float
    road_wheel_radps: float
    hand_wheel_torque_nm: float
    patch_twist_rad: float
    rim_friction_share: float
    fl_radps: float
    fl_deflection_x_m: float
    fl_deflection_y_m: float
    fl_lift_m: float
    fl_lift_mps: float
    fl_brake_nm: float
    fr_radps: float
    fr_deflection_x_m: float
    fr_deflection_y_m: float
    fr_lift_m: float
    fr_lift_mps: float
    fr_brake_nm: float
    rl_radps: float
    rl_deflection_x_m: float
    rl_deflection_y_m: float
    rl_lift_m: float
    rl_lift_mps: float
    rl_brake_nm: float
    rr_radps: float
    rr_deflection_x_m: float
    rr_deflection_y_m: float
    rr_lift_m: float
    rr_lift_mps: float
    rr_brake_nm: float
    engine_radps: float
    engine_running: float
    engine_impulse_nms: float
    clutch_impulse_nms: float
    left_impulse_nms: float
    right_impulse_nms: float
    lock_impulse_nms: float
    clutch_heat: float
    clutch_hot: float
    gear: float
    clutch: float
    lever_adopted: float
    wanted_gear: float
    shift_left_s: float
    since_shift_s: float
    gear_fault: float
    throttle_share: float
    stability_nm: float
    hold_left_s: float
    hold_brake: float


CAR: Final = Part(Car, PLATFORM_AT)
"""Where the state lies in a state vector."""
