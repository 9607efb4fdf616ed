"""The inverse of calibration, for scripts and simulated people: from what a person does to raw axes. Pure.

Pedals come in as 0 to 1 and are not clamped: scripts are bounded by their profile, simulated feet by their control.
"""

from typing import Final, NamedTuple

from simconsole.devices.calibration.calibrator import curved
from simconsole.devices.calibration.cockpit_settings import (
    HAT_DOWN,
    HAT_LEFT,
    HAT_RIGHT,
    HAT_SHIFT,
    HAT_UP,
    SHIFTER_SHIFT,
    CockpitSettings,
)
from simconsole.values.signals import DeviceSample

WHEEL_MASK: Final = (1 << SHIFTER_SHIFT) - 1
GEAR_1_AT: Final = CockpitSettings._fields.index("gear_1_mask")
ROLES_AT: Final = CockpitSettings._fields.index("autonomous_mask")


class Intent(NamedTuple):
    """What a person does, in a person's terms: left-positive, pedals 0 to 1, lever -1, 0, 1..7, a `Button` mask."""

    hand_wheel_rad: float = 0.0
    throttle: float = 0.0
    brake: float = 0.0
    clutch: float = 0.0
    handbrake: float = 0.0
    gear: float = 0.0
    pressed: int = 0


def pedal_raw(pressed: float, rest_raw: float, full_raw: float, dead: float, curve: float) -> float:
    """Return the raw axis of a pedal pressed by this share; 0 is the rest position itself, not the dead zone's end."""
    share = curved(pressed, 1.0 / curve)
    return rest_raw if share == 0.0 else rest_raw + (dead + share * (1.0 - dead)) * (full_raw - rest_raw)


def wheel_raw(hand_wheel_rad: float, settings: CockpitSettings) -> float:
    """Return the raw axis of the hand wheel, stopped at the ends of the axis as the real one is."""
    offset = hand_wheel_rad / settings.wheel_rad_per_raw
    if abs(offset) < 1.0:
        offset = curved(abs(offset), 1.0 / settings.wheel_curve) * (1.0 if offset > 0.0 else -1.0)
    dead = settings.wheel_dead_raw if offset > 0.0 else -settings.wheel_dead_raw if offset < 0.0 else 0.0
    return min(1.0, max(-1.0, settings.wheel_centre_raw + offset + dead))


def button_masks(gear: float, pressed: int, settings: CockpitSettings) -> tuple[int, int, int]:
    """Return the raw masks (wheel, shifter, hat) of a lever in this gear and these roles held."""
    mask = 0
    if pressed:
        for bit, role in enumerate(settings[ROLES_AT:]):
            if pressed >> bit & 1:
                mask |= int(role)
    if gear and not settings.sequential:
        mask |= int(settings.gear_reverse_mask if gear < 0.0 else settings[GEAR_1_AT + int(gear) - 1])
    return mask & WHEEL_MASK, mask >> SHIFTER_SHIFT & WHEEL_MASK, mask >> HAT_SHIFT


def raw_sample(intent: Intent, settings: CockpitSettings) -> DeviceSample:
    """Return the raw sample, of age 0, from which `calibrate` reads `intent` back."""
    wheel_buttons, shifter_buttons, hat = button_masks(intent.gear, intent.pressed, settings)
    s = settings
    return DeviceSample(
        wheel_axis=wheel_raw(intent.hand_wheel_rad, s),
        throttle_axis=pedal_raw(
            intent.throttle, s.throttle_rest_raw, s.throttle_full_raw, s.throttle_dead, s.throttle_curve
        ),
        brake_axis=pedal_raw(intent.brake, s.brake_rest_raw, s.brake_full_raw, s.brake_dead, s.brake_curve),
        clutch_axis=pedal_raw(intent.clutch, s.clutch_rest_raw, s.clutch_full_raw, s.clutch_dead, s.clutch_curve),
        handbrake_axis=pedal_raw(
            intent.handbrake, s.handbrake_rest_raw, s.handbrake_full_raw, s.handbrake_dead, s.handbrake_curve
        ),
        wheel_buttons=float(wheel_buttons),
        shifter_buttons=float(shifter_buttons),
        hat_x=float((hat & HAT_RIGHT != 0) - (hat & HAT_LEFT != 0)),
        hat_y=float((hat & HAT_UP != 0) - (hat & HAT_DOWN != 0)),
        wheel_age_ticks=0.0,
        pedals_age_ticks=0.0,
        shifter_age_ticks=0.0,
        handbrake_age_ticks=0.0,
    )
