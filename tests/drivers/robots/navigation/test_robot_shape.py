import pytest

from tests.drivers.robots.arena_robot import burger


def test_a_burgers_wheels_are_slower_than_its_limit() -> None:
    shape = burger()
    assert shape.wheel_mps == pytest.approx(0.2097, abs=1e-4)
    assert shape.wheel_mps < shape.speed_mps == 0.22
    assert (shape.body_x_m, shape.lidar_x_m) == (-0.032, -0.032)
