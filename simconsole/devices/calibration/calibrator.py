"""From raw axes to the driver's input: polarity, dead zones, arming, validity, the lever. Pure kernels.

Order of each reading: finite and in range (else refused, the last good one is held), fresh (else stale or lost),
seen at rest (else unknown), and only then scaled.
"""

from typing import NamedTuple

from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.calibration.lever import (
    HANDBRAKE,
    TWO_GEARS,
    hat_mask,
    held_roles,
    lever_gear,
    shown_gear,
    stepped_gear,
)
from simconsole.devices.calibration.validity import axis_good, heard, mask_good, next_validity
from simconsole.values.kernels import clip, is_finite, kernel
from simconsole.values.signals import DeviceSample, DriverInput
from simconsole.values.validity import LOST, is_trusted


class Axis(NamedTuple):
    """How one pedal's axis is read: raw ends of its travel, the share of it that still reads 0, and its curve."""

    rest_raw: float
    full_raw: float
    dead: float
    curve: float


class Pedal(NamedTuple):
    """One pedal after this tick."""

    pressed: float
    validity: float


class Pedals(NamedTuple):
    """All of them; the hand brake is read like a pedal."""

    throttle: Pedal
    brake: Pedal
    clutch: Pedal
    handbrake: Pedal


class Wheel(NamedTuple):
    """The hand wheel after this tick."""

    rad: float
    radps: float
    validity: float


class Lever(NamedTuple):
    """The gear lever after this tick."""

    gear: float
    validity: float
    neutral_ticks: float
    fault: float  # 1: it shows two gears at once


@kernel
def travel(raw: float, rest_raw: float, full_raw: float) -> float:
    """Return the share of a pedal's travel, unclipped: 0 at rest, 1 fully pressed, either polarity."""
    span = full_raw - rest_raw
    if span == 0.0:
        return 0.0
    return (raw - rest_raw) / span


@kernel
def curved(share: float, curve: float) -> float:
    """Return a share of travel, 0 to 1, through a curve c: s / (s + c (1 - s)).

    Monotone from 0 to 1 for every c > 0, with slope 1 / c at 0 and c at 1; the curve 1 / c is its inverse.
    """
    if curve == 1.0:
        return share
    return share / (share + curve * (1.0 - share))


@kernel
def pressed_share(raw: float, rest_raw: float, full_raw: float, dead: float, curve: float) -> float:
    """Return a pedal from 0 to 1, continuous at the end of its dead zone (dead < 1, curve > 0)."""
    return curved(clip((travel(raw, rest_raw, full_raw) - dead) / (1.0 - dead), 0.0, 1.0), curve)


@kernel
def pedal(
    raw: float,
    age_ticks: float,
    refused_ticks: float,
    before: Pedal,
    axis: Axis,
    settings: CockpitSettings,
) -> Pedal:
    """Return one pedal: 0 while it is not trusted, the last good value while a bad reading is held."""
    good = axis_good(raw)
    at_rest = good and travel(raw, axis.rest_raw, axis.full_raw) <= settings.arming_limit
    validity = next_validity(before.validity, age_ticks, 0.0 if good else refused_ticks, settings.stale_ticks, at_rest)
    if not is_trusted(validity):
        return Pedal(0.0, validity)
    if not good:
        return Pedal(before.pressed, validity)
    return Pedal(pressed_share(raw, axis.rest_raw, axis.full_raw, axis.dead, axis.curve), validity)


@kernel
def pedals(sample: DeviceSample, refused_ticks: float, before: DriverInput, settings: CockpitSettings) -> Pedals:
    """Return the three pedals and the hand brake, which may be a device of its own."""
    s = settings
    age_ticks = sample.pedals_age_ticks
    throttle_axis = Axis(s.throttle_rest_raw, s.throttle_full_raw, s.throttle_dead, s.throttle_curve)
    brake_axis = Axis(s.brake_rest_raw, s.brake_full_raw, s.brake_dead, s.brake_curve)
    clutch_axis = Axis(s.clutch_rest_raw, s.clutch_full_raw, s.clutch_dead, s.clutch_curve)
    handbrake_axis = Axis(s.handbrake_rest_raw, s.handbrake_full_raw, s.handbrake_dead, s.handbrake_curve)
    throttle = Pedal(before.throttle, before.throttle_validity)
    brake = Pedal(before.brake, before.brake_validity)
    clutch = Pedal(before.clutch, before.clutch_validity)
    handbrake = Pedal(before.handbrake, before.handbrake_validity)
    return Pedals(
        pedal(sample.throttle_axis, age_ticks, refused_ticks, throttle, throttle_axis, s),
        pedal(sample.brake_axis, age_ticks, refused_ticks, brake, brake_axis, s),
        pedal(sample.clutch_axis, age_ticks, refused_ticks, clutch, clutch_axis, s),
        pedal(sample.handbrake_axis, sample.handbrake_age_ticks, refused_ticks, handbrake, handbrake_axis, s),
    )


