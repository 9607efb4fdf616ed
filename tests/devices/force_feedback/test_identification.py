"""Figures of a motor from strokes, on simulated wheels of which nothing but the profile is known."""

from collections.abc import Callable

import numpy as np
import pytest

from simconsole.devices.force_feedback.identification import identify
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError
from simconsole.values.units import DEG_PER_RAD
from tests.devices.benched_wheel import LAG_S, TICK_HZ, BenchedWheel
from tests.devices.hands_off import ENDS, Draw, draws, true_force
from tests.samples import Sample

SLOW = Draw(inertia=2.0, torque=0.5, friction_nm=0.3, delay_ms=32)
"""A first look at it is short: a motor that pulls back and friction that pushes would explain it, too."""

FAINT = Draw(inertia=1.5902783830943377, torque=0.6996495270812205, friction_nm=0.18045975923259294, delay_ms=15)
"""A first look at it is a third of a degree, which takes the motor for one of three times its strength."""


@pytest.fixture
def force(t500: CockpitProfile) -> ForceFeedback:
    assert t500.force_feedback is not None
    return t500.force_feedback


def test_figures_are_found_and_the_wheel_stays_slow(
    force: ForceFeedback, sample: Sample, record_property: Callable[[str, object], None]
) -> None:
    worst = np.zeros(5)
    drawn = draws(np.random.default_rng(sample.seed), sample.of(1, 50))
    for draw in (SLOW, FAINT, *ENDS[:: sample.of(7, 1)], *drawn):
        wheel = BenchedWheel(force, draw)
        found = identify(wheel.turn, force, 0.4, TICK_HZ)
        motor = true_force(force, draw).motor
        delay_ms = 1000.0 * abs(found.delay_s - motor.delay_s - LAG_S)
        accel = abs(found.accel_per_nm * motor.inertia_kgm2 / wheel.scale - 1.0)
        friction = abs(found.friction_radps2 * motor.inertia_kgm2 / motor.friction_nm - 1.0)
        seen = (delay_ms, accel, friction, wheel.furthest_rad * DEG_PER_RAD, wheel.fastest_radps * DEG_PER_RAD)
        assert all(np.array(seen) <= (2.0, 0.1, 0.1, 15.0, 120.0)), (draw, seen)
        worst = np.maximum(worst, seen)
    record_property(
        "identified wheels",
        f"{worst[0]:.1f} ms, torque {worst[1]:.1%}, friction {worst[2]:.1%}, {worst[3]:.0f} deg, {worst[4]:.0f} deg/s",
    )


def test_wheel_that_is_held_or_turns_the_other_way_is_said(force: ForceFeedback) -> None:
    held = BenchedWheel(force, Draw(friction_nm=30.0))
    with pytest.raises(DeviceError, match="does not turn"):
        identify(held.turn, force, 0.4, TICK_HZ)
    other = BenchedWheel(force, Draw())
    with pytest.raises(DeviceError, match="turns the other way"):
        identify(lambda torque_nm: other.turn(-torque_nm), force, 0.4, TICK_HZ)


@pytest.mark.parametrize(("from_s", "to_s"), [(2.0, 4.0), (4.0, 10.0)])
def test_wheel_that_somebody_held_is_let_go_of_before_it_is_fast(
    force: ForceFeedback, from_s: float, to_s: float
) -> None:
    wheel = BenchedWheel(force, Draw())
    asked: list[float] = []

    def held(torque_nm: float) -> float:
        asked.append(torque_nm)
        by_hand = from_s <= len(asked) / TICK_HZ < to_s
        return wheel.turn(0.0 if by_hand else torque_nm)

    try:
        identify(held, force, 0.4, TICK_HZ)
    except DeviceError:
        assert asked[-1] == 0.0
    assert wheel.furthest_rad * DEG_PER_RAD <= 15.0
    assert wheel.fastest_radps * DEG_PER_RAD <= 120.0, "the limit of a push, and what the delay adds"
