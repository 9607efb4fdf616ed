"""What stays constant over a drive, in SI, ready for the kernels; `assembly.py` computes it from the profile."""

from typing import Final, NamedTuple


class AxleParameters(NamedTuple):
    """One axle: both wheels, tyres and brakes taken together. Stiffness is per newton of load."""

    wheel_inertia_kgm2: float
    radius_m: float
    stiffness_x_per_m: float  # slip stiffness / relaxation length
    stiffness_y_per_m: float
    decay_x_per_m: float  # 1 / relaxation length
    decay_y_per_m: float
    damping_nspm: float
    locked_damping_nspm: float
    friction: float  # of tyre and ground together
    rolling_resistance: float
    brake_nm: float
    handbrake_nm: float


class EngineParameters(NamedTuple):
    """The engine. Full-throttle torque is a sum of ramps: one slope from each speed upwards."""

    inertia_kgm2: float
    drag_nm: float
    drag_nms: float
    hold_nm: float
    idle_radps: float
    idle_gain_nms: float
    idle_max_nm: float
    stall_radps: float
    fire_radps: float
    starter_nm: float
    limit_radps: float
    limit_band_radps: float
    ramp_1_radps: float
    ramp_1_nms: float
    ramp_2_radps: float
    ramp_2_nms: float
    ramp_3_radps: float
    ramp_3_nms: float
    ramp_4_radps: float
    ramp_4_nms: float
    ramp_5_radps: float
    ramp_5_nms: float
    ramp_6_radps: float
    ramp_6_nms: float
    ramp_7_radps: float
    ramp_7_nms: float
    ramp_8_radps: float
    ramp_8_nms: float


class GearParameters(NamedTuple):
    """Clutch, gears and the automatic. Ratios are engine to wheel with the final drive; 0: there is no such gear."""

    clutch_nm: float
    bite_closed: float  # pedal position below which the clutch transmits everything
    bite_open: float  # pedal position above which it transmits nothing
    ratio_reverse: float  # negative
    ratio_1: float
    ratio_2: float
    ratio_3: float
    ratio_4: float
    ratio_5: float
    ratio_6: float
    ratio_7: float
    gears: float
    synchro_radps: float
    limit_radps: float
    wheel_radius_m: float
    shift_s: float
    shift_pause_s: float
    up_radps: float
    up_per_throttle_radps: float
    down_radps: float
    down_per_throttle_radps: float
    launch_from_radps: float  # engine speed at which the automatic clutch begins to bite
    launch_to_radps: float
    lock_from_radps: float  # gearbox speed at which it begins to close
    lock_to_radps: float
    clutch_opening_per_s: float
    clutch_closing_per_s: float


class BodyParameters(NamedTuple):
    """Body, aerodynamics, steering and the plane of the ground."""

    mass_kg: float
    yaw_inertia_kgm2: float
    cg_to_front_m: float
    cg_to_rear_m: float
    cg_height_m: float
    drag_nsspmm: float  # force per squared speed
    sway_s: float
    pitch_rad_per_mps2: float
    roll_rad_per_mps2: float
    slope_x: float
    slope_y: float
    gravity_plane_mps2: float  # gravity / sqrt(1 + slope^2): times slope along, times 1 normal to the plane
    steering_lag_s: float
    steering_radps: float
    max_road_wheel_rad: float
    pneumatic_trail_m: float
    caster_trail_m: float
    hand_torque_gain: float  # assistance / steering ratio
    hand_damping_nms: float


BODY_AT: Final = 0
BODY_WIDTH: Final = len(BodyParameters._fields)
ENGINE_AT: Final = BODY_AT + BODY_WIDTH
ENGINE_WIDTH: Final = len(EngineParameters._fields)
GEARS_AT: Final = ENGINE_AT + ENGINE_WIDTH
GEARS_WIDTH: Final = len(GearParameters._fields)
FRONT_AT: Final = GEARS_AT + GEARS_WIDTH
AXLE_WIDTH: Final = len(AxleParameters._fields)
REAR_AT: Final = FRONT_AT + AXLE_WIDTH


class CarParameters(NamedTuple):
    """All of it; the parameter row is these groups one after the other."""

    body: BodyParameters
    engine: EngineParameters
    gears: GearParameters
    front: AxleParameters
    rear: AxleParameters
