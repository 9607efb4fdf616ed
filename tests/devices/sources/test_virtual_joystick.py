"""Virtual devices as pygame sees them."""

from collections.abc import Callable

import pytest

from simconsole.devices.sources import sdl_runtime
from simconsole.devices.sources.sdl_source import connected_joysticks
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.devices.sources.virtual_joystick import VirtualDevice, VirtualSpec, specs
from simconsole.profiles.device import CockpitProfile
from simconsole.values.errors import DeviceError

Plug = Callable[[VirtualSpec], VirtualDevice]
PAD = VirtualSpec("Pad", 0x1234, 0x5678, 2, 3, 1)


def test_pygame_sees_the_real_ids_names_and_counts(plugged: VirtualCockpit) -> None:
    pygame = sdl_runtime.acquire()
    pygame.event.get()
    seen = {entry[:3] + entry[4:7] for entry, _ in connected_joysticks(pygame)}
    sdl_runtime.release()
    assert seen == {
        (0x044F, 0xB65E, "Thrustmaster TRS Racing wheel", 4, 13, 1),
        (0x044F, 0xB660, "Thustmaster T500 RS Gear Shift", 2, 10, 0),
    }


def test_one_device_per_identity_with_pedals_at_rest(t500: CockpitProfile) -> None:
    wheel, shifter = specs(t500)
    assert wheel.rest == (0.0, 1.0, 1.0, 1.0)
    assert (wheel.is_wheel, shifter.is_wheel) == (True, False)


def test_unplugged_device_can_be_moved_no_more(plug: Plug) -> None:
    pad = plug(PAD)
    pad.detach()
    pad.detach()
    with pytest.raises(DeviceError, match="unplugged"):
        pad.set_axis(0, 0.5)


@pytest.mark.parametrize("move", [lambda pad: pad.set_axis(2, 0.0), lambda pad: pad.set_button(3, True)])
def test_part_that_is_not_there_is_refused(move: Callable[[VirtualDevice], None], plug: Plug) -> None:
    with pytest.raises(DeviceError, match="Pad"):
        move(plug(PAD))
