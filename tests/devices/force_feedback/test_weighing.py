"""The scale of a motor's torque by a weight on the rim."""

from collections.abc import Callable

import numpy as np
import pytest

from simconsole.devices.force_feedback.identification import identify
from simconsole.devices.force_feedback.weighing import weighed
from simconsole.profiles.device import CockpitProfile
from simconsole.values.errors import DeviceError
from tests.devices.benched_wheel import TICK_HZ, BenchedWheel
from tests.devices.hands_off import Draw, draws
from tests.samples import Sample

WEIGHT_NM = 0.7
STICKY = Draw(inertia=0.62, torque=0.64, friction_nm=0.24, delay_ms=19)
"""Light and with much friction: the hold's own spring is too weak to turn it back at the end of a sweep."""


def test_scale_is_found(t500: CockpitProfile, sample: Sample, record_property: Callable[[str, object], None]) -> None:
    force, worst = t500.force_feedback, 0.0
    assert force is not None
    for draw in (STICKY, *draws(np.random.default_rng(sample.seed), sample.of(2, 50))):
        wheel = BenchedWheel(force, draw)
        found = identify(wheel.turn, force, 0.4, TICK_HZ)
        wheel.furthest_rad = wheel.fastest_radps = 0.0
        wheel.hung_nm = WEIGHT_NM
        scale = weighed(wheel.turn, found, WEIGHT_NM, 0.8 * force.max_torque_nm, TICK_HZ, wheel.take_off)
        worst = max(worst, abs(scale / wheel.scale - 1.0))
        assert worst <= 0.05, (draw, scale)
        assert wheel.furthest_rad <= np.radians(12.0), draw
        assert wheel.fastest_radps <= np.radians(120.0), draw
    record_property("torque by a weight", f"within {worst:.1%}")


def test_weight_that_is_more_than_the_motor_may_hold_is_said_once_it_is_off(t500: CockpitProfile) -> None:
    """Half the torque, much friction: a sweep upwards would need more than there is, and the scale would be wrong."""
    force = t500.force_feedback
    assert force is not None
    wheel = BenchedWheel(force, Draw(torque=0.5, friction_nm=0.3))
    found = identify(wheel.turn, force, 0.4, TICK_HZ)
    wheel.hung_nm = 2.0 * WEIGHT_NM
    with pytest.raises(DeviceError, match=r"weight: torque: value 1\.40 N m: a lighter one"):
        weighed(wheel.turn, found, 2.0 * WEIGHT_NM, 0.8 * force.max_torque_nm, TICK_HZ, wheel.take_off)
    assert wheel.hung_nm == 0.0


def test_missing_weight_is_said(t500: CockpitProfile) -> None:
    force = t500.force_feedback
    assert force is not None
    wheel = BenchedWheel(force, Draw())
    found = identify(wheel.turn, force, 0.4, TICK_HZ)
    with pytest.raises(DeviceError, match="weight"):
        weighed(wheel.turn, found, WEIGHT_NM, 0.8 * force.max_torque_nm, TICK_HZ, wheel.take_off)
