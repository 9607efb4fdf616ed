import math

import numpy as np
import pytest

from simconsole.drivers.path_tracker.approach import ON_PATH, approach_from, why_not


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


def test_nothing_is_left_of_a_line_that_is_over() -> None:
    line = approach_from(100.0, 1.3, 0.2, 8.0)
    assert not line.is_over(100.0 + 30.0 * line.length_m)
    end = 100.0 + 41.0 * line.length_m
    assert line.is_over(end)
    assert line.at(end) == pytest.approx((0.0, 0.0), abs=1e-13)
    assert line.curvature(np.array((end, end + 50.0))) == pytest.approx((0.0, 0.0), abs=1e-14)
    assert ON_PATH.is_over(0.0)


def test_how_far_a_way_back_leads() -> None:
    """Towards the path it never leads further than it begins; away from it, the furthest is where the slope is 0."""
    assert approach_from(0.0, 1.0, -0.3, 0.0).furthest_m == pytest.approx(1.0)
    away = approach_from(0.0, 1.0, math.radians(20.0), 0.0)
    exact = max(abs(away.at(x)[0]) for x in np.linspace(0.0, 60.0, 6001).tolist())
    assert away.furthest_m == pytest.approx(exact, abs=0.01)
    assert 1.2 < away.furthest_m < 1.3


@pytest.mark.parametrize(
    ("offset_m", "heading_deg", "speed_mps", "engaged", "told"),
    [
        (1.0, 20.0, 0.0, False, ""),
        (1.0, 20.0, 0.0, True, ""),
        (-1.29, 0.0, 10.0, False, ""),
        (1.31, 0.0, 10.0, False, "the way back leads 1.3 m from the course, at most 1.3 m"),
        (-0.2, -15.0, 14.0, False, "the way back leads 2.4 m"),
        (0.0, 26.0, 0.0, False, "the car is turned 26 deg from the course, at most 25 deg"),
        (0.0, -180.0, 0.0, False, "the car is turned 180 deg"),
        (2.9, 60.0, 5.0, True, ""),
        (-3.1, 0.0, 5.0, True, "the car is 3.1 m beside the course, at most 3 m"),
    ],
)
def test_where_a_car_is_not_led_back_from(
    offset_m: float, heading_deg: float, speed_mps: float, engaged: bool, told: str
) -> None:
    reason = why_not(offset_m, math.radians(heading_deg), speed_mps, engaged)
    assert reason.startswith(told)
    assert bool(reason) == bool(told)
