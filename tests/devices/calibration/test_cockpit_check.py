"""What a check of a cockpit calls wrong."""

import pytest

from simconsole.devices.calibration.cockpit_check import CockpitCheck
from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.profiles.device import CockpitProfile
from tests.devices.calibration_run import CalibrationRun


@pytest.mark.fault("D09")
def test_check_names_a_pedal_that_was_never_released(t500: CockpitProfile) -> None:
    """D09, one pedal: the others work."""
    check = CockpitCheck(t500, 250)
    for _ in range(5):
        check.add(CalibrationRun(check._settings).raw(brake_axis=-1.0))
    problems = check.problems()
    assert len(problems) == 1
    assert problems[0].startswith("pedals.brake: value 100% pressed at least: at most 5% at rest")
    assert not check.results()["ok"]


def test_check_tells_of_a_wheel_that_is_not_straight_as_a_drive_begins_with_it_too(
    t500: CockpitProfile, t500_settings: CockpitSettings
) -> None:
    check = CockpitCheck(t500, 250)
    calibration = CalibrationRun(t500_settings)
    for angle_rad in (0.0, 0.2, 0.8):
        check.add(calibration.raw(Intent(hand_wheel_rad=angle_rad)))
    assert check.problems() == []
    assert "the wheel stands at 46 deg: centre_raw is wrong, or it was not let go" in check.notes()
