"""The console's frames and SUMO's."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from simconsole.world.sumo_traffic.places import Bumper, bumper_of, middles_of
from simconsole.world.traffic.road_users import Box


def test_front_bumper_and_navigational_angle() -> None:
    west = bumper_of(Box(10.0, 5.0, math.pi, 0.0, 4.0, 1.8), (0.0, 0.0))
    assert west == pytest.approx(Bumper(8.0, 5.0, 270.0))
    north = bumper_of(Box(10.0, 5.0, 0.5 * math.pi, 0.0, 4.0, 1.8), (100.0, -7.0))
    assert north == pytest.approx(Bumper(110.0, 0.0, 0.0))
    east = bumper_of(Box(10.0, 5.0, 0.0, 0.0, 4.0, 1.8), (0.0, 0.0))
    assert east == pytest.approx(Bumper(12.0, 5.0, 90.0))


@given(
    st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.floats(-math.pi, math.pi), st.floats(0.5, 20.0), st.floats(-1e5, 1e5)
)
def test_there_and_back(x_m: float, y_m: float, yaw_rad: float, length_m: float, moved_m: float) -> None:
    found = bumper_of(Box(x_m, y_m, yaw_rad, 0.0, length_m, 1.8), (moved_m, -moved_m))
    assert 0.0 <= found.angle_deg <= 360.0
    back = middles_of(np.array([found]), np.array([length_m]), (moved_m, -moved_m))[0]
    assert back[:2] == pytest.approx((x_m, y_m), abs=1e-9)
    assert abs(math.remainder(back[2] - yaw_rad, math.tau)) < 1e-12
    assert -math.pi <= back[2] <= math.pi
