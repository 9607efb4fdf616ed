"""What the car remembers from one step to the next: its columns of the row."""

from typing import Final, NamedTuple


class CarState(NamedTuple):
    """State after a step of 1 ms. Wheels and tyres are per axle; deflections are in the wheel's own directions."""

    x_m: float  # base_link in map
    y_m: float
    yaw_rad: float
    vx_mps: float  # centre of gravity, along the body
    vy_mps: float
    yaw_rate_radps: float
    ax_mps2: float  # centre of gravity, all forces
    ay_mps2: float
    transfer_ax_mps2: float  # what load transfer and pitch follow: tyre force per mass, filtered
    lean_ay_mps2: float  # what roll follows, filtered
    road_wheel_rad: float
    front_wheel_radps: float
    rear_wheel_radps: float
    front_deflection_x_m: float  # of the contact patch against the rim
    front_deflection_y_m: float
    rear_deflection_x_m: float
    rear_deflection_y_m: float
    hand_wheel_torque_nm: float
    engine_radps: float
    engine_running: float
    engine_impulse_nms: float  # friction of the last step: the next solution starts from it
    clutch_impulse_nms: float
    brake_impulse_nms: float
    gear: float  # engaged
    clutch: float  # pedal position in force, 0 closed, 1 open
    lever_adopted: float  # 0 after automatic driving, until the person takes the gears back
    wanted_gear: float  # of the shift in progress
    shift_left_s: float  # until the shift in progress is over
    since_shift_s: float
    distance_m: float


CAR_WIDTH: Final = len(CarState._fields)
