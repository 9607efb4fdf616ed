"""A cockpit profile as plain numbers for the kernels, and the values before anything was read. Pure."""

import math
from typing import Final, NamedTuple

from simconsole.profiles.device import ButtonBinding, Buttons, CockpitProfile
from simconsole.profiles.parts.axes import PedalAxis
from simconsole.values.signals import DriverInput
from simconsole.values.units import RAD_PER_DEG

SHIFTER_SHIFT: Final = 24
"""In a role's mask the shifter's buttons lie above the wheel's: `wheel | shifter << 24`."""
HAT_SHIFT: Final = 48
"""Above both lie the four directions of the wheel's hat: left 1, right 2, up 4, down 8."""
HAT_LEFT: Final = 1
HAT_RIGHT: Final = 2
HAT_UP: Final = 4
HAT_DOWN: Final = 8
GEARS: Final = 7
HATS: Final = {"left": HAT_LEFT, "right": HAT_RIGHT, "up": HAT_UP, "down": HAT_DOWN}


class CockpitSettings(NamedTuple):
    """A device profile as plain numbers. Masks: `wheel | shifter << 24 | hat << 48`."""

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
    horn_mask: float


NOBODY: Final = DriverInput(*(0.0,) * len(DriverInput._fields))
"""The person before the first tick: nothing seen (`Validity.UNKNOWN` is 0), nothing pressed."""


def cockpit_settings(profile: CockpitProfile, tick_hz: int) -> CockpitSettings:
    """Return the profile as plain numbers; limits in time become whole ticks, never longer than stated."""
    pedals, shifter, wheel = profile.pedals, profile.shifter, profile.wheel
    sign = -1.0 if wheel.grows_to == "right" else 1.0
    bits = {on: button_bits(profile, on) for on in ("wheel", "shifter")}
    gears = [_mask(shifter.on, bits[shifter.on][button]) for button in shifter.gears]
    gears += [0.0] * (GEARS - len(gears))
    sequential = shifter.pattern == "sequential"
    return CockpitSettings(
        wheel_centre_raw=wheel.centre_raw,
        wheel_dead_raw=wheel.dead_zone,
        wheel_curve=wheel.curve,
        wheel_rad_per_raw=sign * 0.5 * wheel.lock_to_lock_deg * RAD_PER_DEG,
        wheel_rate_filter_s=wheel.rate_filter_s,
        wheel_rearm_rad=profile.limits.rearm_deg * RAD_PER_DEG,
        **_travel("throttle", pedals.throttle),
        **_travel("brake", pedals.brake),
        **_travel("clutch", pedals.clutch),
        **_travel("handbrake", pedals.handbrake),
        arming_limit=profile.limits.arming,
        stale_ticks=math.floor(profile.limits.stale_s * tick_hz + 1e-9) * 1.0,
        neutral_dwell_ticks=round(shifter.neutral_dwell_s * tick_hz) * 1.0,
        sequential=1.0 if sequential else 0.0,
        top_gear=float(shifter.top_gear if sequential else len(shifter.gears)),
        gear_reverse_mask=0.0 if shifter.reverse is None else _mask(shifter.on, bits[shifter.on][shifter.reverse]),
        **{f"gear_{gear}_mask": mask for gear, mask in enumerate(gears, start=1)},
        **{f"{role}_mask": _role_mask(getattr(profile.buttons, role), bits) for role in Buttons.__struct_fields__},
    )


def button_bits(profile: CockpitProfile, on: str) -> dict[int, int]:
    """Return which bit of a device's mask in a sample holds which of its buttons, by the button's number.

    A mask has SHIFTER_SHIFT bits. Button n is bit n; one beyond takes the bit of the last button without a meaning.
    There always is one: a profile gives meaning to 24 buttons of a device at most.

    Args:
        profile: The cockpit.
        on: The role, wheel or shifter.
    """
    buttons = (getattr(profile.buttons, name) for name in Buttons.__struct_fields__)
    used = {bound.button for bound in buttons if bound is not None and bound.on == on and bound.button is not None}
    if profile.shifter.on == on:
        used |= {button for button in (*profile.shifter.gears, profile.shifter.reverse) if button is not None}
    bits = {button: button for button in range(SHIFTER_SHIFT)}
    unused = [button for button in bits if button not in used]
    for button in sorted(used - set(bits)):
        bits[button] = bits.pop(unused.pop())
    return bits


def _travel(name: str, pedal: PedalAxis | None) -> dict[str, float]:
    """Return the settings of one pedal; one that the cockpit has not reads 0."""
    if pedal is None:
        return {f"{name}_rest_raw": 0.0, f"{name}_full_raw": 0.0, f"{name}_dead": 0.0, f"{name}_curve": 1.0}
    return {
        f"{name}_rest_raw": pedal.rest_raw,
        f"{name}_full_raw": pedal.full_raw,
        f"{name}_dead": pedal.dead_zone,
        f"{name}_curve": pedal.curve,
    }


def _role_mask(binding: ButtonBinding | None, bits: dict[str, dict[int, int]]) -> float:
    if binding is None:
        return 0.0
    if binding.button is not None:
        return _mask(binding.on, bits[binding.on][binding.button])
    return float(HATS[str(binding.hat)] << HAT_SHIFT)


def _mask(on: str, bit: int) -> float:
    return float(1 << (bit + (SHIFTER_SHIFT if on == "shifter" else 0)))
