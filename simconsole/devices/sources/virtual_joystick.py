"""Virtual joysticks inside SDL: the real ids, names, axes and polarity, with no hardware. All ctypes for them is here.

SDL's virtual joysticks appear to pygame as any other. They live in the one copy of SDL that pygame has loaded.
Values take effect at the next pump of the event queue.
"""

import ctypes
from functools import cache
from typing import Any, Final, NamedTuple

from simconsole.devices.sources import sdl_runtime, usb_places
from simconsole.devices.sources.sdl_library import loaded_sdl
from simconsole.profiles.device import CockpitProfile, DeviceKey
from simconsole.profiles.parts.axes import PedalAxis
from simconsole.values.errors import DeviceError

_WHEEL_TYPE: Final = 2
_UNKNOWN_TYPE: Final = 0
_DESC_VERSION: Final = 1


class VirtualSpec(NamedTuple):
    """What a virtual device claims to be."""

    name: str
    vendor_id: int
    product_id: int
    axes: int
    buttons: int
    hats: int = 0
    rest: tuple[float, ...] = ()  # raw axes before anybody touches it; 0 where left out
    is_wheel: bool = True
    port: str = ""  # where it claims to be plugged in

    @property
    def key(self) -> DeviceKey:
        """The device."""
        return DeviceKey(self.vendor_id, self.product_id, self.port)


class _Desc(ctypes.Structure):
    """SDL_VirtualJoystickDesc of SDL 2.24 and later (SDL_joystick.h), 88 bytes on 64-bit machines."""

    _fields_ = (
        ("version", ctypes.c_uint16),
        ("type", ctypes.c_uint16),
        ("naxes", ctypes.c_uint16),
        ("nbuttons", ctypes.c_uint16),
        ("nhats", ctypes.c_uint16),
        ("vendor_id", ctypes.c_uint16),
        ("product_id", ctypes.c_uint16),
        ("padding", ctypes.c_uint16),
        ("button_mask", ctypes.c_uint32),
        ("axis_mask", ctypes.c_uint32),
        ("name", ctypes.c_char_p),
        ("userdata", ctypes.c_void_p),
        ("update", ctypes.c_void_p),
        ("set_player_index", ctypes.c_void_p),
        ("rumble", ctypes.c_void_p),
        ("rumble_triggers", ctypes.c_void_p),
        ("set_led", ctypes.c_void_p),
        ("send_effect", ctypes.c_void_p),
    )


def specs(profile: CockpitProfile) -> list[VirtualSpec]:
    """Return one virtual device per physical device of the profile, pedals at their rest."""
    made: dict[DeviceKey, VirtualSpec] = {}
    for binding in profile.roles:
        key = binding.key
        rest = list(made[key].rest) if key in made else [0.0] * binding.axes
        for name in ("throttle", "brake", "clutch", "handbrake"):
            pedal: PedalAxis | None = getattr(profile.pedals, name)
            if pedal is not None and profile.played_by(name) == binding.role:
                rest[pedal.axis] = pedal.rest_raw
        is_wheel = binding.role == "wheel" or (key in made and made[key].is_wheel)
        made[key] = VirtualSpec(
            name=binding.name,
            vendor_id=binding.vendor_id,
            product_id=binding.product_id,
            axes=binding.axes,
            buttons=binding.buttons,
            hats=binding.hats,
            rest=tuple(rest),
            is_wheel=is_wheel,
            port=binding.port,
        )
    return list(made.values())