@kernel
def wheel_angle(raw: float, settings: CockpitSettings) -> float:
    """Return the hand wheel's angle from a good reading."""
    offset = _beyond(raw - settings.wheel_centre_raw, settings.wheel_dead_raw)
    return _bent(offset, settings.wheel_curve) * settings.wheel_rad_per_raw


@kernel
def wheel(
    raw: float,
    age_ticks: float,
    refused_ticks: float,
    before: Wheel,
    model_rad: float,
    settings: CockpitSettings,
    tick_s: float,
) -> Wheel:
    """Return the hand wheel: held where it was while it is not trusted, its rate through a first-order filter.

    A wheel has no rest position: it is armed by its first good reading. One that was lost stays lost until its angle
    matches the car's own steering (`model_rad`): the road wheels must not jump to the angle at which it comes back.
    """
    good = axis_good(raw)
    if before.validity == LOST and good:
        offset_rad = wheel_angle(raw, settings) - model_rad
        good = is_finite(offset_rad) and abs(offset_rad) <= settings.wheel_rearm_rad
        if not good:
            return Wheel(before.rad, 0.0, LOST)
    validity = next_validity(before.validity, age_ticks, 0.0 if good else refused_ticks, settings.stale_ticks, True)
    if not is_trusted(validity):
        return Wheel(before.rad, 0.0, validity)
    if not good:
        return Wheel(before.rad, before.radps, validity)
    rad = wheel_angle(raw, settings)
    if not is_trusted(before.validity) or tick_s <= 0.0:
        return Wheel(rad, 0.0, validity)
    share = tick_s / (tick_s + settings.wheel_rate_filter_s)
    return Wheel(rad, before.radps + share * ((rad - before.rad) / tick_s - before.radps), validity)


@kernel
def _beyond(value: float, dead: float) -> float:
    if value > dead:
        return value - dead
    if value < -dead:
        return value + dead
    return 0.0


@kernel
def _bent(offset: float, curve: float) -> float:
    if offset >= 1.0 or offset <= -1.0:
        return offset
    return curved(offset, curve) if offset >= 0.0 else -curved(-offset, curve)


@kernel
def lever(sample: DeviceSample, edges: int, refused_ticks: float, before: Lever, settings: CockpitSettings) -> Lever:
    """Return the gear lever: kept where it was while it is not trusted or its reading is invalid."""
    good = mask_good(sample.shifter_buttons) and mask_good(sample.wheel_buttons)
    shown = shown_gear(sample.wheel_buttons, sample.shifter_buttons, settings) if good else 0.0
    at_rest = good and (settings.sequential > 0.0 or shown == 0.0)
    validity = next_validity(
        before.validity, sample.shifter_age_ticks, 0.0 if good else refused_ticks, settings.stale_ticks, at_rest
    )
    if not is_trusted(validity) or not good:
        return Lever(before.gear, validity, before.neutral_ticks, 0.0)
    fault = 1.0 if shown == TWO_GEARS and settings.sequential == 0.0 else 0.0
    if settings.sequential > 0.0:
        gear = stepped_gear(before.gear, edges, settings.top_gear)
        return Lever(gear, validity, before.neutral_ticks + 1.0 if gear == 0.0 else 0.0, 0.0)
    neutral_ticks = before.neutral_ticks + 1.0 if shown == 0.0 else 0.0
    gear = lever_gear(before.gear, shown, neutral_ticks, settings.neutral_dwell_ticks)
    return Lever(gear, validity, neutral_ticks, fault)


