import math

import numpy as np
import pytest

from simconsole.drivers.path_tracker.approach import ON_PATH, approach_from


@pytest.mark.parametrize(("offset", "heading", "speed"), [(0.5, 0.0, 10.0), (-2.0, 0.1, 14.0), (1.0, -0.2, 0.0)])
def test_line_begins_as_the_car_stands_and_ends_on_the_path(offset: float, heading: float, speed: float) -> None:
    line = approach_from(100.0, offset, heading, speed)
    assert line.at(100.0) == pytest.approx((offset, math.tan(heading)))
    assert line.at(100.0 + 20.0 * line.length_m) == pytest.approx((0.0, 0.0), abs=1e-5)


def test_slope_and_curvature_are_the_derivatives() -> None:
    line, h = approach_from(0.0, 1.2, 0.05, 12.0), 1e-4
    for s in (0.5, 5.0, 17.0, 60.0):
        assert line.at(s)[1] == pytest.approx((line.at(s + h)[0] - line.at(s - h)[0]) / (2 * h), abs=1e-7)
        bend = (line.at(s + h)[1] - line.at(s - h)[1]) / (2 * h)
        assert line.curvature(np.array((s,)))[0] == pytest.approx(bend, abs=1e-7)


@pytest.mark.parametrize("speed", [3.0, 8.0, 14.0])
@pytest.mark.parametrize("offset", [0.3, 1.5, 5.0])
def test_lateral_acceleration_stays_modest(offset: float, speed: float) -> None:
    line = approach_from(0.0, offset, 0.0, speed)
    bend = np.abs(line.curvature(np.linspace(0.0, 200.0, 2000))).max()
    assert bend * speed * speed <= 1.01


def test_steep_heading_is_bounded_and_nothing_happens_on_the_path() -> None:
    assert approach_from(0.0, 0.0, 3.0, 5.0).at(0.0)[1] == pytest.approx(math.tan(0.5))
    assert ON_PATH.at(50.0) == (0.0, 0.0)
    assert ON_PATH.curvature(np.array((1.0, 50.0))).tolist() == [0.0, 0.0]
