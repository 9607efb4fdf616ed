"""Gain and autocentre of the driver: kept before the motor is opened, put back after it, all of it optional."""

from pathlib import Path

import pytest

from simconsole.devices.force_feedback.motor import SimulatedWheelPort
from simconsole.devices.force_feedback.simulated_wheel import SimulatedWheel
from simconsole.devices.haptics import back_ends
from simconsole.devices.haptics import driver_settings as driver_files
from simconsole.devices.haptics.driver_settings import RestoringPort, driver_folder, read_settings
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError
from tests.devices.port_contract import closes_twice_and_then_has_no_force, takes_every_level_in_any_order

WHEEL, OTHER = (0x044F, 0xB65E), (0x044F, 0xB660)
FORCE = ForceFeedback(max_torque_nm=4.0)


@pytest.fixture(autouse=True)
def sysfs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two event devices: a shifter without settings, and the wheel."""
    for event, (vendor, product) in (("event3", OTHER), ("event5", WHEEL)):
        ids = tmp_path / event / "device" / "id"
        ids.mkdir(parents=True)
        (ids / "vendor").write_text(f"{vendor:04x}\n")
        (ids / "product").write_text(f"{product:04x}\n")
        (tmp_path / event / "device" / "device").mkdir()
    folder = tmp_path / "event5" / "device" / "device"
    (folder / "gain").write_text("43690\n")
    (folder / "autocenter").write_text("12000\n")
    monkeypatch.setattr(driver_files, "CLASS", tmp_path)
    return folder


class NotedMotor(SimulatedWheelPort):
    """Keeps the levels that it was told."""

    def __init__(self) -> None:
        super().__init__(SimulatedWheel(FORCE, 1080.0, tick_hz=250))
        self.levels: list[float] = []

    def write(self, level: float) -> None:
        super().write(level)
        self.levels.append(level)


def motor() -> NotedMotor:
    return NotedMotor()


def test_folder_is_found_by_identity(sysfs: Path) -> None:
    assert driver_folder(WHEEL) == sysfs
    assert driver_folder((1, 2)) is None
    assert read_settings(OTHER) == {}


def test_settings_are_put_back_however_the_drive_changed_them(sysfs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(back_ends, "open_haptics", lambda *_: motor())
    port = back_ends.open_motor(0, WHEEL, FORCE)
    (sysfs / "gain").write_text("65535\n")
    (sysfs / "autocenter").write_text("0\n")
    port.close()
    assert ((sysfs / "gain").read_text(), (sysfs / "autocenter").read_text()) == ("43690\n", "12000\n")
    (sysfs / "gain").write_text("1\n")
    port.close()
    assert (sysfs / "gain").read_text() == "1\n", "once"


def test_wheel_without_such_files_is_left_as_the_profile_says(
    sysfs: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(back_ends, "open_haptics", lambda *_: motor())
    (sysfs / "gain").write_text("many\n")
    (sysfs / "autocenter").write_text("70000\n")
    assert not isinstance(back_ends.open_motor(0, WHEEL, FORCE), RestoringPort)
    monkeypatch.setattr(driver_files, "CLASS", tmp_path / "nowhere")
    assert read_settings(WHEEL) == {}


def test_motor_that_keeps_them_honours_the_contract(sysfs: Path) -> None:
    alone, kept = motor(), motor()
    takes_every_level_in_any_order(alone)
    takes_every_level_in_any_order(RestoringPort(kept, read_settings(WHEEL)))
    assert kept.levels == alone.levels != []
    assert RestoringPort(kept, read_settings(WHEEL)).capability == alone.capability
    closes_twice_and_then_has_no_force(RestoringPort(kept, read_settings(WHEEL)))
    assert not kept.capability.constant


def test_wheel_that_is_gone_meanwhile_is_no_error(sysfs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    port, before = motor(), read_settings(WHEEL)
    (sysfs / "gain").unlink()
    (sysfs / "gain").mkdir()  # as if it could not be written
    RestoringPort(port, before).close()

    def gone() -> None:
        raise DeviceError("gone")

    monkeypatch.setattr(port, "close", gone)
    (sysfs / "autocenter").write_text("0\n")
    with pytest.raises(DeviceError):
        RestoringPort(port, before).close()
    assert (sysfs / "autocenter").read_text() == "12000\n"
