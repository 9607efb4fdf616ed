"""A profile's cockpit made of virtual devices: written in raw terms, read back by pygame as any other."""

from typing import Literal

from simconsole.devices.calibration.cockpit_settings import button_bits
from simconsole.devices.sources.virtual_joystick import VirtualDevice, VirtualSpec, specs
from simconsole.profiles.device import CockpitProfile, DeviceKey, RoleName
from simconsole.values.errors import DeviceError
from simconsole.values.signals import DeviceSample


class VirtualCockpit:
    """All devices of a profile, plugged in. Only what changed is written."""

    def __init__(self, profile: CockpitProfile, *, reverse_order: bool = False) -> None:
        """Plug every device in.

        Args:
            profile: The cockpit to be.
            reverse_order: Plug the last one in first, as another boot might.

        Raises:
            DeviceError: the profile names no devices, or SDL has no virtual ones.
        """
        if not profile.roles:
            raise DeviceError(f"{profile.title}: roles: value empty: a cockpit with devices")
        self._profile = profile
        self._keys = {binding.role: binding.key for binding in profile.roles}
        self._bits = {on: button_bits(profile, on) for on in ("wheel", "shifter")}
        self._specs = {spec.key: spec for spec in specs(profile)}
        self._devices: dict[DeviceKey, VirtualDevice] = {}
        self.plugged = 0  # number of plug-ins; each puts a device at rest, whatever was written before
        self._axes: dict[tuple[RoleName, int], float] = {}
        self._buttons: dict[RoleName, int] = {}
        self._hat = (0, 0)
        try:
            for key in sorted(self._specs, reverse=reverse_order):
                self._devices[key] = VirtualDevice(self._specs[key])
        except BaseException:
            self.close()
            raise

    def write(self, sample: DeviceSample) -> None:
        """Put axes and buttons where `sample` says. Devices that are unplugged are skipped."""
        pedals = self._profile.pedals
        self._set_axis("wheel", self._profile.wheel.axis, sample.wheel_axis)
        throttle_axis = sample.throttle_axis
        if pedals.combined:  # both feet at once pull it to both sides
            throttle_axis = min(1.0, max(-1.0, throttle_axis + sample.brake_axis - pedals.brake.rest_raw))
        else:
            self._set_axis("pedals", pedals.brake.axis, sample.brake_axis)
        self._set_axis("pedals", pedals.throttle.axis, throttle_axis)
        if pedals.clutch is not None:
            self._set_axis("pedals", pedals.clutch.axis, sample.clutch_axis)
        if pedals.handbrake is not None:
            self._set_axis(self._profile.played_by("handbrake"), pedals.handbrake.axis, sample.handbrake_axis)
        self._set_hat(int(sample.hat_x), int(sample.hat_y))
        if self._keys["wheel"] == self._keys["shifter"]:  # one device has both roles: it gets the buttons of both
            self._set_buttons("wheel", self._numbers("wheel", sample) | self._numbers("shifter", sample))
            return
        self._set_buttons("wheel", self._numbers("wheel", sample))
        self._set_buttons("shifter", self._numbers("shifter", sample))

    def unplug(self, role: RoleName) -> None:
        """Pull the plug of the device that plays this role; twice is harmless."""
        device = self._devices.pop(self._keys[role], None)
        if device is not None:
            device.detach()

    def plug(self, role: RoleName) -> None:
        """Plug it in again, at rest, as a new device; does nothing while it is plugged in."""
        key = self._keys[role]
        if key not in self._devices:
            self._forget(key)
            self._devices[key] = VirtualDevice(self._specs[key])
            self.plugged += 1

    def spec(self, role: RoleName) -> VirtualSpec:
        """Return what the device of this role claims to be."""
        return self._specs[self._keys[role]]

    def has(self, instance_id: int) -> bool:
        """Return whether the joystick of this number of SDL's is one of its devices."""
        return any(device.instance_id == instance_id for device in self._devices.values())

    def close(self) -> None:
        """Unplug everything."""
        while self._devices:
            self._devices.popitem()[1].detach()

    def _numbers(self, on: Literal["wheel", "shifter"], sample: DeviceSample) -> int:
        """Return the mask of a role's buttons by their numbers."""
        mask = int(sample.wheel_buttons if on == "wheel" else sample.shifter_buttons)
        return sum(1 << button for button, bit in self._bits[on].items() if mask >> bit & 1) if mask else 0

    def _forget(self, key: DeviceKey) -> None:
        if self._keys["wheel"] == key:
            self._hat = (0, 0)
        self._axes = {at: value for at, value in self._axes.items() if self._keys[at[0]] != key}
        self._buttons = {role: mask for role, mask in self._buttons.items() if self._keys[role] != key}

    def _set_axis(self, role: RoleName, axis: int, value: float) -> None:
        device = self._devices.get(self._keys[role])
        if device is not None and self._axes.get((role, axis)) != value:
            device.set_axis(axis, value)
            self._axes[role, axis] = value

    def _set_buttons(self, role: RoleName, mask: int) -> None:
        device = self._devices.get(self._keys[role])
        if device is not None and self._buttons.get(role) != mask:
            device.set_buttons(mask)
            self._buttons[role] = mask

    def _set_hat(self, x: int, y: int) -> None:
        device = self._devices.get(self._keys["wheel"])
        if device is not None and self._hat != (x, y) and self.spec("wheel").hats:
            device.set_hat(0, x, y)
            self._hat = (x, y)
