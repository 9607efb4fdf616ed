"""Force through SDL's haptics, by ctypes on the one SDL that pygame has loaded. All ctypes of SDL's haptics is here.

One constant effect of 200 ms in the direction of the steering axis, its level rewritten in place; the device's own
damper where there is one. SDL_HapticOpenFromJoystick sets neither gain nor autocentre, so that both are set here and
left as the profile wants them afterwards (SDL can write them, not read them).
"""

import ctypes
from functools import cache
from typing import Any, Final

from simconsole.devices.force_feedback.motor import EFFECT_S, Capability, HapticPort, NoHaptics
from simconsole.devices.sources import sdl_runtime
from simconsole.devices.sources.sdl_library import loaded_sdl
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError

_INIT_HAPTIC: Final = 0x1000
_CONSTANT: Final = 1 << 0
_DAMPER: Final = 1 << 8
_GAIN: Final = 1 << 12
_AUTOCENTRE: Final = 1 << 13
_STEERING_AXIS: Final = 3
_LENGTH_MS: Final = round(EFFECT_S * 1000.0)
_FULL: Final = 0x7FFF


class _Direction(ctypes.Structure):
    _fields_ = (("type", ctypes.c_uint8), ("dir", ctypes.c_int32 * 3))


class _Constant(ctypes.Structure):
    """SDL_HapticConstant."""

    _fields_ = (
        ("type", ctypes.c_uint16),
        ("direction", _Direction),
        ("length", ctypes.c_uint32),
        ("delay", ctypes.c_uint16),
        ("button", ctypes.c_uint16),
        ("interval", ctypes.c_uint16),
        ("level", ctypes.c_int16),
        ("attack_length", ctypes.c_uint16),
        ("attack_level", ctypes.c_uint16),
        ("fade_length", ctypes.c_uint16),
        ("fade_level", ctypes.c_uint16),
    )


class _Condition(ctypes.Structure):
    """SDL_HapticCondition: spring, damper, inertia, friction."""

    _fields_ = (
        ("type", ctypes.c_uint16),
        ("direction", _Direction),
        ("length", ctypes.c_uint32),
        ("delay", ctypes.c_uint16),
        ("button", ctypes.c_uint16),
        ("interval", ctypes.c_uint16),
        ("right_sat", ctypes.c_uint16 * 3),
        ("left_sat", ctypes.c_uint16 * 3),
        ("right_coeff", ctypes.c_int16 * 3),
        ("left_coeff", ctypes.c_int16 * 3),
        ("deadband", ctypes.c_uint16 * 3),
        ("center", ctypes.c_int16 * 3),
    )


class _Effect(ctypes.Union):
    """SDL_HapticEffect: as large as its largest member, the condition, in 8-byte words."""

    _fields_ = (
        ("type", ctypes.c_uint16),
        ("constant", _Constant),
        ("condition", _Condition),
        ("words", ctypes.c_uint64 * 9),
    )


def open_haptics(instance_id: int, force: ForceFeedback) -> HapticPort:
    """Open the motor of a joystick; a joystick without one gives `NoHaptics`, which says why.

    Args:
        instance_id: SDL's, of a joystick that is open.
        force: The cockpit's.
    """
    try:
        return SdlHaptics(instance_id, force)
    except DeviceError as error:
        return NoHaptics(str(error))


