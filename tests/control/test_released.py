"""The accelerator is released when the foot is off it: not when the brake, which beats it, is pressed as well."""

from collections.abc import Callable

import pytest

from simconsole.values.signals import Event, Mode, Reason
from tests.control.conftest import PERSON, Rig

BOTH_FEET = PERSON._replace(throttle=1.0, brake=1.0)


def test_a_pressed_accelerator_does_not_arm_a_parked_car_though_the_brake_is_pressed_too(
    make_rig: Callable[..., Rig],
) -> None:
    rig = make_rig().drive(Mode.PARKED)
    rig.driver = BOTH_FEET
    rig.run(0.1)
    assert rig.mode is Mode.PARKED


@pytest.mark.parametrize("mode", [Mode.PARKED, Mode.STOPPED])
def test_manual_is_refused_while_both_pedals_are_pressed(make_rig: Callable[..., Rig], mode: Mode) -> None:
    rig = make_rig().drive(mode)
    rig.driver = BOTH_FEET
    rig.tick(Event.REQUEST_MANUAL)
    assert rig.mode is mode
    assert rig.refusal is Reason.REFUSED_THROTTLE_PRESSED


def test_the_car_does_not_start_off_when_the_brake_is_let_go(make_rig: Callable[..., Rig]) -> None:
    rig = make_rig().drive(Mode.PARKED)
    rig.driver = BOTH_FEET
    rig.run(0.1)
    rig.driver = BOTH_FEET._replace(brake=0.0)
    rig.run(0.5)
    assert rig.command.throttle == 0.0
    assert rig.vehicle.vx_mps == 0.0
