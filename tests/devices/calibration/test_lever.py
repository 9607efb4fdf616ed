"""The gear lever: H pattern with dwell and one-hot check, and the sequential one."""

import pytest

from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.values.signals import NEVER_TICKS, Button
from simconsole.values.validity import LIVE, UNKNOWN
from tests.devices.calibration_run import CalibrationRun

DWELL = 25


@pytest.fixture
def calibration(t500_settings: CockpitSettings) -> CalibrationRun:
    armed = CalibrationRun(t500_settings)
    armed.do(ticks=2)
    return armed


@pytest.mark.parametrize("gear", [-1, 1, 2, 3, 4, 5, 6, 7])
def test_each_gear_is_its_own_button(gear: int, calibration: CalibrationRun) -> None:
    assert calibration.do(Intent(gear=gear)).gear == gear


def test_reverse_is_the_eighth_button_of_the_shifter(calibration: CalibrationRun) -> None:
    assert calibration.do(shifter_buttons=float(1 << 7)).gear == -1.0
    assert calibration.do(shifter_buttons=float(1 << 0)).gear == 1.0


def test_neutral_only_after_its_dwell(calibration: CalibrationRun) -> None:
    calibration.do(Intent(gear=2))
    gears = [calibration.do().gear for _ in range(DWELL + 1)]
    assert gears == [2.0] * (DWELL - 1) + [0.0, 0.0]


def test_shift_through_the_gate_is_never_neutral(calibration: CalibrationRun) -> None:
    calibration.do(Intent(gear=2))
    gears = [calibration.do().gear for _ in range(DWELL - 1)]
    gears.append(calibration.do(Intent(gear=3)).gear)
    assert gears == [2.0] * (DWELL - 1) + [3.0]
    assert calibration.driver.neutral_ticks == 0.0


@pytest.mark.fault("D08")
@pytest.mark.parametrize("mask", [0b11, 0b10000001, 0b1111111])
def test_two_gears_at_once_keep_the_last(mask: int, calibration: CalibrationRun) -> None:
    """D08."""
    calibration.do(Intent(gear=4))
    both = calibration.do(ticks=50, shifter_buttons=float(mask))
    assert (both.gear, both.lever_fault) == (4.0, 1.0)
    one = calibration.do(Intent(gear=5))
    assert (one.gear, one.lever_fault) == (5.0, 0.0)


def test_lever_in_gear_at_the_start_counts_only_after_neutral(t500_settings: CockpitSettings) -> None:
    calibration = CalibrationRun(t500_settings)
    driver = calibration.do(Intent(gear=1), ticks=10)
    assert (driver.gear, driver.shifter_validity) == (0.0, UNKNOWN)
    calibration.do()
    assert calibration.do(Intent(gear=1)).gear == 1.0


def test_lost_shifter_keeps_the_gear_until_neutral_was_seen_again(calibration: CalibrationRun) -> None:
    calibration.do(Intent(gear=3))
    assert calibration.do(ticks=100, shifter_age_ticks=NEVER_TICKS).gear == 3.0
    assert calibration.do(Intent(gear=5)).gear == 3.0
    assert calibration.do(ticks=DWELL).gear == 0.0
    driver = calibration.do(Intent(gear=5))
    assert (driver.gear, driver.shifter_validity) == (5.0, LIVE)


def test_sequential_lever_steps_once_per_press_from_reverse_to_the_top(keyboard_settings: CockpitSettings) -> None:
    calibration = CalibrationRun(keyboard_settings)
    calibration.do(ticks=2)

    def press(button: Button) -> float:
        calibration.do(Intent(pressed=int(button)), ticks=3)
        return calibration.do().gear

    assert [press(Button.SHIFT_UP) for _ in range(8)] == [1, 2, 3, 4, 5, 6, 6, 6]
    assert [press(Button.SHIFT_DOWN) for _ in range(9)] == [5, 4, 3, 2, 1, 0, -1, -1, -1]
