"""Where an input device is plugged in and which one of its kind it is."""

from pathlib import Path
from typing import Final, NamedTuple

from simconsole.devices.sources.sdl_library import joystick_path

SYSFS: Final = Path("/sys/class")


class UsbPlace(NamedTuple):
    """Port (as "usb-0000:00:14.0-2/input0") and serial number of a device; empty where the system does not tell."""

    port: str = ""
    serial: str = ""


VIRTUAL: Final[dict[int, UsbPlace]] = {}
"""Where virtual joysticks claim to be, by SDL's instance id: the system knows nothing of them."""


def place_of(instance_id: int) -> UsbPlace:
    """Return where the open joystick with SDL's number `instance_id` is. Never raises.

    On Linux its event device is looked up in sysfs, for its own name changes whenever it is plugged in; elsewhere the
    port is what the system calls the device.
    """
    if instance_id in VIRTUAL:
        return VIRTUAL[instance_id]
    path = joystick_path(instance_id)
    if not path.startswith("/dev/"):
        return UsbPlace(path)
    name = Path(path).name
    if name.startswith("hidraw"):
        told = dict(line.partition("=")[::2] for line in _text(SYSFS / "hidraw" / name / "device/uevent").splitlines())
        return UsbPlace(told.get("HID_PHYS", ""), told.get("HID_UNIQ", ""))
    device = SYSFS / "input" / name / "device"
    return UsbPlace(_text(device / "phys"), _text(device / "uniq"))


def _text(path: Path) -> str:
    try:
        return path.read_text("utf-8").strip()
    except (OSError, UnicodeDecodeError):
        return ""
