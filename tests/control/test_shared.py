"""Authority over steering in SHARED: fixed, by time to line crossing, traded; blended into the angle or haptic only."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.control.settings import ControlSettings, settings
from simconsole.control.shared import by_line_crossing, time_to_crossing, traded
from simconsole.profiles.control import ControlProfile
from simconsole.signals import Event, Mode, VehicleState

MakeRig = Callable[..., Any]
STANDING = VehicleState(*(0.0,) * len(VehicleState._fields))
RULES = ["fixed", "line_crossing", "traded"]


def shared_rig(make_rig: MakeRig, tick_hz: int = 250, speed_mps: float = 10.0, **profile: Any) -> Any:
    rig = make_rig(tick_hz, ControlProfile(**profile)).drive(Mode.SHARED, speed_mps=speed_mps)
    rig.vehicle = rig.vehicle._replace(coast_accel_mps2=0.0)  # keeps its speed
    return rig


@pytest.mark.parametrize("speed", [-15.0, 15.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_time_to_line_crossing_is_that_of_two_arcs(speed: float, side: float, control: ControlSettings) -> None:
    """Straight on while the lane bends: the arc leaves the margin where 1 - cos does, to second order."""
    angle = side * 0.02
    vehicle = STANDING._replace(vx_mps=speed)
    crossing_s = time_to_crossing(0.0, angle, vehicle, control)
    assert time_to_crossing(angle, 0.0, vehicle, control) == pytest.approx(crossing_s)
    radius = control.wheelbase_m / math.tan(0.02)
    assert radius * (1.0 - math.cos(15.0 * crossing_s / radius)) == pytest.approx(0.75, rel=0.01)


def test_nobody_who_follows_the_controllers_line_ever_crosses(control: ControlSettings) -> None:
    vehicle = STANDING._replace(vx_mps=15.0)
    assert time_to_crossing(0.1, 0.1, vehicle, control) == 100.0
    assert time_to_crossing(0.1, 0.1 + 1e-8, vehicle, control) == 100.0
    assert time_to_crossing(0.3, 0.0, STANDING, control) == 100.0
    assert time_to_crossing(0.3, 0.0, STANDING._replace(vx_mps=math.nan), control) == 100.0
    assert time_to_crossing(0.3, 0.0, STANDING._replace(vx_mps=1e300), control) == time_to_crossing(
        0.3, 0.0, STANDING._replace(vx_mps=100.0), control
    )
    assert time_to_crossing(2.0, 0.0, vehicle, control) == time_to_crossing(1.5, 0.0, vehicle, control)
    assert time_to_crossing(-2.0, 0.0, vehicle, control) == time_to_crossing(1.5, 0.0, vehicle, control)


@pytest.mark.parametrize(
    ("crossing_s", "authority"), [(0.0, 0.9), (0.8, 0.9), (1.4, 0.7), (2.0, 0.5), (2.1, 0.5), (100.0, 0.5)]
)
def test_authority_rises_as_the_line_comes_near(crossing_s: float, authority: float, control: ControlSettings) -> None:
    assert by_line_crossing(crossing_s, control) == pytest.approx(authority)


@pytest.mark.parametrize(
    ("human_nm", "person_rad", "step"),
    [
        (2.0, 0.1, -1.0),
        (1.5, 0.1, -1.0),
        (1.49, 0.1, 1.0),
        (-2.0, 0.1, 1.0),
        (-2.0, -0.1, -1.0),
        (2.0, -0.1, 1.0),
        (0.0, -0.1, 1.0),
        (2.0, 0.05, 1.0),
    ],
)
def test_pushing_away_from_the_controllers_angle_moves_the_trade_to_the_person(
    human_nm: float, person_rad: float, step: float, control: ControlSettings
) -> None:
    after = traded(0.2, human_nm, person_rad, 0.05, control)
    assert after == pytest.approx(0.2 + step * control.shared_trade_per_tick)
    assert traded(step, human_nm, person_rad, 0.05, control) == step


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


def test_a_shares_most_is_never_less_than_its_least() -> None:
    s = settings(ControlProfile(shared_lateral=0.7, shared_lateral_urgent=0.2), 15.0, 0.6, 2.6, 250)
    assert s.shared_lateral_most == 0.7
    assert [settings(ControlProfile(shared_authority=rule), 15.0, 0.6, 2.6, 250).shared_rule for rule in RULES] == [  # type: ignore[arg-type]
        0.0,
        1.0,
        2.0,
    ]
    assert s.shared_line_calm_s == 2.0
    assert s.shared_trade_per_tick == 2.0 / 250.0
