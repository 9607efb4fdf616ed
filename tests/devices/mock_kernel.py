"""A T500 RS behind the kernel's evdev interface, mocked by umockdev: runs a command that believes in it.

    /usr/bin/python3 mock_kernel.py LOG MOTION COMMAND...

MOTION is a recorded motion, lines of `SECONDS TYPE CODE VALUE`; `-` where nothing moves. Whoever reads the device until
it has nothing more gets one report of it, however late: the seconds are only the stamps of the events.

Runs under the system's own Python (it has umockdev's bindings) and apart from the command: the bindings answer from a
thread, and a command that waits for its own answer would never get it. Every force-feedback call becomes a line of JSON
in LOG, with the monotonic time. Written for Linux' `struct ff_effect` and `struct input_event` of 64-bit machines.
"""

import contextlib
import ctypes
import json
import os
import struct
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any, TextIO

import gi

gi.require_version("UMockdev", "1.0")
from gi.repository import UMockdev  # noqa: E402  # the version must be asked for first

NODE = "/dev/input/event5"
PARENT = "/devices/pci0000:00/usb1/1-1/1-1:1.0/input/input5"
DEVICE = f"""P: {PARENT}
E: SUBSYSTEM=input
E: PRODUCT=3/44f/b65e/111
E: NAME="Thrustmaster TRS Racing wheel"
E: ID_INPUT=1
E: ID_INPUT_JOYSTICK=1
A: range=900

P: {PARENT}/event5
N: input/event5
E: DEVNAME={NODE}
E: MAJOR=13
E: MINOR=69
E: SUBSYSTEM=input
E: ID_INPUT=1
E: ID_INPUT_JOYSTICK=1
E: ID_VENDOR_ID=044f
E: ID_MODEL_ID=b65e

"""
NAME = b"Thrustmaster TRS Racing wheel\0"
ABS_X, ABS_Y, ABS_RZ, ABS_THROTTLE = 0, 1, 5, 6
AXES = {ABS_X: (32768, 0, 65535), ABS_Y: (1023, 0, 1023), ABS_RZ: (1023, 0, 1023), ABS_THROTTLE: (1023, 0, 1023)}
FUZZ_FLAT = {ABS_X: (255, 128)}
HATS = {0x10: (0, -1, 1), 0x11: (0, -1, 1)}
BUTTONS = range(288, 301)
EV_KEY, EV_ABS, EV_FF = 1, 3, 0x15
FF_CONSTANT, FF_DAMPER, FF_GAIN, FF_AUTOCENTER = 0x52, 0x55, 0x60, 0x61
SLOTS = 15
PR_SET_CHILD_SUBREAPER = 36


