"""Profile of the arbitration: when a person takes over, when the car stops by itself, what the last gate lets pass.

Every default names its source. Abbreviations: R157 is UN Regulation 157 (automated lane keeping), AW is Autoware's
vehicle_cmd_gate, operation_mode_transition_manager and autoware_mrm_* parameters, OD is commaai/opendbc's safety layer.
"""

from typing import Annotated, Literal, TypeAlias

import msgspec

Fraction: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]
Threshold: TypeAlias = Annotated[float, msgspec.Meta(ge=0.01, le=0.5)]
Seconds: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=60.0)]
Acceleration: TypeAlias = Annotated[float, msgspec.Meta(gt=0.0, le=20.0)]
Slew: TypeAlias = Annotated[float, msgspec.Meta(ge=0.5, le=50.0)]


class ControlProfile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Settings of arbitration and gate in a person's units; control/requests/control_settings.py converts them."""

    # The cockpit and the vehicle it drives.
    person_required: bool = True  # False: drives with no person in the seat (the ball); autonomy starts from PARKED
    manual_automatic: bool = False  # True: cockpits without clutch and shifter (keyboard)

    # Take-over by the person.
    steering_override_deg: Annotated[float, msgspec.Meta(ge=1.0, le=90.0)] = 8.0  # moved since engagement; to be tuned
    steering_override_hysteresis_deg: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)] = 1.0  # a shaking hand counts on
    steering_override_rate_degps: Annotated[float, msgspec.Meta(ge=10.0, le=2000.0)] = 60.0  # a hand that means it
    steering_override_nm: Annotated[float, msgspec.Meta(ge=0.3, le=20.0)] = 1.4  # more than hands that rest on the rim
    steering_override_hold_s: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] = 0.05  # OD: 5 frames of 10 ms
    brake_override: Threshold = 0.05  # R157 6.3.1; OD: any brake
    throttle_override: Threshold = 0.05  # longitudinal only, while held: OD "overriding"
    throttle_override_hysteresis: Annotated[float, msgspec.Meta(ge=0.0, le=0.05)] = 0.01
    throttle_held_s: Seconds = 5.0  # longer than this the person is told that the accelerator overrides: chosen
    clutch_pressed: Annotated[float, msgspec.Meta(ge=0.1, le=1.0)] = (
        0.8  # after autonomy, the person's clutch takes the gears back
    )
    device_back_s: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)] = (
        0.5  # lost wheel and pedals take a stopping car over by hand so long after they are back: plugs bounce; chosen
    )
    fade_s: Annotated[float, msgspec.Meta(ge=0.02, le=5.0)] = 0.6  # hand-over of authority

    # Faults of the command and take-over requests.
    command_stale_s: Annotated[float, msgspec.Meta(ge=0.02, le=2.0)] = 0.2  # AW and ros2_control: 0.5 s
    commander_lease_s: Annotated[float, msgspec.Meta(ge=0.1, le=60.0)] = 0.5  # as the lease among clients of the bridge
    invalid_commands_max: Annotated[int, msgspec.Meta(ge=1, le=100)] = 5  # OD: 5 wrong counters
    implausible_lateral_accel_ratio: Annotated[float, msgspec.Meta(ge=1.0, le=10.0)] = (
        2.0  # of automatic_lateral_accel_mps2: 10 m/s2, more than a road tyre gives (friction 1: 9.8)
    )
    escalation_s: Seconds = 4.0  # R157 5.4.3.2
    minimal_risk_after_s: Seconds = 10.0  # R157 5.4.4.1
    refusal_shown_s: Seconds = 3.0

    # Safe stop and emergency stop.
    stop_decel_mps2: Acceleration = 2.5  # AW mrm_emergency_stop -2.5
    stop_jerk_mps3: Acceleration = 1.5  # AW mrm_emergency_stop -1.5
    stop_decel_max_mps2: Acceleration = 4.0  # R157 5.5: demand of at most 4.0
    # Where nobody steers the stop, it is short: decisions/0009 has the measurements behind these three.
    blind_stop_decel_mps2: Acceleration = 3.5  # with the integral at most 4.0, as above
    blind_stop_jerk_mps3: Acceleration = 5.0  # AW lon_jerk_lim
    stop_road_wheel_decay_radps: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] = 0.005  # angle held, slowly to 0
    stop_steering_apart_mps2: Acceleration = 2.0  # AW on_transition lat_acc_lim: a controller that steers as the person
    emergency_brake: Annotated[float, msgspec.Meta(ge=0.5, le=1.0)] = 1.0  # full service brake: 6 m/s2 class or more
    hold_brake: Annotated[float, msgspec.Meta(ge=0.1, le=1.0)] = 0.4  # holds a 24 % slope on a car of 6 m/s2 brakes
    standstill_speed_mps: Annotated[float, msgspec.Meta(gt=0.0, le=0.5)] = 0.1
    standstill_s: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)] = 0.3

    restart_wheel_deg: Annotated[float, msgspec.Meta(ge=1.0, le=90.0)] = 5.0  # off the centre, at most; as rearm_deg
    restart_wait_s: Seconds = 10.0  # for the wheel to be centred and the pedals to be released: chosen

    # Engaging autonomy. AW engage_acceptable_limits where named.
    engage_stable_s: Seconds = 0.1  # AW stable_check.duration
    reengage_stable_s: Seconds = 1.0  # after a fault: a second without one invalid command
    engage_speed_max_mps: Annotated[float, msgspec.Meta(gt=0.0, le=100.0)] = 25.0  # AW vel_lim
    engage_speed_deviation_mps: Annotated[float, msgspec.Meta(gt=0.0, le=100.0)] = 10.0  # AW speed_upper_threshold
    engage_lateral_accel_mps2: Acceleration = 1.0  # AW lateral_acc_threshold
    engage_road_wheel_deviation_rad: Annotated[float, msgspec.Meta(gt=0.0, le=2.0)] = 0.35
    engage_deviation_speed_mps: Annotated[float, msgspec.Meta(ge=0.0, le=20.0)] = 1.0  # slower: wheels may stand anyhow

    # Shared control: how much authority the remote side has over steering, and what it acts upon.
    shared_authority: Literal["fixed", "line_crossing", "traded"] = "fixed"
    shared_steering: Literal["blended", "haptic"] = "blended"  # haptic: by the wheel's motor alone, which it then needs
    shared_lateral: Fraction = 0.5  # fixed; line_crossing: while calm; traded: while nobody pushes against it
    shared_lateral_urgent: Fraction = 0.9  # line_crossing: when urgent
    shared_line_margin_m: Annotated[float, msgspec.Meta(gt=0.0, le=5.0)] = 0.75  # each side: 3.25 m lane, 1.75 m car
    shared_line_urgent_s: Annotated[float, msgspec.Meta(ge=0.1, le=5.0)] = 0.8  # to crossing; drivers correct at ~1 s
    shared_line_span_s: Annotated[float, msgspec.Meta(ge=0.1, le=10.0)] = 1.2  # above that: calm from 2 s
    shared_trade_nm: Annotated[float, msgspec.Meta(ge=0.2, le=10.0)] = (
        1.5  # pushing against it means it; JOAN: a threshold
    )
    shared_trade_s: Annotated[float, msgspec.Meta(ge=0.1, le=10.0)] = 1.0  # from full share to none
    shared_longitudinal: Fraction = 0.0

    # Speed and acceleration commands to pedals.
    accel_max_mps2: Acceleration = 2.0
    decel_max_mps2: Acceleration = 4.0
    speed_gain_per_s: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)] = 1.0
    integral_gain_per_s: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)] = 0.3
    integral_max_mps2: Annotated[float, msgspec.Meta(ge=0.0, le=3.0)] = 0.8
    coast_band_mps2: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] = 0.1  # between throttle and brake: both released
    nominal_throttle_accel_mps2: Acceleration = 3.0  # per full pedal, where the vehicle states no usable figure
    nominal_brake_accel_mps2: Acceleration = 8.0

    # The last gate. Manual limits are what a body can do, not comfort: nobody may notice them.
    manual_hand_wheel_rate_degps: Annotated[float, msgspec.Meta(ge=500.0, le=5000.0)] = 1500.0  # emergencies: ~1100
    manual_pedal_slew_per_s: Slew = 25.0  # a stroke in 40 ms
    automatic_road_wheel_max_rad: Annotated[float, msgspec.Meta(gt=0.0, le=1.5)] = 1.0  # AW steer_lim
    automatic_road_wheel_rate_radps: Annotated[float, msgspec.Meta(gt=0.0, le=5.0)] = 1.0  # AW steer_rate_lim
    automatic_lateral_accel_mps2: Acceleration = 5.0  # AW lat_acc_lim
    automatic_lateral_jerk_mps3: Annotated[float, msgspec.Meta(ge=0.0, le=100.0)] = 7.0  # AW lat_jerk_lim; 0: no limit
    automatic_throttle_slew_per_s: Slew = 4.0
    automatic_brake_slew_per_s: Slew = 6.0
    stop_road_wheel_rate_radps: Annotated[float, msgspec.Meta(gt=0.0, le=5.0)] = 0.5
    emergency_brake_slew_per_s: Annotated[float, msgspec.Meta(ge=5.0, le=1000.0)] = 1000.0  # full in the same tick
    reverse_speed_max_mps: Annotated[float, msgspec.Meta(gt=0.0, le=5.0)] = 2.0  # faster: no change of direction
    gear_max: Annotated[int, msgspec.Meta(ge=1, le=10)] = 7
    target_speed_max_mps: Annotated[float, msgspec.Meta(gt=0.0, le=100.0)] = 25.0  # AW vel_lim
    target_accel_mps2: Acceleration = 5.0  # AW lon_acc_lim
    target_position_max_m: Annotated[float, msgspec.Meta(gt=0.0, le=1e7)] = 1e5
