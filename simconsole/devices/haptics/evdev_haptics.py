"""Force through Linux' evdev itself: the second way to the motor, where SDL does not reach it.

Layout and numbers: linux/input.h (`struct ff_effect`, `struct input_event` of 64-bit machines) and
Documentation/input/ff.rst. The kernel erases a process's effects when it closes the device, however it ends.
"""

import os
import struct
import sys
from typing import Final

from simconsole.devices.force_feedback.motor import EFFECT_S, Capability, HapticPort, NoHaptics
from simconsole.devices.sources.event_nodes import EV_FF, EVENT, READ, WRITE, open_node, request
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError

_CONSTANT: Final = 0x52
_DAMPER: Final = 0x55
_GAIN: Final = 0x60
_AUTOCENTRE: Final = 0x61
_STEERING: Final = 0x4000  # direction "left", SDL's STEERING_AXIS
_LENGTH_MS: Final = round(EFFECT_S * 1000.0)
_FULL: Final = 0x7FFF
_WHOLE: Final = 0xFFFF
_EFFECT_BYTES: Final = 48
_FF_BYTES: Final = 16  # of the capability mask: FF_MAX is 0x7f
_HEAD: Final = struct.Struct("<HhHHHHH")  # type, id, direction, trigger button and interval, length, delay
_UNION_AT: Final = 16
_LEVEL: Final = struct.Struct("<h")
_CONDITION: Final = struct.Struct("<HHhhHh")  # saturations, coefficients, dead band, centre
_UPLOAD: Final = request(WRITE, 0x80, _EFFECT_BYTES)
_REMOVE: Final = request(WRITE, 0x81, 4)
_ABLE: Final = request(READ, 0x20 + EV_FF, _FF_BYTES)


def open_evdev(identity: tuple[int, int], force: ForceFeedback) -> HapticPort:
    """Open the motor of the device with this USB identity; without one the port says why there is no force."""
    try:
        return EvdevHaptics(identity, force)
    except DeviceError as error:
        return NoHaptics(str(error))


class EvdevHaptics:
    """The motor behind one event device. A `HapticPort`."""

    def __init__(self, identity: tuple[int, int], force: ForceFeedback) -> None:
        """Open it, set gain and autocentre, and leave it without force.

        Raises:
            DeviceError: no such device, it may not be written, it has no constant force, or this is no Linux.
        """
        self._force = force
        self._effects: list[int] = []
        self._descriptor: int | None = open_node(identity)
        try:
            self._prepare()
        except BaseException:
            self._shut()
            raise

    @property
    def capability(self) -> Capability:
        """What this motor can do; nothing once it is closed."""
        return self._capability if self._descriptor is not None else Capability("closed")

    def write(self, level: float) -> None:
        """Set the level of the constant effect.

        Raises:
            DeviceError: the device has gone.
        """
        self._constant(round(min(1.0, max(-1.0, level)) * _FULL), self._effects[0] if self._effects else -1)

    def start(self) -> None:
        """Start the effect and the damper, or start them again.

        Raises:
            DeviceError: the device has gone.
        """
        for effect in self._effects:
            self._event(effect, 1)

    def stop(self) -> None:
        """End everything at once.

        Raises:
            DeviceError: the device has gone.
        """
        if self._descriptor is not None:
            for effect in self._effects:
                self._event(effect, 0)

    def close(self) -> None:
        """Stop everything, take the effects away, leave gain and autocentre as the profile says."""
        if self._descriptor is None:
            return
        try:
            self.stop()
            for effect in self._effects:
                self._call(_REMOVE, effect)
            self._set(self._force.gain_after_percent, self._force.autocentre_after_percent)
        finally:
            self._shut()

    def _prepare(self) -> None:
        able = bytearray(_FF_BYTES)
        self._call(_ABLE, able)

        def can(effect: int) -> bool:
            return bool(able[effect // 8] >> effect % 8 & 1)

        self._capability = Capability("evdev", can(_CONSTANT), can(_GAIN), can(_AUTOCENTRE), can(_DAMPER))
        if not self._capability.constant:
            raise DeviceError("wheel: force feedback: value no constant force: a driver with constant force")
        self._set(self._force.gain_percent, self._force.autocentre_percent)
        self._effects.append(self._constant(0, -1))
        if self._capability.damper and self._force.device_damper > 0.0:
            self._add_damper(round(self._force.device_damper * _FULL))

    def _constant(self, level: int, number: int) -> int:
        effect = bytearray(_EFFECT_BYTES)
        _HEAD.pack_into(effect, 0, _CONSTANT, number, _STEERING, 0, 0, _LENGTH_MS, 0)
        _LEVEL.pack_into(effect, _UNION_AT, level)
        return self._upload(effect)

    def _add_damper(self, strength: int) -> None:
        """Add a damper; where the device refuses it after all, work without one: it is only comfort."""
        effect = bytearray(_EFFECT_BYTES)
        _HEAD.pack_into(effect, 0, _DAMPER, -1, _STEERING, 0, 0, _LENGTH_MS, 0)
        _CONDITION.pack_into(effect, _UNION_AT, _WHOLE, _WHOLE, strength, strength, 0, 0)
        try:
            self._effects.append(self._upload(effect))
        except DeviceError:
            return

    def _upload(self, effect: bytearray) -> int:
        """Load an effect and return its slot, which the kernel writes into it."""
        self._call(_UPLOAD, effect)
        return int(_HEAD.unpack_from(effect)[1])

    def _set(self, gain_percent: int, autocentre_percent: int) -> None:
        if self._capability.gain:
            self._event(_GAIN, gain_percent * _WHOLE // 100)
        if self._capability.autocentre:
            self._event(_AUTOCENTRE, autocentre_percent * _WHOLE // 100)

    def _event(self, code: int, value: int) -> None:
        if self._descriptor is None:
            raise _refused("closed")
        try:
            os.write(self._descriptor, EVENT.pack(0, 0, EV_FF, code, value))
        except OSError as error:
            raise _refused(error.strerror) from error

    def _call(self, number: int, argument: bytearray | int) -> None:
        if sys.platform != "linux" or self._descriptor is None:
            raise _refused("closed")
        import fcntl

        try:
            fcntl.ioctl(self._descriptor, number, argument)
        except OSError as error:
            raise _refused(error.strerror) from error

    def _shut(self) -> None:
        descriptor, self._descriptor = self._descriptor, None
        self._effects = []
        if descriptor is not None:
            os.close(descriptor)


def _refused(reason: str | None) -> DeviceError:
    return DeviceError(f"wheel: force feedback: {reason or 'refused'}: a motor that obeys")
