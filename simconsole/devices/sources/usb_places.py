"""Where an input device is plugged in and which one of its kind it is: what Linux tells everyone in sysfs."""

from pathlib import Path
from typing import Final, NamedTuple

SYSFS: Final = Path("/sys/class/input")


class UsbPlace(NamedTuple):
    """Port (as "usb-0000:00:14.0-2/input0") and serial number of a device; empty where the system does not tell."""

    port: str = ""
    serial: str = ""


def place_of(usb_id: tuple[int, int]) -> UsbPlace:
    """Return where the device with this vendor and product id is. Never raises.

    Of two of one kind nothing is said: which of them SDL has opened cannot be known.
    """
    try:
        nodes = sorted(node for node in SYSFS.iterdir() if node.name.startswith("event"))
    except OSError:
        return UsbPlace()
    wanted = tuple(f"{number:04x}" for number in usb_id)
    places = {
        UsbPlace(_word(node, "phys"), _word(node, "uniq"))
        for node in nodes
        if (_word(node, "id/vendor"), _word(node, "id/product")) == wanted
    }
    return places.pop() if len(places) == 1 else UsbPlace()


def _word(node: Path, name: str) -> str:
    try:
        return (node / "device" / name).read_text("utf-8").strip()
    except (OSError, UnicodeDecodeError):
        return ""
