"""Cockpits for the tests. SDL's state belongs to the process: whoever plugs in also unplugs."""

from collections.abc import Callable, Iterator

import pytest

from simconsole.devices.calibration.cockpit_settings import CockpitSettings, cockpit_settings
from simconsole.devices.sources import sdl_runtime
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.devices.sources.virtual_joystick import VirtualDevice, VirtualSpec
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load

TICK_HZ = 250


@pytest.fixture(scope="session")
def t500() -> CockpitProfile:
    return load("devices", "t500rs_th8rs", CockpitProfile)


@pytest.fixture(scope="session")
def t500_settings(t500: CockpitProfile) -> CockpitSettings:
    return cockpit_settings(t500, TICK_HZ)


@pytest.fixture(scope="session")
def keyboard_settings() -> CockpitSettings:
    return cockpit_settings(load("devices", "keyboard", CockpitProfile), TICK_HZ)


@pytest.fixture
def sdl() -> Iterator[None]:
    """After the test nobody may still hold SDL."""
    yield
    users = sdl_runtime._Runtime.users
    while sdl_runtime._Runtime.users:
        sdl_runtime.release()
    assert users == 0


@pytest.fixture(params=["wheel first", "shifter first"])
def plugged(request: pytest.FixtureRequest, sdl: None, t500: CockpitProfile) -> Iterator[VirtualCockpit]:
    """A virtual T500 RS and TH8 RS, in both orders of enumeration."""
    cockpit = VirtualCockpit(t500, reverse_order=request.param == "shifter first")
    yield cockpit
    cockpit.close()


@pytest.fixture
def source(plugged: VirtualCockpit, t500: CockpitProfile) -> Iterator[SdlSource]:
    opened = SdlSource(t500)
    yield opened
    opened.close()


@pytest.fixture
def plug(sdl: None) -> Iterator[Callable[[VirtualSpec], VirtualDevice]]:
    """Plug in any single device; pulled out again after the test."""
    devices: list[VirtualDevice] = []

    def plug_in(spec: VirtualSpec) -> VirtualDevice:
        devices.append(VirtualDevice(spec))
        return devices[-1]

    yield plug_in
    for device in devices:
        device.close()
