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
    """Autonomy needs a person in the seat. `false`: it starts from PARKED with nobody there, as the ball does."""
    manual_automatic: bool = False  # True: cockpits without clutch and shifter (keyboard)
    """The car works clutch and gears also when a person drives, for cockpits without clutch and shifter (keyboard)."""

    # Take-over by the person.
    steering_override_deg: Annotated[float, msgspec.Meta(ge=1.0, le=90.0)] = 8.0  # moved since engagement; to be tuned
    """The person takes over when they have turned the hand wheel this far from where it was when autonomy began."""
    steering_override_hysteresis_deg: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)] = 1.0  # a shaking hand counts on
    """The hand wheel counts as turned until it is this much below `steering_override_deg`, so that a shaking hand
    counts on."""
    steering_override_rate_degps: Annotated[float, msgspec.Meta(ge=10.0, le=2000.0)] = 60.0  # a hand that means it
    """Turning the hand wheel at least this fast is a take-over too, however small the angle."""
    steering_override_nm: Annotated[float, msgspec.Meta(ge=0.3, le=20.0)] = 1.4  # more than hands that rest on the rim
    """Torque of the hands on the rim that is a take-over where the wheel has a motor; more than that of hands that only
    rest on it."""
    steering_override_hold_s: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] = 0.05  # OD: 5 frames of 10 ms
    """How long a turned wheel or a torque must last to be a take-over."""
    brake_override: Threshold = 0.05  # R157 6.3.1; OD: any brake
    """Share of the brake pedal from which pressing it is a take-over, 0 to 1."""
    throttle_override: Threshold = 0.05  # longitudinal only, while held: OD "overriding"
    """Share of the throttle pedal from which the person overrides the speed, only while it is held, 0 to 1."""
    throttle_override_hysteresis: Annotated[float, msgspec.Meta(ge=0.0, le=0.05)] = 0.01
    """The throttle counts as released when it is this share below `throttle_override`."""
    throttle_held_s: Seconds = 5.0  # longer than this the person is told that the accelerator overrides: chosen
    """A throttle held for longer than this makes the display say that the accelerator overrides."""
    clutch_pressed: Annotated[float, msgspec.Meta(ge=0.1, le=1.0)] = (
        0.8  # after autonomy, the person's clutch takes the gears back
    )
    """Share of the clutch pedal from which it counts as pressed: after autonomy the person takes the gears back with
    it."""
    device_back_s: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)] = (
        0.5  # lost wheel and pedals take a stopping car over by hand so long after they are back: plugs bounce; chosen
    )
    """Lost wheel and pedals must be back for this long before a person can take over a stopping car: plugs bounce."""
    fade_s: Annotated[float, msgspec.Meta(ge=0.02, le=5.0)] = 0.6  # hand-over of authority
    """How long a hand-over lasts in which the authority goes from one side to the other."""

    # Faults of the command and take-over requests.
    command_stale_s: Annotated[float, msgspec.Meta(ge=0.02, le=2.0)] = 0.2  # AW and ros2_control: 0.5 s
    """A command older than this counts as lost, and the car reacts as to a fault."""
    commander_lease_s: Annotated[float, msgspec.Meta(ge=0.1, le=60.0)] = 0.5  # as the lease among clients of the bridge
    """A controller that commands keeps its place for this long after its last command, before another one can have
    it."""
    invalid_commands_max: Annotated[int, msgspec.Meta(ge=1, le=100)] = 5  # OD: 5 wrong counters
    """After this many invalid commands in a row the controller counts as faulty."""
    implausible_lateral_accel_ratio: Annotated[float, msgspec.Meta(ge=1.0, le=10.0)] = (
        2.0  # of automatic_lateral_accel_mps2: 10 m/s2, more than a road tyre gives (friction 1: 9.8)
    )
    """A command that would corner this many times harder than `automatic_lateral_accel_mps2` is implausible and
    invalid."""
    escalation_s: Seconds = 4.0  # R157 5.4.3.2
    """After this long without an answer a request to take over is shown and heard more urgently."""
    minimal_risk_after_s: Seconds = 10.0  # R157 5.4.4.1
    """After this long without an answer to a request to take over the car begins to stop by itself."""
    refusal_shown_s: Seconds = 3.0
    """How long the display says why a request was refused."""

    # Safe stop and emergency stop.
    stop_decel_mps2: Acceleration = 2.5  # AW mrm_emergency_stop -2.5
    """How hard the car brakes when it stops by itself."""
    stop_jerk_mps3: Acceleration = 1.5  # AW mrm_emergency_stop -1.5
    """How fast the braking of a stop by itself builds up."""
    stop_decel_max_mps2: Acceleration = 4.0  # R157 5.5: demand of at most 4.0
    """Hardest braking that a stop by itself may ask for, whatever its controller of speed adds."""
    # Where nobody steers the stop, it is short: decisions/0009 has the measurements behind these three.
    blind_stop_decel_mps2: Acceleration = 3.5  # with the integral at most 4.0, as above
    """How hard the car brakes when it stops by itself and nobody steers, so that the stop is short."""
    blind_stop_jerk_mps3: Acceleration = 5.0  # AW lon_jerk_lim
    """How fast the braking builds up when nobody steers the stop."""
    stop_road_wheel_decay_radps: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] = 0.005  # angle held, slowly to 0
    """How fast the road-wheel angle that is held in a stop goes back to straight ahead; 0 holds it."""
    stop_steering_apart_mps2: Acceleration = 2.0  # AW on_transition lat_acc_lim: a controller that steers as the person
    """When the car begins to stop by itself while a person drove, the controller steers the stop if its steering would
    corner no further than this from the person's."""
    emergency_brake: Annotated[float, msgspec.Meta(ge=0.5, le=1.0)] = 1.0  # full service brake: 6 m/s2 class or more
    """Share of the full service brake in an emergency stop, 0 to 1."""
    hold_brake: Annotated[float, msgspec.Meta(ge=0.1, le=1.0)] = 0.4  # holds a 24 % slope on a car of 6 m/s2 brakes
    """Share of the brake that holds a stopped car, 0 to 1; 0.4 holds it on a slope of 24 %."""
    standstill_speed_mps: Annotated[float, msgspec.Meta(gt=0.0, le=0.5)] = 0.1
    """Below this speed the car may count as standing."""
    standstill_s: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)] = 0.3
    """The car counts as standing when it has been slower than `standstill_speed_mps` for this long."""

    restart_wheel_deg: Annotated[float, msgspec.Meta(ge=1.0, le=90.0)] = 5.0  # off the centre, at most; as rearm_deg
    """A drive begins anew only with the hand wheel at most this far from its centre, to either side."""
    restart_wait_s: Seconds = 10.0  # for the wheel to be centred and the pedals to be released: chosen
    """How long a restart waits for the wheel to be centred and the pedals to be released before it is refused."""

    # Engaging autonomy. AW engage_acceptable_limits where named.
    engage_stable_s: Seconds = 0.1  # AW stable_check.duration
    """The controller's commands must have been good for this long before autonomy can be engaged."""
    reengage_stable_s: Seconds = 1.0  # after a fault: a second without one invalid command
    """After a fault the commands must have been good for this long before autonomy can be engaged again."""
    engage_speed_max_mps: Annotated[float, msgspec.Meta(gt=0.0, le=100.0)] = 25.0  # AW vel_lim
    """Autonomy cannot be engaged above this speed."""
    engage_speed_deviation_mps: Annotated[float, msgspec.Meta(gt=0.0, le=100.0)] = 10.0  # AW speed_upper_threshold
    """Autonomy cannot be engaged while the commanded speed differs from the car's by more than this."""
    engage_lateral_accel_mps2: Acceleration = 1.0  # AW lateral_acc_threshold
    """Autonomy cannot be engaged while the car corners harder than this."""
    engage_road_wheel_deviation_rad: Annotated[float, msgspec.Meta(gt=0.0, le=2.0)] = 0.35
    """Autonomy cannot be engaged while the commanded road-wheel angle differs from the car's by more than this."""
    engage_deviation_speed_mps: Annotated[float, msgspec.Meta(ge=0.0, le=20.0)] = 1.0  # slower: wheels may stand anyhow
    """Below this speed the road-wheel angle is not compared when autonomy is engaged: wheels may stand anyhow."""

    # Shared control: how much authority the remote side has over steering, and what it acts upon.
    shared_authority: Literal["fixed", "line_crossing", "traded"] = "fixed"
    """How the remote side's share of the steering comes about: `fixed`, by the time to the `line_crossing`, or `traded`
    with the person's push."""
    shared_steering: Literal["blended", "haptic"] = "blended"  # haptic: by the wheel's motor alone, which it then needs
    """What the remote side acts on in shared control: `blended` mixes its angle into the road wheels, `haptic` acts by
    the wheel's motor alone, which it then needs."""
    shared_lateral: Fraction = 0.5  # fixed; line_crossing: while calm; traded: while nobody pushes against it
    """Remote side's share of the steering, 0 to 1: always when `fixed`, while calm by `line_crossing`, while nobody
    pushes against it when `traded`."""
    shared_lateral_urgent: Fraction = 0.9  # line_crossing: when urgent
    """Remote side's share of the steering when a line is about to be crossed; only for `line_crossing`."""
    shared_line_margin_m: Annotated[float, msgspec.Meta(gt=0.0, le=5.0)] = 0.75  # each side: 3.25 m lane, 1.75 m car
    """How far the car may go to each side before a line counts as crossed; 0.75 is a car of 1.75 m in a lane of 3.25
    m."""
    shared_line_urgent_s: Annotated[float, msgspec.Meta(ge=0.1, le=5.0)] = 0.8  # to crossing; drivers correct at ~1 s
    """Time to line crossing at which the share of the steering is `shared_lateral_urgent`."""
    shared_line_span_s: Annotated[float, msgspec.Meta(ge=0.1, le=10.0)] = 1.2  # above that: calm from 2 s
    """By how much the time to line crossing must be longer than `shared_line_urgent_s` for the share to be calm."""
    shared_trade_nm: Annotated[float, msgspec.Meta(ge=0.2, le=10.0)] = (
        1.5  # pushing against it means it; JOAN: a threshold
    )
    """Torque of the person against the remote side that takes its share away; only for `traded`."""
    shared_trade_s: Annotated[float, msgspec.Meta(ge=0.1, le=10.0)] = 1.0  # from full share to none
    """How long the share takes from full to none when it is `traded`."""
    shared_longitudinal: Fraction = 0.0
    """Remote side's share of throttle and brake in shared control, 0 to 1."""

    # Speed and acceleration commands to pedals.
    accel_max_mps2: Acceleration = 2.0
    """Strongest acceleration with which a commanded speed is reached."""
    decel_max_mps2: Acceleration = 4.0
    """Strongest braking with which a commanded speed is reached."""
    speed_gain_per_s: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)] = 1.0
    """Acceleration that is asked for per difference between commanded and driven speed."""
    integral_gain_per_s: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)] = 0.3
    """How fast a lasting difference of acceleration is made up for by pedals; 0 never."""
    integral_max_mps2: Annotated[float, msgspec.Meta(ge=0.0, le=3.0)] = 0.8
    """Most that a lasting difference may add to the acceleration that is asked for."""
    coast_band_mps2: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] = 0.1  # between throttle and brake: both released
    """An acceleration this close to that of the rolling car releases both pedals."""
    nominal_throttle_accel_mps2: Acceleration = 3.0  # per full pedal, where the vehicle states no usable figure
    """Acceleration of a full throttle pedal, used where the vehicle states no usable figure."""
    nominal_brake_accel_mps2: Acceleration = 8.0
    """Braking of a full brake pedal, used where the vehicle states no usable figure."""

    # The last gate. Manual limits are what a body can do, not comfort: nobody may notice them.
    manual_hand_wheel_rate_degps: Annotated[float, msgspec.Meta(ge=500.0, le=5000.0)] = 1500.0  # emergencies: ~1100
    """Fastest hand wheel that the last gate passes from a person; more than a body can do, so that nobody notices
    it."""
    manual_pedal_slew_per_s: Slew = 25.0  # a stroke in 40 ms
    """Fastest pedal that the last gate passes from a person, in strokes per second; 25 is a stroke in 40 ms."""
    automatic_road_wheel_max_rad: Annotated[float, msgspec.Meta(gt=0.0, le=1.5)] = 1.0  # AW steer_lim
    """Largest road-wheel angle to either side that the last gate passes from a controller."""
    automatic_road_wheel_rate_radps: Annotated[float, msgspec.Meta(gt=0.0, le=5.0)] = 1.0  # AW steer_rate_lim
    """Fastest turning of the road wheels that the last gate passes from a controller."""
    automatic_lateral_accel_mps2: Acceleration = 5.0  # AW lat_acc_lim
    """Hardest cornering that the last gate passes from a controller: at speed it makes the angle smaller."""
    automatic_lateral_jerk_mps3: Annotated[float, msgspec.Meta(ge=0.0, le=100.0)] = 7.0  # AW lat_jerk_lim; 0: no limit
    """Fastest change of the cornering that the last gate passes from a controller; 0 sets no limit."""
    automatic_throttle_slew_per_s: Slew = 4.0
    """Fastest throttle that the last gate passes from a controller, in strokes per second."""
    automatic_brake_slew_per_s: Slew = 6.0
    """Fastest brake that the last gate passes from a controller, in strokes per second."""
    stop_road_wheel_rate_radps: Annotated[float, msgspec.Meta(gt=0.0, le=5.0)] = 0.5
    """Fastest turning of the road wheels while the car stops by itself."""
    emergency_brake_slew_per_s: Annotated[float, msgspec.Meta(ge=5.0, le=1000.0)] = 1000.0  # full in the same tick
    """Fastest build-up of the brake in an emergency stop, in strokes per second; 1000 is full in the same tick."""
    reverse_speed_max_mps: Annotated[float, msgspec.Meta(gt=0.0, le=5.0)] = 2.0  # faster: no change of direction
    """Above this speed the last gate passes no change between forwards and reverse."""
    gear_max: Annotated[int, msgspec.Meta(ge=1, le=10)] = 7
    """Highest gear that the last gate passes where the person shifts."""
    target_speed_max_mps: Annotated[float, msgspec.Meta(gt=0.0, le=100.0)] = 25.0  # AW vel_lim
    """Highest speed that the last gate passes as a target, for vehicles that follow speeds."""
    target_accel_mps2: Acceleration = 5.0  # AW lon_acc_lim
    """Strongest acceleration that the last gate passes as a target, for vehicles that follow speeds."""
    target_position_max_m: Annotated[float, msgspec.Meta(gt=0.0, le=1e7)] = 1e5
    """Farthest target position from the origin of the map, along x and y, that the last gate passes."""
