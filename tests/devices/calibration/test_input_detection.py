"""What raw readings teach: any wheel and pedals, however turned round, come out as a profile that reads them back."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from simconsole.devices.calibration.calibrator import pressed_share
from simconsole.devices.calibration.input_detection import (
    AxisAt,
    ButtonAt,
    Reading,
    SteadyReading,
    SteadyReadings,
    moved_axis,
    pedal_axis_of,
    pressed_button,
    steady_readings,
    wheel_axis_of,
)
from simconsole.profiles.device import DeviceKey
from simconsole.profiles.parts.axes import MIN_TRAVEL_RAW
from simconsole.values.errors import DeviceError

A, B = DeviceKey(1, 2), DeviceKey(3, 4)


def held(*axes: float, buttons: int = 0, spread: float = 0.0) -> SteadyReading:
    return SteadyReading(axes, (spread,) * len(axes), buttons)


def at(moment: SteadyReadings, key: DeviceKey, axis: int) -> AxisAt:
    return AxisAt(key, axis, moment[key].mean[axis])


def test_hold_averages_keeps_the_noise_and_only_buttons_held_throughout() -> None:
    moment = steady_readings([{A: Reading((0.5, 1.0), 0b110)}, {A: Reading((0.7, 1.0), 0b010)}])
    assert moment[A].mean == pytest.approx((0.6, 1.0))
    assert moment[A].spread == pytest.approx((0.2, 0.0))
    assert moment[A].buttons == 0b010


def test_device_that_came_late_is_left_out() -> None:
    assert set(steady_readings([{A: Reading((0.0,), 0)}, {A: Reading((0.0,), 0), B: Reading((0.0,), 0)}])) == {A}


def test_axis_that_is_no_number_is_refused() -> None:
    with pytest.raises(DeviceError, match="not finite"):
        steady_readings([{A: Reading((math.nan,), 0)}])


def test_the_axis_that_moved_is_found_on_any_device() -> None:
    rest = {A: held(0.0, 1.0), B: held(0.0)}
    assert moved_axis(rest, {A: held(0.01, -0.8), B: held(0.0)}) == AxisAt(A, 1, -0.8)
    assert moved_axis(rest, {A: held(0.0, 1.0), B: held(0.5)}) == AxisAt(B, 0, 0.5)


def test_nothing_or_too_much_moved_is_said() -> None:
    rest = {A: held(0.0, 1.0)}
    with pytest.raises(DeviceError, match="none moved"):
        moved_axis(rest, {A: held(0.1, 0.9)})
    with pytest.raises(DeviceError, match="0 and 1 moved"):
        moved_axis(rest, {A: held(0.9, 0.2)})
    assert moved_axis(rest, {A: held(0.9, 0.2)}, [(A, 0)]).axis == 1


def test_button_is_one_new_one() -> None:
    rest = {A: held(buttons=0b001), B: held()}
    assert pressed_button(rest, {A: held(buttons=0b101), B: held()}) == ButtonAt(A, 2)
    with pytest.raises(DeviceError, match="none held"):
        pressed_button(rest, {A: held(buttons=0b001), B: held()})
    with pytest.raises(DeviceError, match="1 and 2 held"):
        pressed_button(rest, {A: held(buttons=0b111), B: held()})
    with pytest.raises(DeviceError, match="has a meaning already"):
        pressed_button(rest, {A: held(buttons=0b101)}, [ButtonAt(A, 2)])


RAW = st.floats(-1.0, 1.0)


@given(RAW, RAW, st.floats(0.0, 0.01), st.lists(RAW, min_size=2, max_size=20))
def test_learnt_pedal_is_monotone_bounded_quiet_at_rest_and_full_at_its_end(
    rest: float, full: float, noise: float, raws: list[float]
) -> None:
    if abs(full - rest) < MIN_TRAVEL_RAW + 0.01:
        return
    pedal = pedal_axis_of({A: held(rest, spread=noise)}, AxisAt(A, 0, full))
    curve = (pedal.rest_raw, pedal.full_raw, pedal.dead_zone, pedal.curve)
    assert pressed_share(rest + noise, *curve) == 0.0
    assert pressed_share(rest - noise, *curve) == 0.0
    assert pressed_share(full, *curve) == 1.0
    raws.sort(reverse=full < rest)
    shares = [pressed_share(raw, *curve) for raw in raws]
    assert shares == sorted(shares)
    assert all(0.0 <= share <= 1.0 for share in shares)


def test_noisy_pedal_is_refused() -> None:
    with pytest.raises(DeviceError, match="noise at rest"):
        pedal_axis_of({A: held(0.0, spread=0.2)}, AxisAt(A, 0, 0.5))


@given(st.floats(0.25, 1.0), st.floats(-0.04, 0.04), st.sampled_from([-1.0, 1.0]), st.floats(180.0, 1080.0))
def test_learnt_wheel_turns_left_to_the_left_by_the_true_degrees(
    reach: float, middle: float, side: float, degrees: float
) -> None:
    wheel = wheel_axis_of(AxisAt(A, 0, side * reach), AxisAt(A, 0, -side * reach), {A: held(middle)}, degrees)
    assert wheel.grows_to == ("left" if side > 0.0 else "right")
    assert wheel.centre_raw == pytest.approx(middle, abs=1e-5)
    assert wheel.lock_to_lock_deg * reach == pytest.approx(degrees, abs=0.06)


@pytest.mark.parametrize(
    ("left", "right", "middle", "complaint"),
    [
        (AxisAt(A, 0, 1.0), AxisAt(A, 1, -1.0), 0.0, "the same one"),
        (AxisAt(A, 0, 0.1), AxisAt(A, 0, -0.1), 0.0, "from lock to lock"),
        (AxisAt(A, 0, 1.0), AxisAt(A, 0, -1.0), 0.9, "straight ahead"),
    ],
)
def test_wheel_that_makes_no_sense_is_refused(left: AxisAt, right: AxisAt, middle: float, complaint: str) -> None:
    with pytest.raises(DeviceError, match=complaint):
        wheel_axis_of(left, right, {A: held(middle, 0.0)}, 900.0)
