"""What stays constant over a drive, in SI, ready for the kernels; `car_platform.py` computes it from the profile.

Whatever the kernels divide by is here as its reciprocal: `per_mass_kg` is 1 / mass_kg. A division costs them as much
as ten products.
"""

from typing import Final, NamedTuple

from simconsole.values.layout import Part


class AxleParameters(NamedTuple):
    """One axle. Figures of tyre, spring and brake are of one wheel; tyre stiffness is per newton of load."""

    ahead_m: float  # of the centre of gravity, negative: behind
    half_track_m: float
    roll_rad_per_m: float  # of the axle, per difference of its wheels' lifts
    wheel_inertia_kgm2: float
    per_wheel_inertia_kgm2: float
    spin_radps_per_newton_second: float  # by which a force at the ground changes a wheel's speed: radius over inertia
    per_wheel_mass_kg: float
    radius_m: float
    static_n: float  # load of one wheel at rest on level ground
    per_static_n: float
    stiffness_x_per_m: float  # slip stiffness / relaxation length
    stiffness_y_per_m: float
    decay_x_per_m: float  # 1 / relaxation length
    decay_y_per_m: float
    damping_nspm: float
    locked_damping_nspm: float
    friction: float  # of the tyre on a ground of friction 1, at static load
    friction_fall: float  # share of the friction lost per static load more
    stiffness_fall: float  # share of the stiffness lost per static load more
    slide_demand: float  # demand at which the contact patch slides altogether
    camber_offset: float  # slip that any camber adds, towards the lean
    camber_slip: float  # slip per rad of camber
    camber_gain: float  # camber per rad of roll between body and axle
    rolling_resistance: float
    spring_npm: float
    damper_nspm: float
    bar_npm: float  # force on a wheel per difference of both wheels' travel
    travel_m: float  # up to the stop, both ways
    stop_npm: float
    carcass_npm: float  # vertical stiffness of the tyre
    carcass_nspm: float
    roll_arm_m: float  # at which the side force rolls the body
    link_arm_m: float  # at which it loads the wheels directly: roll centre and the wheels' own mass
    support_slope: float  # way of the contact patches along the car per compression of the struts, positive forwards
    brake_nm: float
    brake_ease: float  # share of the way to the wanted brake torque that a step takes
    handbrake_nm: float
    peak_slip: float  # slip at the peak of the force, per friction used: where half of the stiffness is left


class EngineParameters(NamedTuple):
    """The engine. Full-throttle torque is a sum of ramps: one slope from each speed upwards."""

    inertia_kgm2: float
    per_inertia_kgm2: float
    drag_nm: float
    drag_nms: float
    hold_nm: float
    idle_radps: float
    per_idle_radps: float
    idle_gain_nms: float
    idle_max_nm: float
    stall_radps: float
    fire_radps: float
    starter_nm: float
    limit_radps: float
    per_limit_band_radps: float
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
    per_clutch_nm: float
    heat_per_j: float  # of the clutch, as share of the heat that it may have
    cooling_per_s: float
    loss_share: float  # of the torque at the wheels that the gears' friction takes
    bite_closed: float  # pedal position below which the clutch transmits everything
    bite_open: float  # pedal position above which it transmits nothing
    per_bite: float  # 1 / the way between them
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
    per_wheel_radius_m: float
    shift_s: float
    shift_pause_s: float
    per_ramp_s: float  # 1 / time in which a shift gives the torque away or back
    up_radps: float
    up_per_throttle_radps: float
    down_radps: float
    down_per_throttle_radps: float
    launch_from_radps: float  # engine speed that the automatic clutch holds while it slips, with hardly any throttle
    launch_to_radps: float  # and with all of it
    launch_per_throttle_radps: float
    launch_nms: float  # clutch torque per engine speed beyond it
    sync_nm: float  # clutch torque beyond the engine's by which a slip ends
    idle_radps: float
    per_fade_radps: float  # 1 / gearbox speed above idle at which nothing is left of creeping
    creep_nm: float  # clutch torque with released pedals
    creep_held_nm: float  # what of it the idle governor holds against a standing car
    per_creep_held_nm: float
    lock_from_radps: float  # gearbox speed at which it may begin to close
    per_lock_radps: float
    clutch_opening_per_s: float
    clutch_closing_per_s: float
    rear_driven: float  # 1: the rear wheels, 0: the front wheels
    lock_nm: float  # torque that the differential always keeps between its wheels
    lock_share: float  # and its share of the driving torque


class BodyParameters(NamedTuple):
    """Body and aerodynamics."""

    mass_kg: float
    per_mass_kg: float
    moving_kg: float  # with what the spin of the wheels adds
    per_sprung_kg: float
    per_roll_inertia_kgm2: float
    per_pitch_inertia_kgm2: float
    per_yaw_inertia_kgm2: float
    cg_to_front_m: float
    cg_to_rear_m: float
    cg_height_m: float
    drag_n_per_square_mps: float  # force per squared speed
    front_lift_n_per_square_mps: float  # positive: up
    rear_lift_n_per_square_mps: float
    side_n_per_square_mps: float  # side force per speed of the air and its part from the side
    yaw_nm_per_square_mps: (
        float  # moment about the middle of the wheelbase per speeds of the air along and from the side
    )
    sway_nm_per_rad: float  # sprung weight times the mean roll arm, per rad: rolling lets the body down
    full_brake_n: float  # what the brakes of all four wheels give
    unsprung_kgm: float  # how far ahead of the centre of gravity the wheels' masses are, times them


class SteeringParameters(NamedTuple):
    """Hand wheel to road wheels and back."""

    rack_pull_radps: float  # stiffness of the critically damped rack over its inertia, times the step
    rack_ease: float  # what an implicit step leaves of its rate
    rate_radps: float
    max_road_wheel_rad: float
    friction_rad: float  # deviation that friction holds
    compliance_rad_per_nm: float  # by which the tyres' moment turns the wheels
    ackermann: float  # share of the ideal times half of track over wheelbase
    pneumatic_trail_m: float
    per_trail_end: float  # 1 / demand at which the pneumatic trail is gone
    caster_trail_m: float
    turn_slip_arm_m: float  # moment on the spot over friction and load
    per_ratio: float
    unassisted_share: float  # that the assistance leaves of a large torque, standing
    unassisted_share_per_mps: float  # more of it per speed
    per_assist_nm: float  # 1 / torque around which the assistance comes in
    per_hand_torque_most_nm: float  # 1 / torque towards which the assistance bends
    hand_damping_nms: float  # per road-wheel rate
    hand_friction_nm: float
    per_friction_rad: float  # 1 / road-wheel angle over which the friction comes in


class AidParameters(NamedTuple):
    """Driver aids; a switch is 0 or 1. Slips are shares of the speed over ground."""

    anti_lock: float
    traction: float
    stability: float
    hill_hold: float
    understeer_per_square_mps: float  # of the yaw rate that ESC expects: r = v d / (L (1 + k v^2))
    lateral_mps2: float  # which ESC takes for the most that the ground gives
    stability_nms: float  # brake torque per yaw rate beyond the dead band
    stability_most_nm: float


class CarParameters(NamedTuple):
    """All of it; the parameter row is these groups one after the other."""

    body: BodyParameters
    steering: SteeringParameters
    engine: EngineParameters
    gears: GearParameters
    aids: AidParameters
    front: AxleParameters
    rear: AxleParameters


PARAMETERS: Final = Part(CarParameters)
"""Where they lie in the parameter row."""
