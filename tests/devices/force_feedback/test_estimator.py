"""The person's torque, estimated from angle and motor alone: settles, is unbiased, and both executions agree."""

import random

import pytest

from simconsole.devices.force_feedback.estimator import HUMAN_LIMIT_NM, WheelEstimate, at_rest, observe
from simconsole.devices.force_feedback.force_settings import ForceSettings, force_settings
from simconsole.devices.force_feedback.rim import Rim, turn
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.values.host.jit import compiled


def settings(tick_hz: int) -> ForceSettings:
    return force_settings(load("devices", "t500rs_th8rs", CockpitProfile), 15.5, 0.62, tick_hz)


@pytest.mark.parametrize("tick_hz", [50, 100, 250, 1000])
@pytest.mark.parametrize("human_nm", [-2.0, 0.6, 5.0])
def test_steady_push_is_found_within_a_fifth_of_a_second(tick_hz: int, human_nm: float) -> None:
    force, tick_s = settings(tick_hz), 1.0 / tick_hz
    rim, estimated = Rim(0.3, 0.0), at_rest(0.3)
    for _ in range(round(0.2 * tick_hz) + 1):
        rim = turn(rim, human_nm + 0.4, force.inertia_kgm2, force.motor_damping_nms, force.motor_friction_nm, tick_s)
        estimated = observe(estimated, rim.rad, 0.4, force, tick_s)
    assert estimated.human_nm == pytest.approx(human_nm, rel=0.05)
    assert estimated.hands_on == 1.0


def test_wheel_that_sticks_says_no_more_than_it_knows() -> None:
    force = settings(250)
    estimated = at_rest(0.0)._replace(human_nm=0.15, hands_nm=0.15)
    for _ in range(750):
        estimated = observe(estimated, 0.0, 0.0, force, 0.004)
    assert abs(estimated.human_nm) < 0.02
    assert estimated.hands_on == 0.0


def test_wheel_that_is_held_against_the_motor_shows_the_hands() -> None:
    force = settings(250)
    estimated = at_rest(0.0)
    for _ in range(500):
        estimated = observe(estimated, 0.0, 1.5, force, 0.004)
    assert estimated.human_nm == pytest.approx(-1.5, abs=force.motor_friction_nm + 0.05)
    assert estimated.hands_on == 1.0


def test_wild_readings_stay_bounded_and_both_executions_agree() -> None:
    force, fast = settings(250), compiled(observe)
    dice = random.Random(5)
    print("seed 5")
    estimated = WheelEstimate(0.0, 0.0, 0.0, 0.0, 0.0)
    for _ in range(5000):
        arguments = (dice.uniform(-10.0, 10.0), dice.uniform(-4.0, 4.0), force, 0.004)
        assert tuple(map(float.hex, fast(estimated, *arguments))) == tuple(
            map(float.hex, observe(estimated, *arguments))
        )
        estimated = observe(estimated, *arguments)
        assert abs(estimated.human_nm) <= HUMAN_LIMIT_NM
