import math

import numpy as np
import pytest

from simconsole.hud.driver_view.other_vehicles import LONGEST_S, SIZE, at_moment, meshes, model
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


def test_body_fills_the_box_of_the_road_user() -> None:
    body = meshes().body["position"].astype(float)
    points = np.column_stack((body, np.ones(len(body)))) @ model(USER).T
    low, high = points[:, :3].min(axis=0), points[:, :3].max(axis=0)
    assert high[1] - low[1] == pytest.approx(5.5, rel=0.05)
    assert high[0] - low[0] == pytest.approx(2.0, rel=0.15)
    assert 0.5 * (low + high)[:2] == pytest.approx((30.0, 4.0), abs=0.1)
    assert high[2] == pytest.approx(2.2, rel=0.1)
    assert SIZE.rear_overhang_m < SIZE.length_m
