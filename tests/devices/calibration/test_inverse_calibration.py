"""The inverse of calibration gives back what a person does."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from simconsole.devices.calibration.calibrator import pressed_share
from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, button_masks, pedal_raw, raw_sample, wheel_raw
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.parts.axes import MIN_TRAVEL_RAW
from simconsole.values.signals import Button
from tests.devices.calibration_run import CalibrationRun

PROFILE = load("devices", "t500rs_th8rs", CockpitProfile)
SETTINGS = cockpit_settings(PROFILE, 250)


@given(st.lists(st.floats(0.0, 1.0), min_size=2, max_size=40))
def test_pedal_is_monotone_bounded_and_has_an_inverse(shares: list[float]) -> None:
    shares.sort()
    calibration = CalibrationRun(SETTINGS)
    calibration.do(ticks=2)
    pressed = [calibration.do(Intent(brake=share)).brake for share in shares]
    assert pressed == sorted(pressed)
    assert all(0.0 <= brake <= 1.0 for brake in pressed)
    assert pressed == pytest.approx(shares, abs=1e-12)


RAW = st.floats(-1.0, 1.0)
CURVES = st.floats(0.2, 5.0)
ENDS = st.tuples(RAW, RAW).filter(lambda ends: abs(ends[1] - ends[0]) >= MIN_TRAVEL_RAW)


@given(ENDS, st.floats(0.0, 0.3), CURVES, st.lists(RAW, min_size=2, max_size=30), st.floats(0.0, 1.0))
def test_any_pedal_is_monotone_bounded_and_invertible(
    ends: tuple[float, float], dead: float, curve: float, raws: list[float], share: float
) -> None:
    rest, full = ends
    raws.sort(reverse=full < rest)
    pressed = [pressed_share(raw, rest, full, dead, curve) for raw in raws]
    assert pressed == sorted(pressed)
    assert all(0.0 <= value <= 1.0 for value in pressed)
    raw = pedal_raw(share, rest, full, dead, curve)
    assert -1.0 - 1e-12 <= raw <= 1.0 + 1e-12
    assert pressed_share(raw, rest, full, dead, curve) == pytest.approx(share, abs=1e-9)
    assert pressed_share(rest, rest, full, dead, curve) == 0.0
    assert pressed_share(full, rest, full, dead, curve) == pytest.approx(1.0, abs=1e-9)


@given(
    st.floats(-0.5, 0.5), st.floats(0.0, 0.1), CURVES, st.sampled_from([-1.0, 1.0]), RAW, RAW, st.floats(-0.35, 0.35)
)
def test_any_wheel_is_monotone_bounded_and_invertible(
    centre: float, dead: float, curve: float, side: float, one: float, other: float, share: float
) -> None:
    reach = side * math.radians(540.0)
    wheel = SETTINGS._replace(wheel_centre_raw=centre, wheel_dead_raw=dead, wheel_curve=curve, wheel_rad_per_raw=reach)
    low, high = sorted((one, other))
    angles = [CalibrationRun(wheel).do(wheel_axis=raw).hand_wheel_rad * side for raw in (low, centre, high)]
    assert angles[0] <= angles[2]
    assert angles[1] == 0.0
    assert max(map(abs, angles)) <= abs(reach) * (1.0 + abs(centre)) + 1e-9
    raw = wheel_raw(share * reach, wheel)
    if abs(raw) < 1.0:
        assert CalibrationRun(wheel).do(wheel_axis=raw).hand_wheel_rad == pytest.approx(share * reach, abs=1e-9)


def test_hand_wheel_stops_at_the_ends_of_its_axis() -> None:
    assert wheel_raw(math.radians(10_000.0), SETTINGS) == -1.0
    assert wheel_raw(math.radians(-10_000.0), SETTINGS) == 1.0
    assert wheel_raw(0.0, SETTINGS._replace(wheel_centre_raw=0.06, wheel_dead_raw=0.1)) == 0.06


def test_lever_roles_and_hat_go_to_their_own_devices() -> None:
    held = int(Button.AUTONOMOUS | Button.HAZARD)
    assert button_masks(3.0, held, SETTINGS) == (1 << 4, 1 << 2, 4)
    assert button_masks(-1.0, 0, SETTINGS) == (0, 1 << 7, 0)
    assert button_masks(0.0, 0, SETTINGS) == (0, 0, 0)
    assert button_masks(3.0, 0, SETTINGS._replace(sequential=1.0)) == (0, 0, 0), "paddles hold no gear"


def test_sample_is_fresh_and_the_hat_points_where_it_is_held() -> None:
    sample = raw_sample(Intent(pressed=int(Button.FAULT)), SETTINGS)
    assert (sample.hat_x, sample.hat_y) == (0.0, -1.0)
    assert sample[9:13] == (0.0,) * 4