@kernel
def refused(sample: DeviceSample) -> bool:
    """Return whether any reading of this sample is not finite or out of range."""
    if not (mask_good(sample.wheel_buttons) and mask_good(sample.shifter_buttons)):
        return True
    if not (axis_good(sample.wheel_axis) and axis_good(sample.throttle_axis) and axis_good(sample.brake_axis)):
        return True
    return not (axis_good(sample.clutch_axis) and axis_good(sample.handbrake_axis))


@kernel
def calibrate(
    sample: DeviceSample,
    before: DeviceSample,
    previous: DriverInput,
    model_wheel_rad: float,
    settings: CockpitSettings,
    tick_s: float,
) -> DriverInput:
    """Return what the person does, from the cockpit as read.

    Args:
        sample: The cockpit in this tick, raw.
        before: The cockpit in the tick before, raw: button edges are against it.
        previous: The result of the tick before; `NOBODY` at the first tick.
        model_wheel_rad: Where the hand wheel would stand if it were fixed to the car's road wheels.
        settings: The device profile as numbers.
        tick_s: Length of a tick in s.

    Returns:
        Angles left-positive in rad, pedals 0 to 1, gear -1, 0, 1..7. Inputs that are not trusted command nothing:
        pedals are 0, wheel and lever stay where they were.
    """
    bad_ticks = previous.refused_ticks + 1.0 if refused(sample) else 0.0
    turned = Wheel(previous.hand_wheel_rad, previous.hand_wheel_radps, previous.wheel_validity)
    angle = wheel(sample.wheel_axis, sample.wheel_age_ticks, bad_ticks, turned, model_wheel_rad, settings, tick_s)
    feet = pedals(sample, bad_ticks, previous, settings)
    held = _held(sample, sample, int(previous.pressed), settings)
    edges = held & ~_held(before, sample, int(previous.pressed), settings)
    shifted = Lever(previous.gear, previous.shifter_validity, previous.neutral_ticks, previous.lever_fault)
    shift = lever(sample, edges, bad_ticks, shifted, settings)
    handbrake = 1.0 if held & HANDBRAKE != 0 else feet.handbrake.pressed
    return DriverInput(
        hand_wheel_rad=angle.rad,
        hand_wheel_radps=angle.radps,
        throttle=feet.throttle.pressed,
        brake=feet.brake.pressed,
        clutch=feet.clutch.pressed,
        handbrake=handbrake,
        gear=shift.gear,
        pressed=float(held),
        edges=float(edges),
        wheel_validity=angle.validity,
        throttle_validity=feet.throttle.validity,
        brake_validity=feet.brake.validity,
        clutch_validity=feet.clutch.validity,
        shifter_validity=shift.validity,
        neutral_ticks=shift.neutral_ticks,
        refused_ticks=bad_ticks,
        lever_fault=shift.fault,
        handbrake_validity=feet.handbrake.validity,
    )


@kernel
def _held(sample: DeviceSample, now: DeviceSample, otherwise: int, settings: CockpitSettings) -> int:
    """Return the roles held in `sample`: `now` itself, or the sample before it, to which buttons are compared.

    Buttons of a device that is silent now are not held; those of one that was silent before count as held then, so
    that a button which is down while its device comes back is no press. A wheel that is not armed has its buttons.
    """
    if not (mask_good(sample.wheel_buttons) and mask_good(sample.shifter_buttons)):
        return otherwise
    if not (mask_good(now.wheel_buttons) and mask_good(now.shifter_buttons)):
        return otherwise
    wheel_buttons = 0.0
    shifter_buttons = 0.0
    hat = 0
    if heard(now.wheel_age_ticks, settings.stale_ticks):
        then = heard(sample.wheel_age_ticks, settings.stale_ticks)
        wheel_buttons = sample.wheel_buttons if then else now.wheel_buttons
        hat = hat_mask(sample.hat_x, sample.hat_y) if then else hat_mask(now.hat_x, now.hat_y)
    if heard(now.shifter_age_ticks, settings.stale_ticks):
        then = heard(sample.shifter_age_ticks, settings.stale_ticks)
        shifter_buttons = sample.shifter_buttons if then else now.shifter_buttons
    return held_roles(wheel_buttons, shifter_buttons, hat, settings)
