"""From raw to the person: arming, dead zones, holding, refusing, and the compiled twin."""

import math
import random

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from simconsole.devices.calibration.calibrator import calibrate, curved
from simconsole.devices.calibration.cockpit_settings import NOBODY, CockpitSettings, cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.profiles.device import ButtonBinding, CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.values.host.jit import compiled
from simconsole.values.signals import NEVER_TICKS, NO_SAMPLE, Button, DeviceSample
from simconsole.values.validity import ARMED, LIVE, LOST, STALE, UNKNOWN
from tests.devices.calibration_run import TICK_S, CalibrationRun

PROFILE = load("devices", "t500rs_th8rs", CockpitProfile)
SETTINGS = cockpit_settings(PROFILE, 250)
PEDALS = ("throttle", "brake", "clutch")
STALE_TICKS = int(SETTINGS.stale_ticks)


@pytest.fixture
def calibration() -> CalibrationRun:
    """A run whose every input has been armed."""
    armed = CalibrationRun(SETTINGS)
    armed.do(ticks=2)
    return armed


def validities(calibration: CalibrationRun) -> set[float]:
    driver = calibration.driver
    return {
        driver.wheel_validity,
        driver.throttle_validity,
        driver.brake_validity,
        driver.clutch_validity,
        driver.shifter_validity,
    }


def test_nothing_is_known_before_the_first_sample() -> None:
    calibration = CalibrationRun(SETTINGS)
    assert calibration.calibrate(NO_SAMPLE)[:9] == (0.0,) * 9
    assert validities(calibration) == {UNKNOWN}


def test_rest_arms_and_the_next_tick_is_live() -> None:
    calibration = CalibrationRun(SETTINGS)
    calibration.do()
    assert validities(calibration) == {ARMED}
    calibration.do()
    assert validities(calibration) == {LIVE}


@pytest.mark.fault("D05")
@pytest.mark.parametrize("pedal", PEDALS)
def test_pedal_pressed_at_start_reads_zero_until_released(pedal: str) -> None:
    """D05: a pedal stuck at 100 % commands nothing; one released to 5 % or less does from then on."""
    calibration = CalibrationRun(SETTINGS)
    for pressed in (1.0, 0.5, 0.06):
        driver = calibration.do(Intent(**{pedal: pressed}))  # type: ignore[arg-type]  # a field by its name
        assert getattr(driver, pedal) == 0.0
        assert getattr(driver, f"{pedal}_validity") == UNKNOWN
    calibration.do(Intent(**{pedal: 0.02}))  # type: ignore[arg-type]  # a field by its name
    assert getattr(calibration.do(Intent(**{pedal: 0.7})), pedal) == pytest.approx(0.7)  # type: ignore[arg-type]  # a field by its name


def test_axes_at_zero_before_their_first_report_are_no_half_throttle() -> None:
    """SDL reads 0.0 until the device reports: half the travel of a pedal that rests at 1.0."""
    calibration = CalibrationRun(SETTINGS)
    driver = calibration.do(throttle_axis=0.0, brake_axis=0.0, clutch_axis=0.0)
    assert (driver.throttle, driver.brake, driver.clutch) == (0.0, 0.0, 0.0)
    assert driver.throttle_validity == UNKNOWN


def test_dead_zone_is_silent_and_the_pedal_begins_at_its_end(calibration: CalibrationRun) -> None:
    assert calibration.do(throttle_axis=1.0 - 2.0 * 0.0199).throttle == 0.0
    assert 0.0 < calibration.do(throttle_axis=1.0 - 2.0 * 0.021).throttle < 0.002
    assert calibration.do(throttle_axis=-1.0).throttle == 1.0


def test_wheel_is_left_positive_and_spans_its_lock(calibration: CalibrationRun) -> None:
    assert calibration.do(wheel_axis=-1.0).hand_wheel_rad == pytest.approx(math.radians(540))
    assert calibration.do(wheel_axis=1.0).hand_wheel_rad == pytest.approx(-math.radians(540))


def test_wheel_rate_settles_at_the_true_rate(calibration: CalibrationRun) -> None:
    for tick in range(60):
        driver = calibration.do(Intent(hand_wheel_rad=0.01 * tick))
    assert driver.hand_wheel_radps == pytest.approx(2.5, rel=1e-3)
    assert abs(calibration.do(Intent(hand_wheel_rad=0.59), ticks=60).hand_wheel_radps) < 1e-3