class VirtualDevice:
    """One plugged-in virtual joystick. `detach` pulls its plug; `close` does the same quietly."""

    def __init__(self, spec: VirtualSpec) -> None:
        """Plug it in, at rest, before anyone else can open it.

        Raises:
            DeviceError: this SDL has no virtual joysticks.
        """
        self.spec = spec
        self._pygame = sdl_runtime.acquire()
        try:
            self._sdl = _library()
            self._desc = _Desc(
                version=_DESC_VERSION,
                type=_WHEEL_TYPE if spec.is_wheel else _UNKNOWN_TYPE,
                naxes=spec.axes,
                nbuttons=spec.buttons,
                nhats=spec.hats,
                vendor_id=spec.vendor_id,
                product_id=spec.product_id,
                name=spec.name.encode(),
            )
            index = self._sdl.SDL_JoystickAttachVirtualEx(ctypes.byref(self._desc))
            if index < 0:
                raise self._refused()
            self._joystick = self._sdl.SDL_JoystickOpen(index)
            if not self._joystick:
                raise self._refused()
        except BaseException:
            sdl_runtime.release()
            raise
        self._plugged = True
        self.instance_id = int(self._sdl.SDL_JoystickInstanceID(self._joystick))
        usb_places.VIRTUAL[self.instance_id] = usb_places.UsbPlace(spec.port)
        for axis, value in enumerate(spec.rest):
            self.set_axis(axis, value)
        self._sdl.SDL_JoystickUpdate()

    def set_axis(self, axis: int, value: float) -> None:
        """Move an axis to `value`, -1 to 1; seen after the next pump.

        Raises:
            DeviceError: there is no such axis, or it is unplugged.
        """
        raw = min(32767, max(-32768, round(value * 32768.0)))
        self._done(self._sdl.SDL_JoystickSetVirtualAxis(self._plug(), axis, raw))

    def set_button(self, button: int, pressed: bool) -> None:
        """Press or release a button; both between two pumps are lost.

        Raises:
            DeviceError: there is no such button, or it is unplugged.
        """
        self._done(self._sdl.SDL_JoystickSetVirtualButton(self._plug(), button, int(pressed)))

    def set_buttons(self, mask: int) -> None:
        """Press exactly the buttons of a mask.

        Raises:
            DeviceError: it is unplugged.
        """
        for button in range(self.spec.buttons):
            self.set_button(button, bool(mask >> button & 1))

    def set_hat(self, hat: int, x: int, y: int) -> None:
        """Move a hat: x right-positive, y up-positive, each -1, 0 or 1.

        Raises:
            DeviceError: there is no such hat, or it is unplugged.
        """
        value = (1 if y > 0 else 4 if y < 0 else 0) | (2 if x > 0 else 8 if x < 0 else 0)
        self._done(self._sdl.SDL_JoystickSetVirtualHat(self._plug(), hat, value))

    def detach(self) -> None:
        """Pull the plug: SDL centres every axis, then tells that the device is gone. Twice is harmless."""
        if not self._plugged:
            return
        self._plugged = False
        for index in range(self._sdl.SDL_NumJoysticks()):
            if self._sdl.SDL_JoystickGetDeviceInstanceID(index) == self.instance_id:
                self._sdl.SDL_JoystickDetachVirtual(index)
                break
        self._sdl.SDL_JoystickClose(self._joystick)
        usb_places.VIRTUAL.pop(self.instance_id, None)
        sdl_runtime.release()

    close = detach

    def _plug(self) -> Any:
        if not self._plugged:
            raise DeviceError(f"{self.spec.name}: virtual device: value unplugged: plugged in")
        return self._joystick

    def _done(self, result: int) -> None:
        if result != 0:
            raise self._refused()

    def _refused(self) -> DeviceError:
        reason = self._sdl.SDL_GetError().decode(errors="replace")
        return DeviceError(f"{self.spec.name}: virtual device: {reason}: an SDL 2 with virtual joysticks")


@cache
def _library() -> Any:
    path = loaded_sdl()
    library = ctypes.CDLL(path)
    joystick, integer, text = ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p
    for name, result, arguments in (
        ("SDL_JoystickAttachVirtualEx", integer, (ctypes.POINTER(_Desc),)),
        ("SDL_JoystickDetachVirtual", integer, (integer,)),
        ("SDL_JoystickOpen", joystick, (integer,)),
        ("SDL_JoystickClose", None, (joystick,)),
        ("SDL_JoystickInstanceID", ctypes.c_int32, (joystick,)),
        ("SDL_JoystickGetDeviceInstanceID", ctypes.c_int32, (integer,)),
        ("SDL_NumJoysticks", integer, ()),
        ("SDL_JoystickUpdate", None, ()),
        ("SDL_JoystickSetVirtualAxis", integer, (joystick, integer, ctypes.c_int16)),
        ("SDL_JoystickSetVirtualButton", integer, (joystick, integer, ctypes.c_uint8)),
        ("SDL_JoystickSetVirtualHat", integer, (joystick, integer, ctypes.c_uint8)),
        ("SDL_GetError", text, ()),
    ):
        function = getattr(library, name, None)
        if function is None:
            raise DeviceError(f"{path}: {name}: value missing: SDL 2.24 or later of the 2 line")
        function.restype = result
        function.argtypes = arguments
    return library
