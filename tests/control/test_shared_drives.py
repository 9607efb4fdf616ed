"""Drives in shared control: what the person and the controller feel of the authority's rules."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.profiles.control import ControlProfile
from simconsole.values.signals import Event, Mode

MakeRig = Callable[..., Any]
RULES = ["fixed", "line_crossing", "traded"]


def shared_rig(make_rig: MakeRig, tick_hz: int = 250, speed_mps: float = 10.0, **profile: Any) -> Any:
    rig = make_rig(tick_hz, ControlProfile(**profile)).drive(Mode.SHARED, speed_mps=speed_mps)
    rig.vehicle = rig.vehicle._replace(coast_accel_mps2=0.0)  # keeps its speed
    return rig


@pytest.mark.parametrize("tick_hz", [50, 250, 1000])
def test_consent_is_gone_after_a_second_of_pushing_and_back_after_another(tick_hz: int, make_rig: MakeRig) -> None:
    rig = shared_rig(make_rig, tick_hz, shared_authority="traded", shared_lateral=0.8)
    rig.send(road_wheel_rad=0.0)
    rig.run(1.0)
    assert rig.arbitration.remote_lateral == pytest.approx(0.8)
    rig.driver = rig.driver._replace(hand_wheel_rad=1.5)
    rig.human_nm = 3.0
    rig.run(0.5)
    assert rig.memory.shared_trade == pytest.approx(0.0, abs=2.1 / tick_hz)
    assert rig.arbitration.remote_lateral == pytest.approx(0.4, abs=0.05)
    rig.run(0.6)
    assert rig.memory.shared_trade == -1.0
    assert rig.arbitration.remote_lateral == pytest.approx(0.0, abs=1e-12)
    assert rig.command.road_wheel_rad == pytest.approx(0.1)
    rig.human_nm = 0.0
    rig.run(1.1)
    assert rig.memory.shared_trade == 1.0
    assert rig.arbitration.remote_lateral == pytest.approx(0.8)


def test_the_trade_begins_anew_with_every_engagement(make_rig: MakeRig) -> None:
    rig = shared_rig(make_rig, shared_authority="traded")
    rig.memory = rig.memory._replace(shared_trade=-1.0)
    rig.driver = rig.driver._replace(brake=0.0)
    rig.tick(Event.REQUEST_MANUAL)
    assert (rig.mode, rig.memory.shared_trade) == (Mode.MANUAL, 1.0)


def test_a_torque_that_is_no_number_or_beyond_any_arm_counts_as_little_or_much(make_rig: MakeRig) -> None:
    rig = shared_rig(make_rig, shared_authority="traded")
    rig.driver = rig.driver._replace(hand_wheel_rad=1.5)
    for human_nm, trade in ((math.nan, 1.0), (1e300, 1.0 - rig.settings.shared_trade_per_tick)):
        rig.memory = rig.memory._replace(shared_trade=1.0)
        rig.human_nm = human_nm
        rig.tick()
        assert rig.memory.shared_trade == pytest.approx(trade)


def test_a_person_who_steers_off_the_lane_gets_more_help(make_rig: MakeRig) -> None:
    rig = shared_rig(make_rig, shared_authority="line_crossing")
    rig.send(road_wheel_rad=0.0)
    rig.run(1.0)
    assert rig.arbitration.remote_lateral == pytest.approx(0.5)
    rig.driver = rig.driver._replace(hand_wheel_rad=15.0 * 0.15)
    rig.run(1.0)
    assert rig.arbitration.remote_lateral == pytest.approx(0.9)
    assert rig.command.road_wheel_rad == pytest.approx(0.1 * 0.15)
    assert rig.memory.shared_trade == 1.0


@pytest.mark.parametrize("rule", RULES)
def test_haptic_authority_is_over_the_wheels_motor_and_leaves_the_road_wheels_to_the_hands(
    rule: str, make_rig: MakeRig
) -> None:
    rig = shared_rig(make_rig, shared_authority=rule, shared_steering="haptic")
    rig.send(road_wheel_rad=0.0)
    rig.driver = rig.driver._replace(hand_wheel_rad=0.15)
    rig.run(1.0)
    assert (rig.arbitration.remote_lateral, rig.arbitration.remote_guidance) == (0.0, pytest.approx(0.5, rel=0.01))
    assert rig.command.road_wheel_rad == pytest.approx(0.01)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert rig.mode is Mode.AUTONOMOUS
    assert rig.arbitration.remote_lateral == pytest.approx(rig.settings.fade_per_tick)
    rig.run(1.0)
    assert (rig.arbitration.remote_lateral, rig.arbitration.remote_guidance) == (1.0, 0.0)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("tick_hz", [50, 250, 1000])
def test_authority_never_moves_faster_than_the_fade(rule: str, tick_hz: int, make_rig: MakeRig) -> None:
    rig = shared_rig(make_rig, tick_hz, shared_authority=rule)
    before = rig.arbitration
    for tick in range(2 * tick_hz):
        turning = math.sin(8.0 * tick / tick_hz)
        rig.driver = rig.driver._replace(hand_wheel_rad=3.0 * turning)
        rig.human_nm = 4.0 * turning
        rig.tick()
        for name in ("remote_lateral", "remote_guidance"):
            step = abs(getattr(rig.arbitration, name) - getattr(before, name))
            assert step <= rig.settings.fade_per_tick + 1e-12
        before = rig.arbitration
    assert rig.mode is Mode.SHARED
