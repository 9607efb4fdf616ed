import numpy as np
import pytest

from simconsole.vehicle.turtlebot.contact import pushed_out
from simconsole.vehicle.turtlebot.robot_state import OBSTACLES_AT, OTHERS_AT

RADIUS_M = 0.1


def pushed(
    x_m: float, y_m: float, segments: list[tuple[float, ...]], circles: list[tuple[float, ...]]
) -> tuple[float, ...]:
    row = np.concatenate((np.zeros(OBSTACLES_AT), np.ravel(segments), np.ravel(circles)))
    return pushed_out(x_m, y_m, RADIUS_M, row, len(segments), len(circles), row, 0)


FLOOR, SIDE = (0.0, 0.0, 2.0, 0.0), (0.0, 0.0, 0.0, 2.0)


def test_a_body_apart_from_everything_stays() -> None:
    assert pushed(1.0, 0.1001, [FLOOR], [(1.0, 0.5, 0.29)]) == (1.0, 0.1001, 0.0, 0.0)


def test_it_is_pushed_off_the_side_it_is_on() -> None:
    assert pushed(1.0, 0.06, [FLOOR], []) == pytest.approx((1.0, 0.1, 0.0, 0.04))
    assert pushed(1.0, -0.06, [FLOOR], []) == pytest.approx((1.0, -0.1, 0.0, -0.04))


def test_a_walls_end_pushes_along_the_line_to_it() -> None:
    x, y, _, _ = pushed(2.03, 0.04, [FLOOR], [])
    assert (x, y) == pytest.approx((2.06, 0.08))


def test_out_of_a_corner_it_touches_both_walls() -> None:
    assert pushed(0.05, 0.07, [FLOOR, SIDE], [])[:2] == pytest.approx((0.1, 0.1))


def test_a_pillar_pushes_outwards() -> None:
    assert pushed(1.3, 1.0, [], [(1.0, 1.0, 0.25)]) == pytest.approx((1.35, 1.0, 0.05, 0.0))


def test_another_robot_pushes_as_a_pillar_does() -> None:
    others = [(1.0, 1.0, 0.25), (3.0, 1.0, 0.25)]
    row = np.concatenate((np.zeros(OTHERS_AT), np.ravel(others)))
    nothing = np.zeros(OBSTACLES_AT)
    assert pushed_out(1.3, 1.0, RADIUS_M, nothing, 0, 0, row, 2) == pytest.approx((1.35, 1.0, 0.05, 0.0))
    assert pushed_out(2.7, 1.0, RADIUS_M, nothing, 0, 0, row, 2) == pytest.approx((2.65, 1.0, -0.05, 0.0))
    assert pushed_out(2.0, 1.0, RADIUS_M, nothing, 0, 0, row, 2) == (2.0, 1.0, 0.0, 0.0)
