"""From a cockpit profile to the numbers the kernels work with. Pure."""

import math
from typing import Final

from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.calibration.lever import HAT_DOWN, HAT_LEFT, HAT_RIGHT, HAT_SHIFT, HAT_UP, SHIFTER_SHIFT
from simconsole.profiles.device import ButtonBinding, Buttons, CockpitProfile, PedalAxis
from simconsole.values.units import RAD_PER_DEG

GEARS: Final = 7
HATS: Final = {"left": HAT_LEFT, "right": HAT_RIGHT, "up": HAT_UP, "down": HAT_DOWN}


def settings(profile: CockpitProfile, tick_hz: int) -> CockpitSettings:
    """Return the profile as plain numbers; limits in time become whole ticks, never longer than stated."""
    pedals, shifter, wheel = profile.pedals, profile.shifter, profile.wheel
    sign = -1.0 if wheel.grows_to == "right" else 1.0
    gears = [_mask(shifter.on, button) for button in shifter.gears]
    gears += [0.0] * (GEARS - len(gears))
    sequential = shifter.pattern == "sequential"
    return CockpitSettings(
        wheel.centre_raw,
        wheel.dead_zone,
        wheel.curve,
        sign * 0.5 * wheel.lock_to_lock_deg * RAD_PER_DEG,
        wheel.rate_filter_s,
        profile.limits.rearm_deg * RAD_PER_DEG,
        *_ends(pedals.throttle),
        *_ends(pedals.brake),
        *_ends(pedals.clutch),
        *_ends(pedals.handbrake),
        profile.limits.arming,
        math.floor(profile.limits.stale_s * tick_hz + 1e-9) * 1.0,
        round(shifter.neutral_dwell_s * tick_hz) * 1.0,
        1.0 if sequential else 0.0,
        float(shifter.top_gear if sequential else len(shifter.gears)),
        0.0 if shifter.reverse is None else _mask(shifter.on, shifter.reverse),
        *gears,
        *(_role_mask(getattr(profile.buttons, name)) for name in Buttons.__struct_fields__),
    )


def _ends(pedal: PedalAxis | None) -> tuple[float, float, float, float]:
    return (0.0, 0.0, 0.0, 1.0) if pedal is None else (pedal.rest_raw, pedal.full_raw, pedal.dead_zone, pedal.curve)


def _role_mask(binding: ButtonBinding | None) -> float:
    if binding is None:
        return 0.0
    if binding.button is not None:
        return _mask(binding.on, binding.button)
    return float(HATS[str(binding.hat)] << HAT_SHIFT)


def _mask(on: str, button: int) -> float:
    return float(1 << (button + (SHIFTER_SHIFT if on == "shifter" else 0)))