def test_first_wheel_position_is_no_motion() -> None:
    calibration = CalibrationRun(SETTINGS)
    driver = calibration.do(Intent(hand_wheel_rad=3.0))
    assert driver.hand_wheel_rad == pytest.approx(3.0)
    assert driver.hand_wheel_radps == 0.0


@pytest.mark.parametrize("tick_hz", [50, 250, 1000])
def test_silence_counts_from_the_first_tick_after_100_ms_at_every_rate(tick_hz: int) -> None:
    calibration = CalibrationRun(cockpit_settings(PROFILE, tick_hz))
    calibration.do(ticks=2)
    for age in range(1, tick_hz):
        calibration.do(wheel_age_ticks=age, pedals_age_ticks=age, shifter_age_ticks=age)
        if validities(calibration) != {LIVE}:
            break
    assert validities(calibration) == {STALE}
    assert age == 0.1 * tick_hz + 1


@pytest.mark.fault("D03")
def test_silent_device_is_held_then_stale_and_returns_without_arming_again(calibration: CalibrationRun) -> None:
    """D03: 100 ms."""
    pressed = Intent(throttle=0.6, hand_wheel_rad=1.0, gear=3)
    calibration.do(pressed, ticks=3)
    for age in range(1, STALE_TICKS + 1):
        ages = {"wheel_age_ticks": age, "pedals_age_ticks": age, "shifter_age_ticks": age}
        held = calibration.do(pressed, **ages)
        assert held.throttle == pytest.approx(0.6)
    assert validities(calibration) == {LIVE}
    stale = calibration.do(pressed, wheel_age_ticks=26, pedals_age_ticks=26, shifter_age_ticks=26)
    assert validities(calibration) == {STALE}
    assert stale.throttle == 0.0
    assert (stale.hand_wheel_rad, stale.hand_wheel_radps, stale.gear) == (pytest.approx(1.0), 0.0, 3.0)
    assert calibration.do(pressed).throttle == pytest.approx(0.6)


def test_lost_pedals_must_be_seen_at_rest_again(calibration: CalibrationRun) -> None:
    calibration.do(Intent(throttle=0.8))
    lost = calibration.do(Intent(throttle=0.8), pedals_age_ticks=NEVER_TICKS)
    assert (lost.throttle, lost.throttle_validity) == (0.0, LOST)
    assert lost.wheel_validity == LIVE
    back = calibration.do(Intent(throttle=0.8))
    assert (back.throttle, back.throttle_validity) == (0.0, UNKNOWN)
    calibration.do()
    assert calibration.do(Intent(throttle=0.8)).throttle == pytest.approx(0.8)


@pytest.mark.fault("D04")
@pytest.mark.parametrize("off_deg", [-6.0, -5.1, 5.1, 400.0])
def test_lost_wheel_stays_lost_until_it_stands_as_the_car_steers(off_deg: float, calibration: CalibrationRun) -> None:
    """D04: 5 degrees. The road wheels keep what they were told until then."""
    model_deg = 40.0
    calibration.do(Intent(hand_wheel_rad=1.0), ticks=3)
    calibration.do(wheel_age_ticks=NEVER_TICKS)
    calibration.model_rad = math.radians(model_deg)
    away = calibration.do(Intent(hand_wheel_rad=math.radians(model_deg + off_deg)), ticks=500)
    assert away.wheel_validity == LOST
    assert (away.hand_wheel_rad, away.hand_wheel_radps) == (pytest.approx(1.0), 0.0)
    near = calibration.do(Intent(hand_wheel_rad=math.radians(model_deg + math.copysign(4.9, off_deg))))
    assert near.wheel_validity == ARMED
    assert near.hand_wheel_rad == pytest.approx(math.radians(model_deg + math.copysign(4.9, off_deg)))
    assert calibration.do(Intent(hand_wheel_rad=-2.0)).hand_wheel_rad == pytest.approx(-2.0), (
        "and then it obeys everywhere"
    )


def test_lost_wheel_that_reads_nonsense_or_a_car_whose_angle_is_none_stays_lost(calibration: CalibrationRun) -> None:
    calibration.do(wheel_age_ticks=NEVER_TICKS)
    assert calibration.do(wheel_axis=math.nan, ticks=60).wheel_validity == LOST
    calibration.model_rad = math.nan
    assert calibration.do().wheel_validity == LOST


