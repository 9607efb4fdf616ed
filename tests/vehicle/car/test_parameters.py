"""The parameter row: every group in its place, and figures that follow from others agree with them."""

import numpy as np
import pytest

from simconsole.values.layout import read, write
from simconsole.vehicle.car.parameters import PARAMETERS, AxleParameters
from tests.vehicle.parts import CAR


def test_what_is_written_comes_back_group_by_group() -> None:
    row = np.full(PARAMETERS.width, np.nan)
    write(row, PARAMETERS, CAR)
    assert np.isfinite(row).all(), "no column belongs to nobody"
    assert read(row, PARAMETERS) == CAR
    assert PARAMETERS.width == sum(len(group) for group in CAR)
    assert len(set(PARAMETERS.names)) == PARAMETERS.width


@pytest.mark.parametrize("axle", [CAR.front, CAR.rear])
def test_reciprocals_are_those_of_what_they_are_named_for(axle: AxleParameters) -> None:
    assert axle.per_wheel_inertia_kgm2 * axle.wheel_inertia_kgm2 == pytest.approx(1.0)
    assert axle.per_static_n * axle.static_n == pytest.approx(1.0)
    assert axle.spin_radps_per_newton_second == pytest.approx(axle.radius_m * axle.per_wheel_inertia_kgm2)
    assert axle.roll_rad_per_m * 2.0 * axle.half_track_m == pytest.approx(1.0)
