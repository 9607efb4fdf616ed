"""All joysticks at once, as the calibration reads them."""

from collections.abc import Callable

import pytest

from simconsole.devices.sources import sdl_runtime
from simconsole.devices.sources.raw_joysticks import RawJoysticks
from simconsole.devices.sources.virtual_joystick import VirtualDevice, VirtualSpec
from simconsole.values.errors import DeviceError

Plug = Callable[[VirtualSpec], VirtualDevice]
PAD = VirtualSpec("Pad", 0x1234, 0x5678, 2, 3, 1)
LEVER = VirtualSpec("Lever", 0x1234, 0x9ABC, 1, 2, 0)


def test_axes_buttons_and_hat_of_every_device_are_read(plug: Plug) -> None:
    pad, lever = plug(PAD), plug(LEVER)
    with RawJoysticks() as joysticks:
        assert {entry.name for entry in joysticks.entries.values()} == {"Pad", "Lever"}
        pad.set_axis(1, -1.0)
        pad.set_button(2, True)
        pad.set_hat(0, 1, -1)
        lever.set_button(1, True)
        found = joysticks.read()
    assert found[0x1234, 0x5678].axes == pytest.approx((0.0, -1.0), abs=1e-4)
    assert found[0x1234, 0x5678].buttons == 1 << 2 | 1 << 25 | 1 << 27, "the hat's right and down lie above 24 buttons"
    assert found[0x1234, 0x9ABC].buttons == 1 << 1


def test_nothing_connected_or_two_of_a_kind_is_said_and_lets_go_of_sdl(plug: Plug) -> None:
    with pytest.raises(DeviceError, match="devices: value none connected: a wheel or a gamepad"):
        RawJoysticks()
    first, second = plug(PAD), plug(PAD)
    held = sdl_runtime._Runtime.users
    with pytest.raises(DeviceError, match="Pad: value two with one id 1234:5678: unplug one"):
        RawJoysticks()
    assert sdl_runtime._Runtime.users == held
    first.detach()
    second.detach()


def test_device_that_goes_meanwhile_is_named(plug: Plug) -> None:
    pad = plug(PAD)
    plug(LEVER)
    with RawJoysticks() as joysticks:
        pad.detach()
        with pytest.raises(DeviceError, match="Pad: value unplugged: plugged in until the end"):
            joysticks.read()
