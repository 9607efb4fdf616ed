from itertools import pairwise

import numpy as np
import pytest

from simconsole.world import traffic_columns as at
from simconsole.world.traffic.network import network
from simconsole.world.traffic.road_users import FIELDS, RoadUserKind, users
from simconsole.world.traffic.stepping import list_users, step_traffic
from tests.world.nets import straight_map
from tests.world.traffic.made import lane_called, path_on, turn_of, vehicle_on

PERIOD_S = 0.04


def test_vehicle_alone_accelerates_over_the_map_and_leaves_it() -> None:
    road_map = straight_map()
    net = network(road_map)
    paths = np.array([path_on(lane_called(road_map, "AB_0"))])
    values = np.array([vehicle_on(net, paths[0], 10.0, 5.0)])
    boxes, turn, near = np.zeros((1, at.BOX)), turn_of(road_map, 1), np.zeros(1, np.int64)
    way, steps = [], 0
    while values[0, at.LENGTH] > 0.0:
        way.append((float(values[0, at.X]), float(values[0, at.SPEED])))
        step_traffic(net, values, paths, boxes, turn, near, steps, PERIOD_S)
        assert values[0, at.Y] == pytest.approx(-1.6)
        steps += 1
    assert 197.0 < way[-1][0] < 199.0
    assert max(speed for _, speed in way) > 9.0
    assert way[-1][1] < 8.6  # the second road has a lower limit
    driven = sum(0.5 * (one[1] + other[1]) * PERIOD_S for one, other in pairwise(way))
    assert way[-1][0] - way[0][0] == pytest.approx(driven, rel=1e-9)


def test_follower_stops_behind_a_box_and_stands_there() -> None:
    road_map = straight_map()
    net = network(road_map)
    paths = np.array([path_on(lane_called(road_map, "AB_0"))])
    values = np.array([vehicle_on(net, paths[0], 10.0, 13.0)])
    boxes, turn, near = np.zeros((2, at.BOX)), turn_of(road_map, 1), np.zeros(2, np.int64)
    boxes[1] = 80.0, -1.6, 1.0, 0.0, 0.0, 4.0, 1.8, -1.0, 0.0
    for step in range(1000):
        step_traffic(net, values, paths, boxes, turn, near, step, PERIOD_S)
        assert values[0, at.ACCELERATION] >= -4.0
    assert values[0, at.SPEED] == pytest.approx(0.0, abs=0.01)
    assert values[0, at.STOOD] > 5.0
    assert values[0, at.X] == pytest.approx(80.0 - 2.0 - 2.0 - 2.0, abs=0.6)


def test_list_has_everybody_on_the_road_but_the_ego() -> None:
    boxes = np.zeros((4, at.BOX))
    boxes[0] = 1.0, 2.0, 0.0, 1.0, 3.0, 4.0, 1.8, -1.0, 0.0
    boxes[2] = 5.0, 6.0, 1.0, 0.0, 7.0, 4.0, 1.8, -1.0, 0.0  # the ego
    boxes[3] = 8.0, 9.0, 1.0, 0.0, 0.0, 5.8, 2.0, -1.0, 0.0
    rows = np.zeros((4, FIELDS))
    count = list_users(boxes, np.array([11.0, 12.0, 13.0, 14.0]), 2, rows)
    first, second = users(rows[:count])
    assert first[:6] == pytest.approx((11.0, RoadUserKind.CAR, 1.0, 2.0, np.pi / 2.0, 3.0))
    assert (second.id, second.kind, second.length_m) == (14.0, RoadUserKind.VAN, 5.8)
