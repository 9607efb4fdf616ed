"""Authority over steering in SHARED: fixed, by time to line crossing, traded; blended into the angle or haptic only."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.control.requests.control_settings import ControlSettings, settings
from simconsole.control.shared import by_line_crossing, shared_authority, time_to_crossing, traded
from simconsole.profiles.control import ControlProfile
from simconsole.values.signals import VehicleState

MakeRig = Callable[..., Any]
STANDING = VehicleState(*(0.0,) * len(VehicleState._fields))
RULES = ["fixed", "line_crossing", "traded"]


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


@pytest.mark.parametrize(("trade", "part"), [(-1.0, 0.0), (-0.5, 0.15625), (0.0, 0.5), (0.5, 0.84375), (1.0, 1.0)])
def test_consent_moves_smoothly_between_none_and_the_full_share(trade: float, part: float, make_rig: MakeRig) -> None:
    now = make_rig(profile=ControlProfile(shared_authority="traded", shared_lateral=0.8)).moment()
    still = now._replace(
        memory=now.memory._replace(shared_trade=trade), settings=now.settings._replace(shared_trade_per_tick=0.0)
    )
    assert shared_authority(still, 0.1, 0.0) == pytest.approx((0.8 * part, trade))


def test_each_rule_gives_its_authority_and_only_the_traded_one_moves_the_trade(make_rig: MakeRig) -> None:
    now = make_rig().moment()
    now = now._replace(memory=now.memory._replace(shared_trade=0.25), human_nm=9.0)
    now = now._replace(vehicle=now.vehicle._replace(vx_mps=15.0))
    settings = [now.settings._replace(shared_rule=rule) for rule in (0.0, 1.0, 2.0)]
    fixed, by_line, traded_away = (shared_authority(now._replace(settings=rule), 0.1, 0.0) for rule in settings)
    assert tuple(fixed) == (now.settings.shared_lateral, 1.0)
    crossing_s = time_to_crossing(0.1, 0.0, now.vehicle, now.settings)
    assert tuple(by_line) == (by_line_crossing(crossing_s, now.settings), 1.0)
    assert by_line.lateral > fixed.lateral > traded_away.lateral
    assert traded_away.trade == pytest.approx(0.25 - now.settings.shared_trade_per_tick)


def test_a_torque_that_is_no_number_is_no_push_however_small_the_threshold(make_rig: MakeRig) -> None:
    now = make_rig(profile=ControlProfile(shared_authority="traded")).moment()
    light = now._replace(settings=now.settings._replace(shared_trade_nm=0.5), human_nm=math.nan)
    assert shared_authority(light, 0.1, 0.0).trade == pytest.approx(now.settings.shared_trade_per_tick)


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
