from itertools import pairwise

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import RoadsProfile
from simconsole.world import traffic_columns as at
from simconsole.world.kinds.worlds import open_map
from simconsole.world.traffic.network import network
from simconsole.world.traffic.road_users import FIELDS, RoadUserKind, users
from simconsole.world.traffic.stepping import CRASHED_MPS2, INDICATED_M, indicators, list_users, step_traffic
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
    net = network(straight_map())
    boxes = np.zeros((4, at.BOX))
    boxes[0] = 1.0, 2.0, 0.0, 1.0, 3.0, 4.0, 1.8, -1.0, 0.0
    boxes[2] = 5.0, 6.0, 1.0, 0.0, 7.0, 4.0, 1.8, -1.0, 0.0  # the ego
    boxes[3] = 8.0, 9.0, 1.0, 0.0, 0.0, 5.8, 2.0, -1.0, 0.0
    values, paths, rows = np.zeros((2, at.VALUES)), np.zeros((2, at.PATH), np.int64), np.zeros((4, FIELDS))
    values[0, at.OFFSET] = -3.2  # on its way to the lane on its left
    count = list_users(net, values, paths, boxes, np.array([11.0, 12.0, 13.0, 14.0]), rows)
    first, second = users(rows[:count])
    assert first[:6] == pytest.approx((11.0, RoadUserKind.CAR, 1.0, 2.0, np.pi / 2.0, 3.0))
    assert (second.id, second.kind, second.length_m) == (14.0, RoadUserKind.VAN, 5.8)
    assert (first.turn_indicators, second.turn_indicators) == (1.0, 0.0)


def test_vehicles_indicate_before_they_turn_and_until_they_have_turned() -> None:
    profile = load_world("urban_signals")
    assert isinstance(profile, RoadsProfile)
    road_map = open_map(profile)
    net = network(road_map)
    turned = 0
    for place, one in enumerate(road_map.connections):
        lane = road_map.lanes[one.from_lane]
        if not lane.drivable or lane.length_m < INDICATED_M + 10.0 or not net.turns[place]:
            continue
        chain = (one.from_lane, *one.via, one.to_lane)
        path = path_on(*chain, connections=(place,))
        far, near, inside, beyond = lane.length_m - INDICATED_M - 4.0, lane.length_m - 30.0, lane.length_m + 1.0, 6.0
        told = [
            indicators(net, path, vehicle_on(net, path, s, 5.0))
            for s in (far, near, inside, lane.length_m + float(net.ways_m[place]) + beyond)
        ]
        assert told == [0.0, net.turns[place], net.turns[place], 0.0]
        turned += 1
    assert turned > 5


def test_who_has_collided_only_comes_to_rest() -> None:
    road_map = straight_map()
    net = network(road_map)
    paths = np.array([path_on(lane_called(road_map, "AB_0"))])
    values = np.array([vehicle_on(net, paths[0], 10.0, 9.0)])
    values[0, at.CRASHED] = 1.0
    boxes, turn, near = np.zeros((1, at.BOX)), turn_of(road_map, 1), np.zeros(1, np.int64)
    for step in range(100):
        step_traffic(net, values, paths, boxes, turn, near, step, PERIOD_S)
    assert values[0, at.SPEED] == 0.0
    assert values[0, at.X] == pytest.approx(10.0 + 9.0**2 / (2.0 * CRASHED_MPS2), abs=0.5)
