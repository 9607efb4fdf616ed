"""A profile as plain numbers."""

import math

import msgspec
import pytest

from simconsole.devices.calibration.cockpit_settings import CockpitSettings, cockpit_settings
from simconsole.profiles.device import CockpitProfile, Shifter


def test_limits_in_time_never_grow_when_they_become_ticks(t500: CockpitProfile) -> None:
    assert cockpit_settings(t500, 250).stale_ticks == 25.0
    assert cockpit_settings(t500, 125).stale_ticks == 12.0
    assert cockpit_settings(t500, 1000).stale_ticks == 100.0
    assert cockpit_settings(t500, 50).neutral_dwell_ticks == 5.0


def test_wheel_shifter_and_hat_never_share_a_bit_of_a_mask(t500_settings: CockpitSettings) -> None:
    s = t500_settings
    assert int(s.shift_down_mask) == 1, "button 0 of the wheel"
    assert int(s.gear_1_mask) == 1 << 24, "button 0 of the shifter"
    assert int(s.gear_reverse_mask) == 1 << 31
    assert (int(s.hazard_mask), int(s.fault_mask)) == (4 << 48, 8 << 48), "the hat's up and down"
    assert s.handbrake_button_mask == 0.0, "bound to nothing"
    masks = [int(value) for name, value in s._asdict().items() if name.endswith("_mask")]
    assert all(float(mask) == mask and mask & (mask - 1) == 0 for mask in masks)
    pressed = [mask for mask in masks if mask]
    assert len(set(pressed)) == len(pressed)


def test_wheel_that_grows_to_the_right_counts_down_to_the_left(t500: CockpitProfile) -> None:
    assert cockpit_settings(t500, 250).wheel_rad_per_raw == pytest.approx(-math.radians(540.0))
    left = msgspec.structs.replace(t500, wheel=msgspec.structs.replace(t500.wheel, grows_to="left"))
    assert cockpit_settings(left, 250).wheel_rad_per_raw == pytest.approx(math.radians(540.0))


def test_pedal_that_is_not_there_has_no_travel(t500_settings: CockpitSettings) -> None:
    s = t500_settings
    assert (s.handbrake_rest_raw, s.handbrake_full_raw) == (0.0, 0.0)
    assert (s.clutch_rest_raw, s.clutch_full_raw) == (1.0, -1.0)


def test_top_gear_is_that_of_the_pattern(t500: CockpitProfile) -> None:
    five = msgspec.structs.replace(t500, shifter=Shifter(pattern="h", gears=[0, 1, 2, 3, 4]))
    settings = cockpit_settings(five, 250)
    assert (settings.sequential, settings.top_gear, settings.gear_6_mask) == (0.0, 5.0, 0.0)
    paddles = msgspec.structs.replace(t500, shifter=Shifter(pattern="sequential", on="wheel", top_gear=4))
    settings = cockpit_settings(paddles, 250)
    assert (settings.sequential, settings.top_gear, settings.gear_1_mask) == (1.0, 4.0, 0.0)
