import numpy as np
import pytest

from simconsole.scene.plots import PLOTS, ROBOT_PLOTS, Follower, plot_columns, plot_lines
from simconsole.values.signals import NEVER_TICKS
from tests.scene.drives import COLUMNS, RADIUS_M, TICK_HZ, route, rows

AGE, CAN_AGE = "ros.age_ticks", "ecu.age_ticks"


def table(count: int = 3000, is_robot: bool = False) -> dict[str, np.ndarray]:
    drive = rows(count)
    found = {name: drive[:, COLUMNS.index(name)] for name in plot_columns(is_robot)}
    found[CAN_AGE] = np.full(count, NEVER_TICKS)
    return found


def line(lines: dict[str, np.ndarray], path: str, name: str) -> np.ndarray:
    plot = next(plot for plot in PLOTS if plot.path == path)
    found: np.ndarray = lines[path][:, [each.name for each in plot.series].index(name)]
    return found


def test_every_plot_has_its_lines() -> None:
    lines = plot_lines(table(), TICK_HZ, Follower())
    assert {path: values.shape for path, values in lines.items()} == {p.path: (3000, len(p.series)) for p in PLOTS}
    assert line(lines, "plots/speed", "car")[-1] == pytest.approx(36.0)


def test_a_robot_has_its_two_speeds_and_nothing_of_a_car() -> None:
    seen = table(3, is_robot=True)
    assert not [name for name in seen if "engine" in name or "torque" in name or "road_wheel" in name]
    seen["command.target_yaw_rate_radps"] = np.array([0.0, 1.0, -1.0])
    seen["vehicle.yaw_rate_radps"] = np.array([0.0, 0.5, -0.5])
    lines = plot_lines(seen, TICK_HZ, Follower(), is_robot=True)
    assert list(lines) == [plot.path for plot in ROBOT_PLOTS]
    assert lines["plots/yaw_rate"] == pytest.approx(np.degrees([[0.0, 0.0], [1.0, 0.5], [-1.0, -0.5]]))
    assert lines["plots/speed"][:, 1] == pytest.approx(seen["vehicle.vx_mps"])


def test_the_lateral_error_is_the_distance_to_the_left_of_the_path() -> None:
    beside = table()
    beside["vehicle.y_m"] = beside["vehicle.y_m"] * 49.0 / 50.0 + 1.0  # a circle a metre within the path's
    beside["vehicle.x_m"] = beside["vehicle.x_m"] * 49.0 / 50.0
    lines = plot_lines(beside, TICK_HZ, Follower(route()))
    assert line(lines, "plots/lateral_error", "car") == pytest.approx(np.full(3000, 100.0), abs=1e-6)
    assert line(lines, "plots/speed", "limit") == pytest.approx(np.full(3000, 13.9 * 3.6))


def test_a_follower_goes_on_where_the_piece_before_ended() -> None:
    whole, follower = table(), Follower(route())
    parts = [
        plot_lines({name: values[part] for name, values in whole.items()}, TICK_HZ, follower)["plots/lateral_error"]
        for part in (slice(0, 1), slice(1, 1700), slice(1700, 1700), slice(1700, 3000))
    ]
    at_once = plot_lines(whole, TICK_HZ, Follower(route()))["plots/lateral_error"]
    assert np.concatenate(parts) == pytest.approx(at_once, abs=1e-6)
    assert follower.s_m == pytest.approx(
        RADIUS_M * np.arctan2(whole["vehicle.x_m"][-1], RADIUS_M - whole["vehicle.y_m"][-1]) % (2.0 * np.pi * RADIUS_M)
    )


def test_without_a_route_there_is_neither_error_nor_limit() -> None:
    lines = plot_lines(table(10), TICK_HZ, Follower())
    assert np.isnan(line(lines, "plots/lateral_error", "car")).all()
    assert np.isnan(line(lines, "plots/speed", "limit")).all()


def test_ages_are_in_ms_and_a_command_that_never_came_has_none() -> None:
    seen = table(4)
    seen[AGE] = np.array([NEVER_TICKS, 0.0, 5.0, 25.0])
    lines = plot_lines(seen, TICK_HZ, Follower())
    assert line(lines, "plots/link_age", "ROS") == pytest.approx([np.nan, 0.0, 20.0, 100.0], nan_ok=True)
    assert np.isnan(line(lines, "plots/link_age", "CAN")).all()
