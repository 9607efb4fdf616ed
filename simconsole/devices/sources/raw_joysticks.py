"""Raw readings of every joystick: what the calibration wizard reads before a cockpit has a profile."""

from typing import Any, Self

from simconsole.devices.calibration.input_detection import BUTTONS, Reading
from simconsole.devices.calibration.lever import hat_mask
from simconsole.devices.sources import sdl_runtime
from simconsole.devices.sources.sdl_source import JoystickInfo, connected_joysticks
from simconsole.profiles.device import DeviceKey
from simconsole.values.errors import DeviceError


class RawJoysticks:
    """All plugged-in joysticks, read together; a context manager."""

    def __init__(self) -> None:
        """Open them all.

        Raises:
            DeviceError: there are none, or two of the same kind that nothing tells apart.
        """
        self._pygame = sdl_runtime.acquire()
        try:
            self._pygame.event.get()
            pairs = connected_joysticks(self._pygame)
            ids = [entry.key[:2] for entry, _ in pairs]
            self.entries: dict[DeviceKey, JoystickInfo] = {}
            self._joysticks: dict[DeviceKey, Any] = {}
            for entry, joystick in pairs:
                # A port counts where it has to: a device that is the only one of its kind may move to another.
                key = entry.key if ids.count(entry.key[:2]) > 1 else DeviceKey(*entry.key[:2])
                if key in self.entries:
                    raise DeviceError(
                        f"{entry.name}: value two with one id {key[0]:04x}:{key[1]:04x} and no port to tell them "
                        "apart: unplug one"
                    )
                self.entries[key], self._joysticks[key] = entry, joystick
            if not pairs:
                raise DeviceError("devices: value none connected: a wheel or a gamepad")
        except BaseException:
            sdl_runtime.release()
            raise

    def read(self) -> dict[DeviceKey, Reading]:
        """Return every device now."""
        gone = {event.instance_id for event in self._pygame.event.get() if event.type == self._pygame.JOYDEVICEREMOVED}
        readings = {}
        for key, joystick in self._joysticks.items():
            entry = self.entries[key]
            if entry.instance_id in gone:
                raise DeviceError(f"{entry.name}: value unplugged: plugged in until the end")
            axes = tuple(joystick.get_axis(axis) for axis in range(entry.axes))
            mask = sum(1 << button for button in range(min(entry.buttons, BUTTONS)) if joystick.get_button(button))
            if entry.hats:
                mask |= hat_mask(*map(float, joystick.get_hat(0))) << BUTTONS
            readings[key] = Reading(axes, mask)
        return readings

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._joysticks.clear()
        sdl_runtime.release()