def test_emergency_button_of_a_wheel_that_is_not_armed_works(calibration: CalibrationRun) -> None:
    calibration.do(wheel_age_ticks=NEVER_TICKS)
    calibration.model_rad = 2.0
    calibration.do()
    pressed = calibration.do(Intent(pressed=int(Button.EMERGENCY_STOP)))
    assert (pressed.wheel_validity, pressed.edges) == (LOST, float(Button.EMERGENCY_STOP))


def test_shifter_buttons_work_while_the_wheel_is_gone() -> None:
    buttons = msgspec.structs.replace(PROFILE.buttons, mark=ButtonBinding(on="shifter", button=9))
    calibration = CalibrationRun(cockpit_settings(msgspec.structs.replace(PROFILE, buttons=buttons), 250))
    calibration.do(ticks=2)
    calibration.do(wheel_age_ticks=NEVER_TICKS)
    assert calibration.do(Intent(pressed=int(Button.MARK)), wheel_age_ticks=NEVER_TICKS).edges == float(Button.MARK)
    assert calibration.do(Intent(), shifter_age_ticks=NEVER_TICKS).pressed == 0.0


@pytest.mark.fault("D07")
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1.5, -1e308])
@pytest.mark.parametrize("field", ["wheel_axis", "throttle_axis", "brake_axis", "clutch_axis"])
def test_bad_axis_is_refused_held_and_stale_after_100_ms(field: str, value: float, calibration: CalibrationRun) -> None:
    """D07, for every axis."""
    good = Intent(hand_wheel_rad=0.5, throttle=0.4, brake=0.3, clutch=0.2)
    before = calibration.do(good, ticks=200)
    held = calibration.do(good, ticks=STALE_TICKS, **{field: value})
    for name in ("hand_wheel_rad", *PEDALS):
        assert getattr(held, name) == pytest.approx(getattr(before, name))
    assert validities(calibration) == {LIVE}
    assert held.refused_ticks == STALE_TICKS
    stale = calibration.do(good, **{field: value})  # type: ignore[arg-type]  # a field by its name
    role = field.removesuffix("_axis")
    assert getattr(stale, f"{role}_validity") == STALE
    assert role == "wheel" or getattr(stale, role) == 0.0
    assert sum(v == STALE for v in stale[9:14]) == 1
    assert all(math.isfinite(number) for number in stale)
    assert calibration.do(good).refused_ticks == 0.0
    assert validities(calibration) == {LIVE}


@pytest.mark.parametrize("mask", [math.nan, -1.0, 0.5, 2.0**24, math.inf])
@pytest.mark.parametrize("field", ["wheel_buttons", "shifter_buttons"])
def test_bad_button_mask_is_refused_and_the_last_kept(field: str, mask: float, calibration: CalibrationRun) -> None:
    held = Intent(gear=2, pressed=int(Button.MARK))
    calibration.do(held, ticks=2)
    driver = calibration.do(held, **{field: mask})  # type: ignore[arg-type]  # a field by its name
    assert (driver.gear, driver.pressed, driver.edges) == (2.0, float(Button.MARK), 0.0)
    driver = calibration.do(held)
    assert (driver.gear, driver.pressed, driver.edges) == (2.0, float(Button.MARK), 0.0)


def test_button_is_an_edge_once(calibration: CalibrationRun) -> None:
    pressed = Intent(pressed=int(Button.AUTONOMOUS | Button.INDICATOR_LEFT))
    first, second = calibration.do(pressed), calibration.do(pressed)
    assert first.edges == first.pressed == float(Button.AUTONOMOUS | Button.INDICATOR_LEFT)
    assert (second.edges, second.pressed) == (0.0, first.pressed)
    assert calibration.do().pressed == 0.0


@pytest.mark.parametrize(
    ("hat", "roles"),
    [
        ({"hat_y": 1.0}, Button.HAZARD),
        ({"hat_y": -1.0}, Button.FAULT),
        ({"hat_x": 1.0, "hat_y": 1.0}, Button.HAZARD),
        ({"hat_x": 1.0}, Button(0)),
        ({"hat_y": math.nan}, Button(0)),
        ({"hat_y": 1.0, "wheel_age_ticks": NEVER_TICKS}, Button(0)),
    ],
)
def test_the_hat_of_the_wheel_has_buttons_too(
    hat: dict[str, float], roles: Button, calibration: CalibrationRun
) -> None:
    first, second = calibration.do(**hat), calibration.do(**hat)  # type: ignore[arg-type]  # fields by their name
    assert (first.pressed, first.edges) == (float(roles), float(roles))
    assert (second.pressed, second.edges) == (float(roles), 0.0)


