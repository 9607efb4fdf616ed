"""The arbitration's settings in SI and ticks, as floats for the kernels; the figures' sources: profiles/control.py."""

import math
from typing import Final, NamedTuple

from simconsole.profiles.control import ControlProfile
from simconsole.values.signals import Commander
from simconsole.values.units import RAD_PER_DEG

SHARED_RULES: Final = ("fixed", "line_crossing", "traded")


class ControlSettings(NamedTuple):
    """Settings of arbitration and gate, constant over a drive."""

    person_required: float
    manual_automatic: float
    wheelbase_m: float
    road_wheel_per_hand_wheel: float
    max_road_wheel_rad: float
    turns_in_place: float
    # Take-over by the person.
    steering_override_rad: float
    steering_release_rad: float
    steering_override_radps: float
    steering_override_nm: float
    steering_override_ticks: float
    device_back_ticks: float
    brake_override: float
    throttle_override: float
    throttle_release: float
    throttle_held_ticks: float
    clutch_pressed: float
    fade_per_tick: float
    # Choice of the remote side, faults of its command, and take-over requests.
    preferred_commander: float  # `Commander`
    lease_ticks: float
    stale_ticks: float
    invalid_commands_max: float
    implausible_lateral_accel_mps2: float  # a command that steers harder than this is implausible
    escalation_ticks: float
    minimal_risk_ticks: float
    refusal_ticks: float
    # Safe stop and emergency stop.
    stop_decel_mps2: float
    stop_jerk_mps3: float
    stop_decel_max_mps2: float
    blind_stop_decel_mps2: float
    blind_stop_jerk_mps3: float
    stop_steering_apart_mps2: float
    stop_road_wheel_decay_radps: float
    emergency_brake: float
    hold_brake: float
    standstill_speed_mps: float
    standstill_ticks: float
    restart_wheel_rad: float
    restart_wait_ticks: float
    # Engaging autonomy.
    engage_stable_ticks: float
    reengage_stable_ticks: float
    engage_speed_max_mps: float
    engage_speed_deviation_mps: float
    engage_lateral_accel_mps2: float
    engage_road_wheel_deviation_rad: float
    engage_deviation_speed_mps: float
    # Shared control.
    shared_rule: float  # 0 fixed, 1 by time to line crossing, 2 traded
    shared_haptic: float  # 1: the controller acts through the wheel's motor alone, 0: its angle is blended too
    shared_lateral: float
    shared_lateral_most: float
    shared_line_margin_m: float
    shared_line_calm_s: float
    shared_line_urgent_s: float
    shared_trade_nm: float
    shared_trade_per_tick: float
    shared_longitudinal: float
    # Speed and acceleration commands to pedals.
    accel_max_mps2: float
    decel_max_mps2: float
    speed_gain_per_s: float
    integral_gain_per_s: float
    integral_max_mps2: float
    coast_band_mps2: float
    nominal_throttle_accel_mps2: float
    nominal_brake_accel_mps2: float
    # The last gate.
    manual_road_wheel_radps: float
    manual_pedal_slew_per_s: float
    automatic_road_wheel_rad: float
    automatic_road_wheel_radps: float
    automatic_lateral_accel_mps2: float
    automatic_lateral_jerk_mps3: float
    automatic_throttle_slew_per_s: float
    automatic_brake_slew_per_s: float
    stop_road_wheel_radps: float
    emergency_brake_slew_per_s: float
    reverse_speed_max_mps: float
    gear_max: float
    target_speed_max_mps: float
    target_accel_mps2: float
    target_position_max_m: float