def bits(numbers: Any, size: int) -> bytes:
    mask = bytearray(size)
    for number in numbers:
        if number // 8 < size:
            mask[number // 8] |= 1 << (number % 8)
    return bytes(mask)


class Kernel(UMockdev.IoctlBase):  # type: ignore[misc]  # its bindings have no types
    """Answers ioctls; notes what has to do with force."""

    def __init__(self, log: TextIO, motion: list[list[tuple[float, int, int, int]]]) -> None:
        super().__init__()
        self.log = log
        self.motion = motion
        self.turn = True
        self.lock = threading.Lock()
        self.effects: dict[int, int] = {}

    def note(self, what: str, **facts: Any) -> None:
        with self.lock:
            self.log.write(json.dumps({"what": what, "t_ns": time.monotonic_ns(), **facts}) + "\n")
            self.log.flush()

    def do_handle_ioctl(self, client: Any) -> bool:
        request = client.get_request()
        kind, number, size = request >> 8 & 0xFF, request & 0xFF, request >> 16 & 0x3FFF
        if kind != ord("E"):
            client.complete(-1, 25)  # ENOTTY
            return True
        if number == 0x81:  # EVIOCRMFF takes its argument by value
            slot = struct.unpack("<q", bytes(client.get_arg().retrieve()[:8]))[0] if client.get_arg() else 0
            self.effects.pop(slot, None)
            self.note("remove", id=slot)
            client.complete(0, 0)
            return True
        place = client.get_arg().resolve(0, size)
        if number == 0x80:
            self.upload(place)
            client.complete(0, 0)
            return True
        answer = self.answer(number, size)
        if answer is None:
            client.complete(-1, 22)  # EINVAL
            return True
        place.update(0, answer[:size].ljust(size, b"\0"))
        client.complete(min(len(answer), size), 0)
        return True

    def upload(self, place: Any) -> None:
        effect = bytearray(place.retrieve()[:48])
        kind, slot, direction = struct.unpack_from("<HhH", effect, 0)
        (length,) = struct.unpack_from("<H", effect, 10)
        (level,) = struct.unpack_from("<h", effect, 16)
        new = slot == -1
        if new:
            slot = next(free for free in range(SLOTS) if free not in self.effects)
            place.update(2, struct.pack("<h", slot))
        self.effects[slot] = kind
        self.note("upload", type=kind, id=slot, direction=direction, length_ms=length, level=level, new=new)

    def answer(self, number: int, size: int) -> bytes | None:
        if number == 0x01:
            return struct.pack("<i", 0x010001)
        if number == 0x02:
            return struct.pack("<4H", 3, 0x044F, 0xB65E, 0x0111)
        if number == 0x06:
            return NAME
        if number in (0x07, 0x08, 0x09):
            return bytes(size) if number == 0x09 else None
        if number in (0x18, 0x19, 0x1A, 0x1B):
            return bytes(size)
        if number == 0x84:
            return struct.pack("<i", SLOTS)
        if 0x20 <= number < 0x40:
            return {
                0: bits([0, EV_KEY, EV_ABS, EV_FF], size),
                EV_KEY: bits(BUTTONS, size),
                EV_ABS: bits([*AXES, *HATS], size),
                EV_FF: bits([FF_CONSTANT, FF_DAMPER, FF_GAIN, FF_AUTOCENTER], size),
            }.get(number - 0x20, bytes(size))
        if 0x40 <= number < 0x80:
            axis = {**AXES, **HATS}.get(number - 0x40)
            return None if axis is None else struct.pack("<6i", *axis, *FUZZ_FLAT.get(number - 0x40, (0, 0)), 0)
        return None

    def do_handle_read(self, client: Any) -> bool:
        self.turn = not self.turn
        if self.turn or not self.motion:
            client.complete(-1, 11)  # EAGAIN: nothing more for now
            return True
        report, self.motion = self.motion[0], self.motion[1:]
        data = b"".join(struct.pack("<qqHHi", int(at_s), round(at_s % 1.0 * 1e6), *event) for at_s, *event in report)
        client.get_arg().update(0, data)
        client.complete(len(data), 0)
        return True

    def do_handle_write(self, client: Any) -> bool:
        data = bytes(client.get_arg().retrieve())
        for at in range(0, len(data) - 23, 24):
            kind, code, value = struct.unpack_from("<HHi", data, at + 16)
            if kind == EV_FF:
                name = {FF_GAIN: "gain", FF_AUTOCENTER: "autocentre"}.get(code, "play")
                self.note(name, id=code, value=value)
        client.complete(len(data), 0)
        return True


def recorded(path: Path) -> list[list[tuple[float, int, int, int]]]:
    """Return the reports of a recorded motion; each ends with its SYN_REPORT."""
    reports: list[list[tuple[float, int, int, int]]] = [[]]
    for line in path.read_text().splitlines():
        if line and not line.startswith("#"):
            at_s, kind, code, value = line.split()
            reports[-1].append((float(at_s), int(kind), int(code), int(value)))
            if kind == "0":
                reports.append([])
    return reports[:-1]


def main() -> int:
    log_path, motion_path, *command = sys.argv[1:]
    motion = [] if motion_path == "-" else recorded(Path(motion_path))
    with Path(log_path).open("w") as log:
        testbed = UMockdev.Testbed.new()
        testbed.add_from_string(DEVICE)
        kernel = Kernel(log, motion)
        testbed.attach_ioctl(NODE, kernel)
        environment = {
            **os.environ,
            "UMOCKDEV_DIR": testbed.get_root_dir(),
            "LD_PRELOAD": "libumockdev-preload.so.0",
        }
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)
        child = subprocess.Popen(command, env=environment)
        code = child.wait()
        with contextlib.suppress(ChildProcessError):
            while True:
                os.wait()  # a watchdog outlives its killed console, and this kernel them both
        kernel.note("end", code=code)
    return int(code) if code >= 0 else 128 - code


if __name__ == "__main__":
    sys.exit(main())
