"""The real cockpit through pygame's joysticks: roles bound by USB identity, whatever is plugged in when and where.

State is read, not events: SDL's first events are zeros, and an axis that never moved sends none. A batch of events
is taken as a whole, because SDL centres all axes *before* it tells that a device is gone (SDL#3616), which on pedals
that rest at 1.0 reads as half throttle and half brake.
"""

from collections.abc import Callable
from typing import Any, Final, NamedTuple

from simconsole.devices.calibration.calibrator import travel
from simconsole.devices.calibration.cockpit_settings import button_bits
from simconsole.devices.sources import sdl_runtime
from simconsole.devices.sources.usb_places import place_of
from simconsole.profiles.device import CockpitProfile, DeviceKey, OtherDevice, RoleBinding, RoleName
from simconsole.values.errors import DeviceError, DeviceModeError, DeviceNotFound
from simconsole.values.protocols import DeviceIdentity
from simconsole.values.signals import NEVER_TICKS, DeviceSample

INVERTED_SHARE: Final = 0.95
"""An accelerator beyond this at the start: nobody presses it then, so the profile has its ends swapped.

Brake and clutch are no evidence: people start with a foot on either.
"""


class JoystickInfo(NamedTuple):
    """A joystick that is plugged in."""

    vendor_id: int
    product_id: int
    name: str
    instance_id: int
    axes: int
    buttons: int
    hats: int
    port: str = ""  # where it is plugged in, empty where the system does not tell
    serial: str = ""

    @property
    def key(self) -> DeviceKey:
        """This very device."""
        return DeviceKey(self.vendor_id, self.product_id, self.port)


class _Bound:
    """A joystick that plays one or more roles."""

    def __init__(self, entry: JoystickInfo, joystick: Any) -> None:
        self.entry = entry
        self.joystick = joystick
        self.instance_id = entry.instance_id
        self.fresh = False  # SDL reads the first values at the first pump after opening
        self.clicks = 0  # presses since the last poll, also those already released


def identity(guid: str) -> tuple[int, int]:
    """Return (vendor id, product id) from SDL's 32-digit joystick GUID: little-endian words 2 and 4."""
    return (
        int.from_bytes(bytes.fromhex(guid[8:12]), "little"),
        int.from_bytes(bytes.fromhex(guid[16:20]), "little"),
    )


def connected_joysticks(pygame: Any) -> list[tuple[JoystickInfo, Any]]:
    """Return every plugged-in joystick with its open pygame object."""
    joysticks = []
    for index in range(pygame.joystick.get_count()):
        joystick = pygame.joystick.Joystick(index)
        vendor_id, product_id = identity(joystick.get_guid())
        place = place_of(joystick.get_instance_id())
        entry = JoystickInfo(
            vendor_id=vendor_id,
            product_id=product_id,
            name=joystick.get_name(),
            instance_id=joystick.get_instance_id(),
            axes=joystick.get_numaxes(),
            buttons=joystick.get_numbuttons(),
            hats=joystick.get_numhats(),
            port=place.port,
            serial=place.serial,
        )
        joysticks.append((entry, joystick))
    return joysticks


