"""What every motor must do, whatever stands behind it: run in a test for some, in the mocked program for others."""

from collections.abc import Callable

import numpy as np
import pytest

from simconsole.devices.force_feedback.motor import HapticPort, WheelMotor
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError
from simconsole.values.signals import NO_TORQUE
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot

Check = Callable[[HapticPort], None]


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


def works_behind_the_motor(port: HapticPort) -> None:
    motor = WheelMotor(port, ForceFeedback(max_torque_nm=4.0), lambda snapshot: snapshot.t_s)
    for tick in range(20):
        row = np.zeros(PLATFORM_AT)
        row[LAYOUT.torque.slice] = NO_TORQUE._replace(torque_nm=tick - 10.0, enabled=float(tick % 7 > 0))
        motor.publish(Snapshot(tick, 250, row))
    assert motor.failure is None
    motor.close()
    assert not motor.obeys


CHECKS: dict[str, Check] = {
    check.__name__: check
    for check in (takes_every_level_in_any_order, closes_twice_and_then_has_no_force, works_behind_the_motor)
}
