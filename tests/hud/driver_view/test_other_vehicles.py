import math

import numpy as np
import pytest

from simconsole.hud.driver_view.other_vehicles import (
    LONGEST_S,
    PAINTS,
    SIZE,
    at_moment,
    bodies,
    is_robot,
    meshes,
    model,
    paint_of,
    robot,
)
from simconsole.hud.driver_view.vehicle_body import GLASS
from simconsole.world.traffic.road_users import RoadUser, RoadUsersAt, table

USER = RoadUser(
    id=1.0,
    kind=2.0,
    x_m=30.0,
    y_m=4.0,
    yaw_rad=math.pi / 2.0,
    speed_mps=10.0,
    length_m=5.5,
    width_m=2.0,
    height_m=2.2,
)


@pytest.mark.parametrize(("t_s", "moved_m"), [(1.0, 0.0), (1.03, 0.3), (0.9, 0.0), (9.0, 10.0 * LONGEST_S)])
def test_everybody_goes_on_after_the_last_step_but_not_for_ever(t_s: float, moved_m: float) -> None:
    (found,) = at_moment(RoadUsersAt(250, table([USER])), t_s, 250)
    assert (found.x_m, found.y_m) == pytest.approx((30.0, 4.0 + moved_m))


def test_who_turns_does_so_evenly_between_two_steps() -> None:
    """On a circle, stepped 25 times a second: where it is drawn at any moment before the next step."""
    radius_m, speed_mps, tick_hz = 10.0, 8.0, 250

    def at(t_s: float) -> RoadUser:
        yaw = speed_mps * t_s / radius_m
        return USER._replace(
            x_m=radius_m * math.sin(yaw), y_m=-radius_m * math.cos(yaw), yaw_rad=yaw, speed_mps=speed_mps
        )

    before, newest = (RoadUsersAt(tick, table([at(tick / tick_hz)])) for tick in (240, 250))
    for t_s in np.linspace(1.0, 1.04, 9).tolist():
        (found,), true = at_moment(newest, t_s, tick_hz, before), at(t_s)
        assert found.yaw_rad == pytest.approx(true.yaw_rad, abs=1e-6)
        assert (found.x_m, found.y_m) == pytest.approx((true.x_m, true.y_m), abs=1e-3)


def test_who_turns_round_on_the_spot_or_has_just_come_goes_straight_on() -> None:
    newest = RoadUsersAt(250, table([USER]))
    for before in (table([USER._replace(yaw_rad=-1.5)]), table([USER._replace(id=7.0, yaw_rad=1.5)])):
        (found,) = at_moment(newest, 1.02, 250, RoadUsersAt(240, before))
        assert found.yaw_rad == USER.yaw_rad
        assert (found.x_m, found.y_m) == pytest.approx((30.0, 4.2))


def test_vehicles_have_their_own_paint_and_keep_it() -> None:
    assert len({paint_of(USER._replace(id=float(number))) for number in range(20)}) == len(PAINTS)
    assert paint_of(USER) == paint_of(USER._replace(x_m=99.0, speed_mps=0.0))
    for body, paint in zip(bodies(), PAINTS, strict=True):
        assert (body["position"] == meshes().body["position"]).all()
        colours = {tuple(colour) for colour in body["colour"][:, :3].tolist()}
        assert {paint, GLASS} <= colours
        assert not colours & (set(PAINTS) - {paint})


def test_body_fills_the_box_of_the_road_user() -> None:
    body = meshes().body["position"].astype(float)
    points = np.column_stack((body, np.ones(len(body)))) @ model(USER).T
    low, high = points[:, :3].min(axis=0), points[:, :3].max(axis=0)
    assert high[1] - low[1] == pytest.approx(5.5, rel=0.05)
    assert high[0] - low[0] == pytest.approx(2.0, rel=0.15)
    assert 0.5 * (low + high)[:2] == pytest.approx((30.0, 4.0), abs=0.1)
    assert high[2] == pytest.approx(2.2, rel=0.1)
    assert SIZE.rear_overhang_m < SIZE.length_m


def test_a_robot_is_drawn_as_one_and_fills_its_box() -> None:
    burger = USER._replace(yaw_rad=0.0, length_m=0.138, width_m=0.178, height_m=0.192)
    assert is_robot(burger)
    assert not is_robot(USER)
    corners = np.column_stack((robot()["position"], np.ones(len(robot())))) @ model(burger).T
    low, high = corners[:, :3].min(axis=0), corners[:, :3].max(axis=0)
    assert (low[:2] > (30.0 - 0.11, 4.0 - 0.10)).all()
    assert (high < (30.0 + 0.11, 4.0 + 0.10, 0.20)).all()
    assert high[2] > 0.18