class SdlSource:
    """The cockpit of a profile, read through SDL. Survives unplugging; comes back by identity."""

    def __init__(self, cockpit: CockpitProfile, mine: Callable[[int], bool] = lambda instance_id: True) -> None:
        """Open the cockpit; `mine` tells which of SDL's joysticks are looked at, where several are alike.

        Raises:
            DeviceNotFound: a device that the profile binds is not plugged in.
            DeviceModeError: it is there in a mode that cannot drive.
            DeviceError: SDL does not work, or the pedals are calibrated the wrong way round.
        """
        if not cockpit.roles:
            raise DeviceError(f"{cockpit.title}: roles: value empty: a cockpit with devices")
        self._cockpit, self._mine = cockpit, mine
        self._bound: dict[DeviceKey, _Bound] = {}
        self._keys = {binding.role: binding.key for binding in cockpit.roles}
        self._bits = {on: list(button_bits(cockpit, on).items()) for on in ("wheel", "shifter")}
        pedals = cockpit.pedals
        self._axes = tuple(
            None if pedal is None else pedal.axis for pedal in (pedals.throttle, pedals.brake, pedals.clutch)
        )
        self._handbrake_role = cockpit.played_by("handbrake")
        self._wheel = [cockpit.wheel.centre_raw, 0.0, 0.0, 0.0]  # axis, buttons, hat x, hat y: last good
        self._pedals = [0.0, 0.0, 0.0]
        self._handbrake = 0.0
        self._shifter = 0.0
        self._count = 0
        self._pygame = sdl_runtime.acquire()
        self._open = True
        _OPEN.append(self)
        try:
            self._start()
        except BaseException:
            self.close()
            raise

    def poll(self, tick: int) -> DeviceSample:
        """Return the cockpit now. Ages are 0, or NEVER_TICKS for a device that is gone; its last values stay."""
        arrived = self._take_events()
        for bound in self._bound.values():
            bound.fresh = True
        wheel = self._readable("wheel")
        if wheel is not None:
            self._read_wheel(wheel)
        pedals = self._readable("pedals")
        if pedals is not None:
            self._read_pedals(pedals)
        hand = self._readable(self._handbrake_role)
        if hand is not None and self._cockpit.pedals.handbrake is not None:
            self._handbrake = hand.joystick.get_axis(self._cockpit.pedals.handbrake.axis)
        shifter = self._readable("shifter")
        if shifter is not None:
            self._shifter = float(_held(shifter, self._bits["shifter"]))
        for bound in self._bound.values():
            bound.clicks = 0
        if arrived:
            self._bind()
        angle, wheel_buttons, hat_x, hat_y = self._wheel
        throttle, brake, clutch = self._pedals
        return DeviceSample(
            wheel_axis=angle,
            throttle_axis=throttle,
            brake_axis=brake,
            clutch_axis=clutch,
            handbrake_axis=self._handbrake,
            wheel_buttons=wheel_buttons,
            shifter_buttons=self._shifter,
            hat_x=hat_x,
            hat_y=hat_y,
            wheel_age_ticks=NEVER_TICKS if wheel is None else 0.0,
            pedals_age_ticks=NEVER_TICKS if pedals is None else 0.0,
            shifter_age_ticks=NEVER_TICKS if shifter is None else 0.0,
            handbrake_age_ticks=NEVER_TICKS if hand is None else 0.0,
        )

    def instance_id(self, role: RoleName) -> int | None:
        """Return SDL's number of the device that plays this role now; None while it is not there."""
        bound = self._bound.get(self._keys[role])
        return None if bound is None else bound.instance_id

    def identities(self) -> tuple[DeviceIdentity, ...]:
        """Return which devices play the cockpit's roles now, each once."""
        found = []
        for key, bound in self._bound.items():
            entry = bound.entry
            found.append(
                DeviceIdentity(
                    roles=tuple(role for role, wanted in self._keys.items() if wanted == key),
                    name=entry.name,
                    usb_id=f"{entry.vendor_id:04x}:{entry.product_id:04x}",
                    port=entry.port,
                    serial=entry.serial,
                )
            )
        return tuple(found)

    def close(self) -> None:
        """Release the devices. Twice is harmless."""
        if self._open:
            self._open = False
            _OPEN.remove(self)
            self._bound.clear()
            sdl_runtime.release()

    def _start(self) -> None:
        self._pygame.event.get()
        self._bind()
        for binding in self._cockpit.roles:
            if binding.key not in self._bound:
                raise self._missing(binding)
            self._refuse_two(binding)
        self._check_polarity(self.poll(0))

    def _take_events(self) -> bool:
        """Empty the queue; drop removed devices before anything of theirs is read. Return whether one arrived."""
        pygame, arrived = self._pygame, False
        presses: list[tuple[int, int]] = []
        for event in pygame.event.get():
            if event.type == pygame.JOYDEVICEREMOVED:
                self._bound = {k: bound for k, bound in self._bound.items() if bound.instance_id != event.instance_id}
            elif event.type == pygame.JOYDEVICEADDED:
                arrived = True
            elif event.type == pygame.JOYBUTTONDOWN:
                presses.append((event.instance_id, event.button))
        count = pygame.joystick.get_count()
        if count != self._count:  # also where someone else in this process has emptied the queue
            self._count, arrived = count, True
            present = {entry.instance_id for entry, _ in self._connected()}
            self._bound = {k: bound for k, bound in self._bound.items() if bound.instance_id in present}
        for bound in (bound for source in _OPEN for bound in source._bound.values()):
            for instance_id, button in presses:
                if instance_id == bound.instance_id:
                    bound.clicks |= 1 << button
        return arrived

    def _bind(self) -> None:
        connected = self._connected()
        for binding in self._cockpit.roles:
            for device in binding.candidates:
                for entry, joystick in connected:
                    if binding.key not in self._bound and is_device(entry, device) and _fits(entry, device):
                        self._bound[binding.key] = _Bound(entry, joystick)

    def _connected(self) -> list[tuple[JoystickInfo, Any]]:
        return [found for found in connected_joysticks(self._pygame) if self._mine(found[0].instance_id)]

    def _readable(self, role: RoleName) -> _Bound | None:
        bound = self._bound.get(self._keys[role])
        return bound if bound is not None and bound.fresh else None

    def _read_wheel(self, bound: _Bound) -> None:
        hat_x, hat_y = bound.joystick.get_hat(0) if bound.entry.hats else (0, 0)
        axis = bound.joystick.get_axis(self._cockpit.wheel.axis)
        self._wheel = [axis, float(_held(bound, self._bits["wheel"])), float(hat_x), float(hat_y)]

    def _read_pedals(self, bound: _Bound) -> None:
        self._pedals = [0.0 if axis is None else bound.joystick.get_axis(axis) for axis in self._axes]

    def _missing(self, binding: RoleBinding) -> DeviceError:
        wanted = f"{binding.vendor_id:04x}:{binding.product_id:04x}"
        present = [entry for entry, _ in self._connected()]
        for mode in self._cockpit.boot_modes:
            if any((entry.vendor_id, entry.product_id) == (mode.vendor_id, mode.product_id) for entry in present):
                boot = f"{mode.vendor_id:04x}:{mode.product_id:04x}"
                return DeviceModeError(f"{binding.name}: mode: value {boot} (boot mode): {wanted}; {mode.cure}")
        for entry in present:
            if is_device(entry, binding):
                return DeviceModeError(
                    f"{binding.name} ({wanted}): axes and buttons: value {entry.axes} and {entry.buttons}: "
                    f"at least {binding.axes} and {binding.buttons}"
                )
        seen = ", ".join(
            f"{entry.vendor_id:04x}:{entry.product_id:04x} {entry.name}{_at(entry.port)}" for entry in present
        )
        return DeviceNotFound(
            f"{self._cockpit.title}: role {binding.role}: value {wanted} ({binding.name}){_at(binding.port)} "
            "not connected: "
            f"{f'connected are {seen}' if seen else 'nothing is'}"
        )

    def _refuse_two(self, binding: RoleBinding) -> None:
        same = [entry for entry, _ in self._connected() if is_device(entry, binding) and _fits(entry, binding)]
        if len(same) > 1:
            ports = " or ".join(repr(entry.port) for entry in same)
            raise DeviceError(
                f"{self._cockpit.title}: role {binding.role}: value two devices "
                f"{binding.vendor_id:04x}:{binding.product_id:04x}: one, or its port in the profile, {ports}"
            )

    def _check_polarity(self, sample: DeviceSample) -> None:
        throttle = self._cockpit.pedals.throttle
        share = travel(sample.throttle_axis, throttle.rest_raw, throttle.full_raw)
        if share >= INVERTED_SHARE:
            raise DeviceError(
                f"{self._cockpit.title}: pedals.throttle: value {share:.0%} pressed at the start: below "
                f"{INVERTED_SHARE:.0%}; foot off, or rest_raw and full_raw of the profile are swapped"
            )


_OPEN: Final[list[SdlSource]] = []
"""All that are open in this process, each a person's: SDL has one queue, and who empties it tells all of presses."""


def _fits(entry: JoystickInfo, binding: RoleBinding | OtherDevice) -> bool:
    return entry.axes >= binding.axes and entry.buttons >= binding.buttons


def is_device(entry: JoystickInfo, device: RoleBinding | OtherDevice) -> bool:
    """Return whether a joystick has this identity, and is where the profile says if it says where."""
    port = device.port if isinstance(device, RoleBinding) else ""
    return entry.key[:2] == (device.vendor_id, device.product_id) and port in ("", entry.port)


def _at(port: str) -> str:
    return f" at {port}" if port else ""


def _held(bound: _Bound, bits: list[tuple[int, int]]) -> int:
    mask = 0
    for button, bit in bits:
        if button < bound.entry.buttons and (bound.joystick.get_button(button) or bound.clicks >> button & 1):
            mask |= 1 << bit
    return mask
