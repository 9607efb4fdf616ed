"""A profile's cockpit of virtual devices: what is written, what a plug pulled and put back leaves."""

from typing import Any

import msgspec
import pytest

from simconsole.devices.calibration.cockpit_settings import CockpitSettings, cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.devices.sources.virtual_joystick import VirtualDevice
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.values.errors import DeviceError


@pytest.fixture
def moves(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Any, ...]]:
    """What devices are told: their axes and masks."""
    told: list[tuple[Any, ...]] = []
    for name in ("set_axis", "set_buttons", "set_hat"):
        monkeypatch.setattr(VirtualDevice, name, lambda self, *values, name=name: told.append((name, *values)))
    return told


def test_only_what_changed_is_written(
    plugged: VirtualCockpit, t500_settings: CockpitSettings, moves: list[tuple[Any, ...]]
) -> None:
    plugged.write(raw_sample(Intent(), t500_settings))
    moves.clear()
    plugged.write(raw_sample(Intent(), t500_settings))
    assert moves == []
    plugged.write(raw_sample(Intent(brake=1.0), t500_settings))
    assert moves == [("set_axis", 1, -1.0)]


def test_device_that_is_out_is_passed_over_and_written_whole_when_it_is_back(
    plugged: VirtualCockpit, t500_settings: CockpitSettings, moves: list[tuple[Any, ...]]
) -> None:
    held = raw_sample(Intent(throttle=1.0, gear=2.0), t500_settings)
    plugged.write(held)
    plugged.unplug("shifter")
    plugged.unplug("shifter")
    moves.clear()
    plugged.write(held)
    assert moves == []
    plugged.plug("shifter")
    plugged.plug("shifter")
    assert plugged.plugged == 1
    moves.clear()
    plugged.write(held)
    assert moves == [("set_buttons", 1 << 1)], "of the shifter alone: the throttle was never gone"


def test_one_device_that_plays_wheel_and_shifter_has_buttons_of_both(sdl: None, moves: list[tuple[Any, ...]]) -> None:
    pad = load("devices", "gamepad", CockpitProfile)
    cockpit = VirtualCockpit(pad)
    rest = raw_sample(Intent(), cockpit_settings(pad, 250))
    cockpit.write(rest._replace(wheel_buttons=1.0, shifter_buttons=6.0))
    assert [move for move in moves if move[0] == "set_buttons"] == [("set_buttons", 7)]
    cockpit.close()


def test_profile_without_devices_is_no_cockpit(t500: CockpitProfile) -> None:
    with pytest.raises(DeviceError, match="roles: value empty: a cockpit with devices"):
        VirtualCockpit(msgspec.structs.replace(t500, roles=[]))
