import math

import numpy as np
import pytest

from simconsole.values.host.jit import compiled
from simconsole.values.signals import NO_AHEAD, AheadInput
from simconsole.world.roads.lane_graph import LaneGraph
from simconsole.world.roads.road_map import Array
from simconsole.world.roads.road_route import route_over
from simconsole.world.route import Route
from simconsole.world.traffic.leader import Leaders
from simconsole.world.traffic.road_users import NOBODY, Box, RoadUser, table
from tests.world.nets import TOWN, generated_map
from tests.world.traffic.made import box


def user(x_m: float, y_m: float, yaw_rad: float = 0.0, speed_mps: float = 0.0) -> RoadUser:
    return RoadUser(
        id=1.0,
        kind=1.0,
        x_m=x_m,
        y_m=y_m,
        yaw_rad=yaw_rad,
        speed_mps=speed_mps,
        length_m=4.0,
        width_m=1.8,
        height_m=1.5,
    )


def leader(route: Route | None, ego: Box, users: Array) -> AheadInput:
    found = Leaders(route).find(ego, users)
    assert Leaders(route, compiled).find(ego, users) == found
    return found


def test_nobody_is_ahead_of_an_empty_road() -> None:
    assert leader(None, box(0.0, 0.0), NOBODY) == NO_AHEAD


def test_gap_is_bumper_to_bumper() -> None:
    found = leader(None, box(0.0, 0.0, speed_mps=15.0), table([user(30.0, 0.3, speed_mps=10.0), user(60.0, 0.0)]))
    assert (found.lead_gap_m, found.lead_speed_mps) == pytest.approx((30.0 - 2.25 - 2.0, 10.0), abs=1e-6)


def test_oncoming_vehicle_has_a_negative_speed() -> None:
    found = leader(None, box(0.0, 0.0, speed_mps=10.0), table([user(50.0, 0.0, math.pi, 10.0)]))
    assert (found.lead_gap_m, found.lead_speed_mps) == pytest.approx((50.0 - 4.25, -10.0))


def test_who_is_beside_behind_or_far_away_is_no_leader() -> None:
    some = table([user(20.0, 3.2), user(-20.0, 0.0), user(200.0, 0.0), user(20.0, -2.5, speed_mps=3.0)])
    assert leader(None, box(0.0, 0.0, speed_mps=15.0), some) == NO_AHEAD


def test_across_the_way_a_vehicle_is_as_wide_as_it_is_long() -> None:
    found = leader(None, box(0.0, 0.0, speed_mps=10.0), table([user(30.0, 2.5, math.pi / 2.0, 5.0)]))
    assert found.lead_gap_m == pytest.approx(30.0 - 2.25 - 0.9)
    assert found.lead_speed_mps == pytest.approx(0.0)


def test_way_of_the_route_round_bends_is_the_one_that_counts() -> None:
    road_map = generated_map(*TOWN)
    route = route_over(road_map, LaneGraph(road_map).drawn(3, 800.0))
    for s_m in np.arange(10.0, route.length_m - 70.0, 17.0).tolist():
        here, there = route.at(s_m), route.at(s_m + 40.0)
        ego = box(here.x_m, here.y_m, here.yaw_rad, 10.0)
        ahead: Array = table([user(there.x_m, there.y_m, there.yaw_rad, 4.0)])
        found = leader(route, ego, ahead)
        assert (found.lead_gap_m, found.lead_speed_mps) == pytest.approx((40.0 - 4.25, 4.0), abs=0.1)


def test_far_beside_its_route_a_vehicle_goes_straight_on() -> None:
    road_map = generated_map(*TOWN)
    route = route_over(road_map, LaneGraph(road_map).drawn(3, 800.0))
    first = route.at(0.0)
    ego = box(first.x_m - 500.0, first.y_m - 500.0, 0.5, 10.0)
    ahead = user(ego.x_m + 40.0 * math.cos(0.5), ego.y_m + 40.0 * math.sin(0.5), 0.5)
    assert leader(route, ego, table([ahead])).lead_gap_m == pytest.approx(35.75)