def test_a_handbrake_may_be_a_button_or_a_direction_of_the_hat() -> None:
    for mask in (float(1 << 5), float(8 << 48)):
        calibration = CalibrationRun(
            SETTINGS._replace(handbrake_button_mask=mask, handbrake_rest_raw=0.0, handbrake_full_raw=0.0)
        )
        calibration.do(ticks=2)
        assert calibration.do().handbrake == 0.0
        held = calibration.do(Intent(pressed=int(Button.HANDBRAKE_BUTTON)))
        assert held.handbrake == 1.0
        assert calibration.do().handbrake == 0.0


def test_button_held_while_the_wheel_arrives_is_no_edge() -> None:
    calibration = CalibrationRun(SETTINGS)
    held = Intent(pressed=int(Button.AUTONOMOUS))
    assert [driver.edges for driver in (calibration.do(held), calibration.do(held))] == [0.0, 0.0]


def test_lost_wheel_presses_nothing(calibration: CalibrationRun) -> None:
    pressed = Intent(pressed=int(Button.RESET))
    calibration.do(pressed)
    assert calibration.do(pressed, wheel_age_ticks=NEVER_TICKS).pressed == 0.0


def test_straight_curve_changes_no_bit() -> None:
    assert [curved(share / 97.0, 1.0) for share in range(98)] == [share / 97.0 for share in range(98)]


def test_curve_above_one_is_gentle_first_and_below_one_quick() -> None:
    assert curved(0.1, 3.0) < 0.1 < curved(0.1, 0.4)
    assert curved(0.9, 3.0) < 0.9 < curved(0.9, 0.4)


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_wheel_is_monotone(one: float, other: float) -> None:
    low, high = sorted((one, other))
    calibration = CalibrationRun(SETTINGS)
    right, left = calibration.do(wheel_axis=high).hand_wheel_rad, calibration.do(wheel_axis=low).hand_wheel_rad
    assert right <= left
    assert max(abs(right), abs(left)) <= math.radians(540.0) * (1 + 1e-12)


NUMBERS = st.one_of(st.floats(), st.floats(-1.1, 1.1), st.sampled_from([0.0, 1.0, 3.0, 25.0, 26.0, NEVER_TICKS]))


@given(st.lists(st.lists(NUMBERS, min_size=13, max_size=13), max_size=20))
def test_no_sample_whatever_makes_anything_not_finite(rows: list[list[float]]) -> None:
    calibration = CalibrationRun(SETTINGS)
    for driver in calibration.all(DeviceSample(*row) for row in rows):
        assert all(math.isfinite(number) for number in driver)
        assert all(0.0 <= getattr(driver, pedal) <= 1.0 for pedal in (*PEDALS, "handbrake"))
        assert -1.0 <= driver.gear <= 7.0


def random_samples(seed: int, count: int, cockpit: CockpitSettings) -> list[DeviceSample]:
    """Mostly a person driving, now and then nonsense, silence or a pulled plug."""
    dice = random.Random(seed)
    samples = []
    intent = Intent()
    for _ in range(count):
        if dice.random() < 0.3:
            gear = 0.0 if cockpit.sequential else float(dice.randint(-1, 7))
            feet = (dice.random() for _ in range(4))
            intent = Intent._make((dice.uniform(-9, 9), *feet, gear, dice.getrandbits(9)))
        if dice.random() < 0.1:
            intent = Intent()
        sample = raw_sample(intent, cockpit)
        if dice.random() < 0.1:
            field = dice.choice(DeviceSample._fields)
            value = dice.choice([math.nan, math.inf, -math.inf, 0.5, -2.0, 5.0, 26.0, NEVER_TICKS, 2.0**24])
            sample = sample._replace(**{field: value})
        samples.append(sample)
    return samples


@pytest.mark.parametrize("name", ["t500rs_th8rs", "gamepad"])
def test_compiled_twin_gives_equal_bits(name: str) -> None:
    seed = 20261120
    print("seed", seed)
    cockpit = cockpit_settings(load("devices", name, CockpitProfile), 250)
    twin = compiled(calibrate)
    before, plain, fast = NO_SAMPLE, NOBODY, NOBODY
    for sample in random_samples(seed, 4000, cockpit):
        plain = calibrate(sample, before, plain, 0.3, cockpit, TICK_S)
        fast = twin(sample, before, fast, 0.3, cockpit, TICK_S)
        before = sample
        assert [number.hex() for number in plain] == [float(number).hex() for number in fast]
