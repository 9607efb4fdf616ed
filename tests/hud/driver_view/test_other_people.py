import math

import numpy as np
import pytest

from simconsole.hud.driver_view.other_people import person, person_model
from simconsole.world.traffic.road_users import RoadUser


def test_figure_stands_where_somebody_is_and_is_as_tall() -> None:
    user = RoadUser(
        id=1.0,
        kind=3.0,
        x_m=3.0,
        y_m=4.0,
        yaw_rad=0.5 * math.pi,
        speed_mps=1.0,
        length_m=0.5,
        width_m=0.5,
        height_m=1.6,
    )
    body = person()["position"].astype(float)
    points = np.column_stack((body, np.ones(len(body)))) @ person_model(user).T
    assert points[:, 2].min() == pytest.approx(0.0)
    assert points[:, 2].max() == pytest.approx(1.6)
    assert points[:, :2].mean(axis=0) == pytest.approx((3.0, 4.0), abs=0.05)
    assert np.abs(points[:, :2] - (3.0, 4.0)).max() <= 0.25
