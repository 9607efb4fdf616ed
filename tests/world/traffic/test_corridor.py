import math

import numpy as np
import pytest

from simconsole.world import traffic_columns as at
from simconsole.world.roads.road_map import Array
from simconsole.world.traffic.corridor import Ahead, Body, horizon, near_boxes, nearest_ahead
from simconsole.world.traffic.following import FAR_M
from simconsole.world.traffic.network import network
from tests.world.nets import straight_map
from tests.world.traffic.made import lane_called, path_on, vehicle_on


def looked(*others: tuple[float, float, float, float], high_m: float = 0.0) -> Ahead:
    """What a vehicle of 4 m at x = 40 m sees of boxes (x, y, yaw, speed) of 4.5 m by 1.8 m."""
    road_map = straight_map()
    net = network(road_map)
    path = path_on(*(lane_called(road_map, name) for name in ("AB_0", ":B_0_0", "BC_0")))
    boxes: Array = np.zeros((1 + len(others), at.BOX))
    boxes[0] = vehicle_on(net, path, 40.0, 10.0)[: at.BOX]
    for row, (x_m, y_m, yaw, speed) in enumerate(others, start=1):
        boxes[row, :7] = x_m, y_m, math.cos(yaw), math.sin(yaw), speed, 4.5, 1.8
    near = np.zeros(len(boxes), np.int64)
    count = near_boxes(boxes, 0, 100.0, near)
    return nearest_ahead(net, path, 40.0, Body(2.0, 0.9, 0.0, high_m), boxes, near, count, 100.0)


def test_nobody_ahead() -> None:
    assert looked() == Ahead(FAR_M, 0.0)


def test_nearest_in_the_lane_bumper_to_bumper_over_the_junction_too() -> None:
    found = looked((120.0, -1.6, 0.0, 4.0), (130.0, -1.6, 0.0, 2.0))
    assert found.speed_mps == pytest.approx(4.0)
    assert found.gap_m == pytest.approx(80.0 - 2.25 - 2.0, abs=0.5)
    assert found.gap_m < 80.0 - 2.25 - 2.0  # rather too near than too far


@pytest.mark.parametrize("y_m", [-1.6 + 3.2, -1.6 - 3.2])
def test_who_keeps_to_the_next_lane_is_not_in_the_way(y_m: float) -> None:
    assert looked((60.0, y_m, 0.0, 5.0)).gap_m == FAR_M


def test_who_is_half_in_the_lane_is_in_the_way() -> None:
    assert looked((60.0, -3.4, 0.0, 5.0)).gap_m < 20.0


def test_corridor_of_a_change_of_lane_reaches_over_both() -> None:
    assert looked((60.0, 1.6, 0.0, 5.0), high_m=3.2).gap_m < 20.0


def test_who_crosses_or_comes_has_no_speed_along_the_way() -> None:
    assert looked((60.0, -1.6, math.pi / 2.0, 5.0)).speed_mps == pytest.approx(0.0)
    assert looked((60.0, -1.6, math.pi, 5.0)).speed_mps == 0.0


def test_who_is_behind_is_not_seen() -> None:
    assert looked((33.0, -1.6, 0.0, 12.0)).gap_m == FAR_M


def test_horizon_grows_with_speed_and_ends() -> None:
    assert horizon(0.0) < horizon(14.0) < horizon(40.0) == 200.0
    assert horizon(14.0) > 14.0**2 / (2.0 * 1.5)  # there is room to stop with comfort
