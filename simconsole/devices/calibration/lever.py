"""Buttons and the gear lever: which roles and which gear raw button masks mean. Pure kernels."""

from typing import Final

from simconsole.devices.calibration.cockpit_settings import (
    HAT_DOWN,
    HAT_LEFT,
    HAT_RIGHT,
    HAT_SHIFT,
    HAT_UP,
    SHIFTER_SHIFT,
    CockpitSettings,
)
from simconsole.values.kernels import kernel
from simconsole.values.signals import Button

SHIFT_UP: Final = int(Button.SHIFT_UP)
SHIFT_DOWN: Final = int(Button.SHIFT_DOWN)
HANDBRAKE: Final = int(Button.HANDBRAKE_BUTTON)
TWO_GEARS: Final = 99.0
"""What `shown_gear` answers when the lever shows two gears at once: a fault, the last gear is kept."""


@kernel
def hat_mask(hat_x: float, hat_y: float) -> int:
    """Return the directions in which a hat is held, right and up positive; a value that is not finite is none."""
    held = 0
    if hat_x < 0.0:
        held |= HAT_LEFT
    if hat_x > 0.0:
        held |= HAT_RIGHT
    if hat_y > 0.0:
        held |= HAT_UP
    if hat_y < 0.0:
        held |= HAT_DOWN
    return held


@kernel
def held_roles(wheel_buttons: float, shifter_buttons: float, hat: int, settings: CockpitSettings) -> int:
    """Return the `Button` mask that good raw masks mean."""
    held = int(wheel_buttons) | (int(shifter_buttons) << SHIFTER_SHIFT) | (hat << HAT_SHIFT)
    roles = 0
    bit = 1
    for mask in (
        settings.autonomous_mask,
        settings.manual_mask,
        settings.emergency_stop_mask,
        settings.reset_mask,
        settings.shift_up_mask,
        settings.shift_down_mask,
        settings.indicator_left_mask,
        settings.indicator_right_mask,
        settings.mark_mask,
        settings.pause_mask,
        settings.restart_mask,
        settings.takeover_mask,
        settings.shared_mask,
        settings.fault_mask,
        settings.hazard_mask,
        settings.handbrake_button_mask,
        settings.horn_mask,
    ):
        if held & int(mask) != 0:
            roles |= bit
        bit <<= 1
    return roles


@kernel
def shown_gear(wheel_buttons: float, shifter_buttons: float, settings: CockpitSettings) -> float:
    """Return the gear the H pattern shows: -1, 1..7, 0 for none, 99 when two gears show at once."""
    held = int(wheel_buttons) | (int(shifter_buttons) << SHIFTER_SHIFT)
    found = 0.0
    gear = -1.0
    for mask in (
        settings.gear_reverse_mask,
        settings.gear_1_mask,
        settings.gear_2_mask,
        settings.gear_3_mask,
        settings.gear_4_mask,
        settings.gear_5_mask,
        settings.gear_6_mask,
        settings.gear_7_mask,
    ):
        if held & int(mask) != 0:
            found = gear if found == 0.0 else TWO_GEARS
        gear = 1.0 if gear < 0.0 else gear + 1.0
    return found


@kernel
def stepped_gear(gear: float, edges: int, top_gear: float) -> float:
    """Return the gear after the sequential lever's edges, from reverse (-1) over neutral to `top_gear`."""
    if edges & SHIFT_UP != 0 and gear < top_gear:
        gear = gear + 1.0
    if edges & SHIFT_DOWN != 0 and gear > -1.0:
        gear = gear - 1.0
    return gear


@kernel
def lever_gear(previous: float, shown: float, neutral_ticks: float, dwell_ticks: float) -> float:
    """Return the gear an H pattern asks for: neutral only after its dwell, two gears at once keep the last."""
    if shown == TWO_GEARS:
        return previous
    if shown == 0.0 and neutral_ticks < dwell_ticks:
        return previous
    return shown