def settings(
    profile: ControlProfile,
    steering_ratio: float,
    max_road_wheel_rad: float,
    wheelbase_m: float,
    tick_hz: int,
    preferred: Commander = Commander.ROS,
    turns_in_place: bool = False,
) -> ControlSettings:
    """Return the settings of one drive.

    Args:
        profile: The settings in the units of the profile.
        steering_ratio: Hand-wheel angle per road-wheel angle of the vehicle (> 0).
        max_road_wheel_rad: The vehicle's steering lock.
        wheelbase_m: The vehicle's (> 0), between curvature and road-wheel angle.
        tick_hz: Control ticks per second.
        preferred: Which controller is the remote side where both could be.
        turns_in_place: Whether the vehicle follows a twist as it is, instead of being steered.
    """
    lock_rad = max_road_wheel_rad
    release_deg = max(0.0, profile.steering_override_deg - profile.steering_override_hysteresis_deg)
    return ControlSettings(
        **_of_the_same_name(profile),
        wheelbase_m=wheelbase_m,
        road_wheel_per_hand_wheel=1.0 / steering_ratio,
        max_road_wheel_rad=lock_rad,
        turns_in_place=float(turns_in_place),
        steering_override_rad=profile.steering_override_deg * RAD_PER_DEG,
        steering_release_rad=release_deg * RAD_PER_DEG,
        steering_override_radps=profile.steering_override_rate_degps * RAD_PER_DEG,
        steering_override_ticks=_at_least(profile.steering_override_hold_s, tick_hz),
        device_back_ticks=_at_least(profile.device_back_s, tick_hz),
        throttle_release=max(0.0, profile.throttle_override - profile.throttle_override_hysteresis),
        throttle_held_ticks=_at_least(profile.throttle_held_s, tick_hz),
        fade_per_tick=1.0 / _at_least(profile.fade_s, tick_hz),
        preferred_commander=float(preferred),
        lease_ticks=_at_most(profile.commander_lease_s, tick_hz),
        stale_ticks=_at_most(profile.command_stale_s, tick_hz),
        implausible_lateral_accel_mps2=(profile.implausible_lateral_accel_ratio * profile.automatic_lateral_accel_mps2),
        escalation_ticks=_at_least(profile.escalation_s, tick_hz),
        minimal_risk_ticks=_at_least(profile.minimal_risk_after_s, tick_hz),
        refusal_ticks=_at_least(profile.refusal_shown_s, tick_hz),
        restart_wheel_rad=profile.restart_wheel_deg * RAD_PER_DEG,
        restart_wait_ticks=_at_least(profile.restart_wait_s, tick_hz),
        standstill_ticks=_at_least(profile.standstill_s, tick_hz),
        engage_stable_ticks=_at_least(profile.engage_stable_s, tick_hz),
        reengage_stable_ticks=_at_least(profile.reengage_stable_s, tick_hz),
        shared_rule=float(SHARED_RULES.index(profile.shared_authority)),
        shared_haptic=float(profile.shared_steering == "haptic"),
        shared_lateral_most=max(profile.shared_lateral, profile.shared_lateral_urgent),
        shared_line_calm_s=profile.shared_line_urgent_s + profile.shared_line_span_s,
        shared_trade_per_tick=2.0 / _at_least(profile.shared_trade_s, tick_hz),
        manual_road_wheel_radps=profile.manual_hand_wheel_rate_degps * RAD_PER_DEG / steering_ratio,
        automatic_road_wheel_rad=min(profile.automatic_road_wheel_max_rad, lock_rad),
        automatic_road_wheel_radps=profile.automatic_road_wheel_rate_radps,
        stop_road_wheel_radps=profile.stop_road_wheel_rate_radps,
    )


def _of_the_same_name(profile: ControlProfile) -> dict[str, float]:
    """Return the settings that the profile has in the same unit: names carry units, so equal names mean equal units."""
    return {name: float(getattr(profile, name)) for name in ControlSettings._fields if hasattr(profile, name)}


def _at_least(seconds: float, tick_hz: int) -> float:
    """Return the whole ticks that last at least `seconds`, and at least one: for a condition that must last."""
    return max(1.0, float(math.ceil(seconds * tick_hz - 1e-9)))


def _at_most(seconds: float, tick_hz: int) -> float:
    """Return the whole ticks that last at most `seconds`, and at least one: for time-outs."""
    return max(1.0, float(math.floor(seconds * tick_hz + 1e-9)))
