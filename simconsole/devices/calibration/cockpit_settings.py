"""A device profile as plain numbers for the kernels, and the values before anything was read."""

from typing import Final, NamedTuple

from simconsole.values.signals import DriverInput


class CockpitSettings(NamedTuple):
    """A device profile as plain numbers; `settings.py` makes it. Masks: `wheel | shifter << 24 | hat << 48`."""

    wheel_centre_raw: float
    wheel_dead_raw: float
    wheel_curve: float  # 1: straight (calibration.curved)
    wheel_rad_per_raw: float  # negative where the axis grows to the right
    wheel_rate_filter_s: float
    wheel_rearm_rad: float  # how far from the car's own steering a wheel that was lost may come back
    throttle_rest_raw: float
    throttle_full_raw: float
    throttle_dead: float  # share of the travel that still reads 0
    throttle_curve: float
    brake_rest_raw: float
    brake_full_raw: float
    brake_dead: float
    brake_curve: float
    clutch_rest_raw: float
    clutch_full_raw: float
    clutch_dead: float
    clutch_curve: float
    handbrake_rest_raw: float  # rest = full: the cockpit has no such axis, it reads 0
    handbrake_full_raw: float
    handbrake_dead: float
    handbrake_curve: float
    arming_limit: float  # share of the travel below which a pedal counts as at rest
    stale_ticks: float
    neutral_dwell_ticks: float
    sequential: float  # 1: SHIFT_UP and SHIFT_DOWN step the gear; 0: H pattern
    top_gear: float
    gear_reverse_mask: float
    gear_1_mask: float
    gear_2_mask: float
    gear_3_mask: float
    gear_4_mask: float
    gear_5_mask: float
    gear_6_mask: float
    gear_7_mask: float
    autonomous_mask: float
    manual_mask: float
    emergency_stop_mask: float
    reset_mask: float
    shift_up_mask: float
    shift_down_mask: float
    indicator_left_mask: float
    indicator_right_mask: float
    mark_mask: float
    pause_mask: float
    restart_mask: float
    takeover_mask: float
    shared_mask: float
    fault_mask: float
    hazard_mask: float
    handbrake_button_mask: float


NOBODY: Final = DriverInput(*(0.0,) * len(DriverInput._fields))
"""The person before the first tick: nothing seen (`Validity.UNKNOWN` is 0), nothing pressed."""
