"""Linux' event devices, found by USB identity: the direct access of motor, watchdog and `devices check`.

Layout and numbers: linux/input.h, of 64-bit machines. Loads nothing but the standard library: the watchdog is small.
"""

import os
import struct
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from simconsole.values.errors import DeviceError

NODES: Final = Path("/dev/input")
EV_FF: Final = 0x15
EVENT: Final = struct.Struct("<qqHHi")
WRITE, READ = 1, 2


def request(direction: int, number: int, size: int) -> int:
    """Return the number of an ioctl of the input subsystem."""
    return direction << 30 | size << 16 | ord("E") << 8 | number


_IDENTITY: Final = request(READ, 0x02, 8)
_SLOTS: Final = request(READ, 0x84, 4)


def open_node(identity: tuple[int, int]) -> int:
    """Return a descriptor, to read and write, of the event device with this USB vendor and product id.

    Raises:
        DeviceError: as `find_node`.
    """
    return find_node(identity, writable=True)[1]


def find_node(identity: tuple[int, int], *, writable: bool) -> tuple[Path, int]:
    """Return the event device with this USB vendor and product id, and a descriptor of it.

    Raises:
        DeviceError: no such device, it may not be opened, or this is no Linux.
    """
    if sys.platform != "linux":
        raise DeviceError("wheel: event device: value none: Linux")
    import fcntl

    refused = "none"
    mode = (os.O_RDWR if writable else os.O_RDONLY) | os.O_NONBLOCK | os.O_CLOEXEC
    for node in _nodes():
        try:
            descriptor = os.open(node, mode)
        except OSError as error:
            refused = f"{node}: {error.strerror}"
            continue
        found = bytearray(8)
        try:
            fcntl.ioctl(descriptor, _IDENTITY, found)
        except OSError:
            found = bytearray(8)
        if struct.unpack("<4H", found)[1:3] == identity:
            return node, descriptor
        os.close(descriptor)
    wanted = f"{identity[0]:04x}:{identity[1]:04x}"
    may = "written" if writable else "read"
    raise DeviceError(f"wheel: event device: value {refused}: an event device {wanted} that may be {may}")


def effect_slots(descriptor: int) -> int:
    """Return how many effects a device holds. Raises OSError where it holds none."""
    if sys.platform != "linux":
        return 0
    import fcntl

    slots = bytearray(4)
    fcntl.ioctl(descriptor, _SLOTS, slots)
    return int(struct.unpack("<i", slots)[0])


def stop_effects(descriptor: int, slots: int) -> None:
    """Stop every effect of a device, whoever loaded it. Raises OSError where the device has gone.

    Only its owner may change an effect, but any process may stop it (`input_ff_event`, drivers/input/ff-core.c).
    """
    for slot in range(slots):
        os.write(descriptor, EVENT.pack(0, 0, EV_FF, slot, 0))


def _nodes() -> Iterator[Path]:
    try:
        yield from sorted(path for path in NODES.iterdir() if path.name.startswith("event"))
    except OSError:
        return
