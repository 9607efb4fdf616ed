import numpy as np
import pytest

from simconsole.scene.predicted_way import AHEAD_S, POINTS, WAY_COLUMNS, ways

HZ = 100


def table(count: int, **columns: float) -> dict[str, np.ndarray]:
    named = {name.partition(".")[2]: name for name in WAY_COLUMNS}
    found = {name: np.zeros(count) for name in WAY_COLUMNS}
    for key, value in columns.items():
        found[named[key]][:] = value
    return found


def of(table: dict[str, np.ndarray], wheelbase_m: float) -> np.ndarray:
    count = len(table["vehicle.x_m"])
    ticks = np.arange(1, count + 1)
    return ways(table, ticks, ticks * (10**9 // HZ), HZ, wheelbase_m).points


def test_ten_ways_a_second_at_ticks_that_no_cut_moves() -> None:
    ticks = np.arange(1, 1 + 2 * HZ)
    found = ways(table(len(ticks)), ticks, ticks * 10_000_000, HZ, 2.5)
    assert found.times_ns.tolist() == [at * 10_000_000 for at in range(10, 201, 10)]
    assert found.points.shape == (20, POINTS, 3)


def test_straight_on_it_is_as_long_as_the_speed_says() -> None:
    points = of(table(10, x_m=5.0, y_m=7.0, yaw_rad=np.pi / 2.0, vx_mps=10.0), 2.5)[0]
    assert points[-1] == pytest.approx((5.0, 7.0 + 10.0 * AHEAD_S, 0.25))


def test_a_steered_car_goes_round_its_circle() -> None:
    angle, wheelbase_m = 0.1, 2.5
    radius_m = wheelbase_m / np.tan(angle)
    points = of(table(10, vx_mps=8.0, road_wheel_rad=angle), wheelbase_m)[0]
    assert np.hypot(points[:, 0], points[:, 1] - radius_m) == pytest.approx(np.full(POINTS, radius_m))
    assert points[-1, 1] > 0.0, "to the left"
    turned = 8.0 * AHEAD_S / radius_m
    assert points[-1, :2] == pytest.approx((radius_m * np.sin(turned), radius_m * (1.0 - np.cos(turned))))


def test_a_robot_turns_as_it_is_told() -> None:
    points = of(table(10, vx_mps=0.2, target_yaw_rate_radps=-0.5, road_wheel_rad=0.3), 0.0)[0]
    assert np.hypot(points[:, 0], points[:, 1] + 0.4) == pytest.approx(np.full(POINTS, 0.4))