class SdlHaptics:
    """The motor of one joystick. A `HapticPort`."""

    def __init__(self, instance_id: int, force: ForceFeedback) -> None:
        """Open it, stop whatever runs, set gain and autocentre, and leave it without force.

        Raises:
            DeviceError: the joystick is gone or has no constant force.
        """
        self._force = force
        self._open = False
        self._constant = -1
        self._effects: list[int] = []
        sdl_runtime.acquire()
        try:
            self._sdl = _library()
            self._begin(instance_id)
        except BaseException:
            sdl_runtime.release()
            raise

    @property
    def capability(self) -> Capability:
        """What this motor can do; nothing once it is closed."""
        return self._capability if self._open else Capability("closed")

    def write(self, level: float) -> None:
        """Set the level of the constant effect.

        Raises:
            DeviceError: the device has gone.
        """
        self._need_open()
        self._effect.constant.level = round(min(1.0, max(-1.0, level)) * _FULL)
        self._done(self._sdl.SDL_HapticUpdateEffect(self._haptic, self._constant, ctypes.byref(self._effect)))

    def start(self) -> None:
        """Start the effect and the damper, or start them again.

        Raises:
            DeviceError: the device has gone.
        """
        self._need_open()
        for effect in self._effects:
            self._done(self._sdl.SDL_HapticRunEffect(self._haptic, effect, 1))

    def stop(self) -> None:
        """End everything at once.

        Raises:
            DeviceError: the device has gone.
        """
        if self._open:
            for effect in self._effects:
                self._done(self._sdl.SDL_HapticStopEffect(self._haptic, effect))

    def close(self) -> None:
        """Stop everything, take the effects away, leave gain and autocentre as the profile says."""
        if not self._open:
            return
        self._open = False
        sdl, haptic = self._sdl, self._haptic
        sdl.SDL_HapticStopAll(haptic)
        for effect in self._effects:
            sdl.SDL_HapticDestroyEffect(haptic, effect)
        self._set(self._force.gain_after_percent, self._force.autocentre_after_percent)
        sdl.SDL_HapticClose(haptic)
        sdl.SDL_QuitSubSystem(_INIT_HAPTIC)
        sdl_runtime.release()

    def _begin(self, instance_id: int) -> None:
        sdl = self._sdl
        self._done(sdl.SDL_InitSubSystem(_INIT_HAPTIC))
        try:
            joystick = sdl.SDL_JoystickFromInstanceID(instance_id)
            if not joystick or sdl.SDL_JoystickIsHaptic(joystick) != 1:
                raise DeviceError("wheel: force feedback: value none: a driver with force feedback")
            self._haptic = sdl.SDL_HapticOpenFromJoystick(joystick)
            if not self._haptic:
                raise self._refused()
            self._prepare()
        except BaseException:
            sdl.SDL_QuitSubSystem(_INIT_HAPTIC)
            raise

    def _prepare(self) -> None:
        sdl, haptic = self._sdl, self._haptic
        able = int(sdl.SDL_HapticQuery(haptic))
        self._capability = Capability(
            "SDL", bool(able & _CONSTANT), bool(able & _GAIN), bool(able & _AUTOCENTRE), bool(able & _DAMPER)
        )
        try:
            if not self._capability.constant:
                raise DeviceError("wheel: force feedback: value no constant force: a driver with constant force")
            sdl.SDL_HapticStopAll(haptic)  # whatever another program left running
            self._set(self._force.gain_percent, self._force.autocentre_percent)
            self._effect = _Effect()
            self._effect.constant.type = _CONSTANT
            self._effect.constant.direction.type = _STEERING_AXIS
            self._effect.constant.length = _LENGTH_MS
            self._constant = sdl.SDL_HapticNewEffect(haptic, ctypes.byref(self._effect))
            if self._constant < 0:
                raise self._refused()
            self._effects.append(self._constant)
            if self._capability.damper and self._force.device_damper > 0.0:
                self._add_damper(round(self._force.device_damper * _FULL))
        except BaseException:
            sdl.SDL_HapticClose(haptic)
            raise
        self._open = True

    def _add_damper(self, strength: int) -> None:
        """Add a damper; where the device refuses it after all, work without one: it is only comfort."""
        effect = _Effect()
        damper = effect.condition
        damper.type, damper.length, damper.direction.type = _DAMPER, _LENGTH_MS, _STEERING_AXIS
        damper.right_sat[0] = damper.left_sat[0] = 2 * _FULL
        damper.right_coeff[0] = damper.left_coeff[0] = strength
        number = int(self._sdl.SDL_HapticNewEffect(self._haptic, ctypes.byref(effect)))
        if number >= 0:
            self._effects.append(number)

    def _set(self, gain_percent: int, autocentre_percent: int) -> None:
        if self._capability.gain:
            self._sdl.SDL_HapticSetGain(self._haptic, gain_percent)
        if self._capability.autocentre:
            self._sdl.SDL_HapticSetAutocenter(self._haptic, autocentre_percent)

    def _need_open(self) -> None:
        if not self._open:
            raise DeviceError("wheel: force feedback: value closed: an open motor")

    def _done(self, result: int) -> None:
        if result < 0:
            raise self._refused()

    def _refused(self) -> DeviceError:
        reason = self._sdl.SDL_GetError().decode(errors="replace")
        return DeviceError(f"wheel: force feedback: {reason}: a motor that obeys")


@cache
def _library() -> Any:
    path = loaded_sdl()
    library = ctypes.CDLL(path)
    pointer, integer, effect = ctypes.c_void_p, ctypes.c_int, ctypes.POINTER(_Effect)
    for name, result, arguments in (
        ("SDL_InitSubSystem", integer, (ctypes.c_uint32,)),
        ("SDL_QuitSubSystem", None, (ctypes.c_uint32,)),
        ("SDL_JoystickFromInstanceID", pointer, (ctypes.c_int32,)),
        ("SDL_JoystickIsHaptic", integer, (pointer,)),
        ("SDL_HapticOpenFromJoystick", pointer, (pointer,)),
        ("SDL_HapticClose", None, (pointer,)),
        ("SDL_HapticQuery", ctypes.c_uint, (pointer,)),
        ("SDL_HapticNewEffect", integer, (pointer, effect)),
        ("SDL_HapticUpdateEffect", integer, (pointer, integer, effect)),
        ("SDL_HapticRunEffect", integer, (pointer, integer, ctypes.c_uint32)),
        ("SDL_HapticStopEffect", integer, (pointer, integer)),
        ("SDL_HapticDestroyEffect", None, (pointer, integer)),
        ("SDL_HapticSetGain", integer, (pointer, integer)),
        ("SDL_HapticSetAutocenter", integer, (pointer, integer)),
        ("SDL_HapticStopAll", integer, (pointer,)),
        ("SDL_GetError", ctypes.c_char_p, ()),
    ):
        function = getattr(library, name, None)
        if function is None:
            raise DeviceError(f"{path}: {name}: value missing: SDL 2 with haptics")
        function.restype = result
        function.argtypes = arguments
    return library
