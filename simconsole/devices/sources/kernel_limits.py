"""How the kernel and the wheel's driver alter a reading before SDL sees it, read where that is permitted.

Fuzz and flat of an axis: Documentation/input/input-programming.rst (a T300 was seen with 255 of 65535, hid-tmff2#30).
The steering range: the file `range` of the wheel's driver (hid-tmff2, new-lg4ff), to which the axis is scaled.
"""

import os
import struct
import sys
from pathlib import Path
from typing import Final, NamedTuple

from simconsole.devices.sources.event_nodes import READ, find_node, request
from simconsole.profiles.device import CockpitProfile
from simconsole.values.errors import DeviceError

SYSFS: Final = Path("/sys/class/input")
RANGE_TOLERANCE_DEG: Final = 1.0
_EV_ABS: Final = 3
_ABS_BYTES: Final = 8
_HATS: Final = range(0x10, 0x18)  # SDL has them apart from its axes
_ABSINFO: Final = struct.Struct("<6i")  # value, minimum, maximum, fuzz, flat, resolution


class AxisLimits(NamedTuple):
    """One axis, by SDL's number."""

    axis: int
    minimum: int
    maximum: int
    fuzz: int
    flat: int


class KernelLimits(NamedTuple):
    """One device. `refused` says why nothing could be read."""

    axes: tuple[AxisLimits, ...] = ()
    range_deg: float | None = None
    node: str = ""
    refused: str = ""


def wheel_limits(cockpit: CockpitProfile) -> KernelLimits:
    """Return what the kernel says of the wheel of a cockpit. Never raises."""
    found = [(role.vendor_id, role.product_id) for role in cockpit.roles if role.role == "wheel"]
    return read_limits(found[0]) if found else KernelLimits(refused=f"{cockpit.title} names no devices")


def read_limits(identity: tuple[int, int]) -> KernelLimits:
    """Return what the kernel says of the device with this USB vendor and product id. Never raises."""
    try:
        node, descriptor = find_node(identity, writable=False)
    except DeviceError as error:
        return KernelLimits(refused=str(error))
    try:
        return KernelLimits(_axes(descriptor), steering_range_deg(node.name), str(node))
    except OSError as error:
        return KernelLimits(refused=f"wheel: event device: {error.strerror}")
    finally:
        os.close(descriptor)


def steering_range_deg(node_name: str) -> float | None:
    """Return the range that the driver of an event device is set to in deg; None where it does not say."""
    place = (SYSFS / node_name).resolve()
    for folder in place.parents[:4]:  # the event's own folder lies in that of its input, and this in the driver's
        try:
            return float((folder / "range").read_text("ascii"))
        except (OSError, ValueError):
            continue
    return None


def problems(limits: KernelLimits, cockpit: CockpitProfile) -> list[str]:
    """Return what would steer the car wrong, one line each."""
    said, set_to = cockpit.wheel.lock_to_lock_deg, limits.range_deg
    if set_to is None or abs(set_to - said) <= RANGE_TOLERANCE_DEG:
        return []
    return [f"wheel.lock_to_lock_deg: value {said:g}: {set_to:g}, what the wheel's driver is set to"]


def notes(limits: KernelLimits) -> list[str]:
    """Return what a person should know, one line each: dead zones of the kernel, or that they could not be read."""
    if limits.refused:
        return [f"the kernel's dead zone and the wheel's range could not be read: {limits.refused}"]
    found = []
    for axis in limits.axes:
        if axis.fuzz or axis.flat:
            span = max(1, axis.maximum - axis.minimum)
            found.append(
                f"axis {axis.axis}: the kernel smooths {axis.fuzz / span:.2%} and calls {axis.flat / span:.2%} its "
                f"centre; without: evdev-joystick --evdev {limits.node} --axis {axis.axis} --fuzz 0 --deadzone 0"
            )
    if limits.range_deg is None:
        found.append("the wheel's driver does not tell its range; compare the angle shown with the wheel")
    return found


def _axes(descriptor: int) -> tuple[AxisLimits, ...]:
    if sys.platform != "linux":
        return ()
    import fcntl

    present = bytearray(_ABS_BYTES)
    fcntl.ioctl(descriptor, request(READ, 0x20 + _EV_ABS, _ABS_BYTES), present)
    codes = [code for code in range(8 * _ABS_BYTES) if present[code // 8] >> code % 8 & 1 and code not in _HATS]
    found = []
    for axis, code in enumerate(codes):  # SDL counts them in this order
        info = bytearray(_ABSINFO.size)
        fcntl.ioctl(descriptor, request(READ, 0x40 + code, _ABSINFO.size), info)
        _, minimum, maximum, fuzz, flat, _ = _ABSINFO.unpack(info)
        found.append(AxisLimits(axis, minimum, maximum, fuzz, flat))
    return tuple(found)
