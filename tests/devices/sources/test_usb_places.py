from pathlib import Path

import pytest

from simconsole.devices.sources import usb_places
from simconsole.devices.sources.usb_places import UsbPlace, place_of

WHEEL = (0x044F, 0xB65E)


def device(sysfs: Path, node: str, usb_id: str, **words: str) -> None:
    folder = sysfs / node / "device"
    (folder / "id").mkdir(parents=True)
    vendor, product = usb_id.split(":")
    (folder / "id" / "vendor").write_text(f"{vendor}\n")
    (folder / "id" / "product").write_text(f"{product}\n")
    for name, text in words.items():
        (folder / name).write_text(f"{text}\n")


@pytest.fixture
def sysfs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(usb_places, "SYSFS", tmp_path)
    device(tmp_path, "event0", "046d:c31c", phys="usb-0000:00:14.0-1/input0", uniq="")
    device(tmp_path, "event5", "044f:b65e", phys="usb-0000:00:14.0-2/input0", uniq="A1B2")
    return tmp_path


def test_port_and_serial_number_are_read(sysfs: Path) -> None:
    assert place_of(WHEEL) == UsbPlace("usb-0000:00:14.0-2/input0", "A1B2")
    assert place_of((0x046D, 0xC31C)) == UsbPlace("usb-0000:00:14.0-1/input0", "")


def test_of_two_of_one_kind_nothing_is_said(sysfs: Path) -> None:
    device(sysfs, "event6", "044f:b65e", phys="usb-0000:00:14.0-3/input0", uniq="C3D4")
    assert place_of(WHEEL) == UsbPlace()


def test_what_the_system_does_not_tell_is_empty(sysfs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert place_of((0x1234, 0x5678)) == UsbPlace()
    device(sysfs, "event7", "1234:5678")
    assert place_of((0x1234, 0x5678)) == UsbPlace()
    monkeypatch.setattr(usb_places, "SYSFS", sysfs / "none")
    assert place_of(WHEEL) == UsbPlace()
