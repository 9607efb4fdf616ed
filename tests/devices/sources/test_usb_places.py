from pathlib import Path

import pytest

from simconsole.devices.sources import usb_places
from simconsole.devices.sources.usb_places import UsbPlace, place_of

WHEEL = 3  # SDL's instance id


def device(folder: Path, **words: str) -> None:
    folder.mkdir(parents=True)
    for name, text in words.items():
        (folder / name).write_text(f"{text}\n")


@pytest.fixture
def paths(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[int, str]:
    """What SDL says where its joysticks are; two wheels of one kind are on event5 and event6."""
    found = {WHEEL: "/dev/input/event5"}
    monkeypatch.setattr(usb_places, "SYSFS", tmp_path)
    monkeypatch.setattr(usb_places, "joystick_path", lambda instance_id: found.get(instance_id, ""))
    device(tmp_path / "input/event5/device", phys="usb-0000:00:14.0-2/input0", uniq="A1B2")
    device(tmp_path / "input/event6/device", phys="usb-0000:00:14.0-3/input0", uniq="")
    return found


def test_port_and_serial_number_are_read_of_the_very_device(paths: dict[int, str]) -> None:
    paths[4] = "/dev/input/event6"
    assert place_of(WHEEL) == UsbPlace("usb-0000:00:14.0-2/input0", "A1B2")
    assert place_of(4) == UsbPlace("usb-0000:00:14.0-3/input0", "")


def test_devices_that_sdl_reads_raw_are_found_too(paths: dict[int, str], tmp_path: Path) -> None:
    paths[WHEEL] = "/dev/hidraw2"
    told = "HID_NAME=Some Pad\nHID_PHYS=usb-0000:00:14.0-4/input0\nHID_UNIQ=E5"
    device(tmp_path / "hidraw/hidraw2/device", uevent=told)
    assert place_of(WHEEL) == UsbPlace("usb-0000:00:14.0-4/input0", "E5")


def test_other_systems_have_the_port_in_the_path(paths: dict[int, str]) -> None:
    paths[WHEEL] = r"\\?\HID#VID_044F&PID_B65E#6&2f5d6f50&0&0000#{4d1e55b2-f16f-11cf-88cb-001111000030}"
    assert place_of(WHEEL) == UsbPlace(paths[WHEEL])


def test_what_the_system_does_not_tell_is_empty(paths: dict[int, str], tmp_path: Path) -> None:
    assert place_of(9) == UsbPlace(), "SDL says nothing"
    paths[WHEEL] = "/dev/input/event7"
    assert place_of(WHEEL) == UsbPlace(), "no such folder"
    device(tmp_path / "input/event7/device")
    assert place_of(WHEEL) == UsbPlace(), "an empty one"
