"""What every motor must do, whatever stands behind it: run in a test for some, in the mocked program for others."""

import pytest

from simconsole.devices.motor import HapticPort
from simconsole.errors import DeviceError


def takes_every_level_in_any_order(port: HapticPort) -> None:
    port.stop()
    for level in (0.0, 1.0, -1.0, 0.3, 7.0, -7.0):
        port.write(level)
        port.start()
    port.stop()
    port.stop()


def closes_twice_and_then_has_no_force(port: HapticPort) -> None:
    had_force = port.capability.constant
    port.start()
    port.close()
    port.close()
    port.stop()
    assert not port.capability.constant
    assert port.capability.name
    if had_force:
        with pytest.raises(DeviceError):
            port.write(0.5)
