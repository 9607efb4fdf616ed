"""All joysticks at once, as the calibration reads them."""

from collections.abc import Callable

import pytest

from simconsole.devices.calibration.input_detection import BUTTONS
from simconsole.devices.sources import sdl_runtime
from simconsole.devices.sources.raw_joysticks import RawJoysticks
from simconsole.devices.sources.virtual_joystick import VirtualDevice, VirtualSpec
from simconsole.profiles.device import DeviceKey
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
    assert found[DeviceKey(0x1234, 0x5678)].axes == pytest.approx((0.0, -1.0), abs=1e-4)
    assert found[DeviceKey(0x1234, 0x5678)].buttons == 1 << 2 | 0b1010 << BUTTONS, (
        "above all buttons the hat's right and down"
    )
    assert found[DeviceKey(0x1234, 0x9ABC)].buttons == 1 << 1


def test_nothing_connected_or_two_of_a_kind_is_said_and_lets_go_of_sdl(plug: Plug) -> None:
    with pytest.raises(DeviceError, match="devices: value none connected: a wheel or a gamepad"):
        RawJoysticks()
    first, second = plug(PAD), plug(PAD)
    held = sdl_runtime._Runtime.users
    with pytest.raises(
        DeviceError, match="Pad: value two with one id 1234:5678 and no port to tell them apart: unplug one"
    ):
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


def test_two_of_a_kind_are_told_apart_by_their_ports(plug: Plug) -> None:
    plug(PAD._replace(port="usb-1")), plug(LEVER._replace(port="usb-3"))
    second = plug(PAD._replace(port="usb-2"))
    with RawJoysticks() as joysticks:
        second.set_axis(0, 1.0)
        found = joysticks.read()
    assert set(found) == {DeviceKey(0x1234, 0x5678, port) for port in ("usb-1", "usb-2")} | {
        DeviceKey(0x1234, 0x9ABC)
    }, "the only one of its kind may be plugged in anywhere"
    assert found[DeviceKey(0x1234, 0x5678, "usb-2")].axes[0] == pytest.approx(1.0, abs=1e-4)
    assert found[DeviceKey(0x1234, 0x5678, "usb-1")].axes[0] == 0.0


def test_buttons_above_24_are_read(plug: Plug) -> None:
    many = plug(PAD._replace(buttons=100))
    with RawJoysticks() as joysticks:
        many.set_button(99, True)
        assert joysticks.read()[DeviceKey(0x1234, 0x5678)].buttons == 1 << 99
