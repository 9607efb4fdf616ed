import numpy as np
import pytest

from simconsole.world import traffic_columns as at
from simconsole.world.traffic.network import network
from simconsole.world.traffic.paths import (
    AHEAD_M,
    BEHIND_M,
    desired_speed,
    forget_behind,
    look_ahead,
    middle_at,
    place_at,
)
from tests.world.nets import CITY, generated_map, straight_map
from tests.world.traffic.made import lane_called, path_on


def test_path_leads_on_over_connections_of_the_map() -> None:
    road_map = generated_map(*CITY)
    net = network(road_map)
    start = int(np.flatnonzero(np.diff(net.out_starts) > 0)[3])
    path = path_on(start)
    look_ahead(net, path, 0.0)
    lanes = path[at.LANES : at.LANES + path[at.COUNT]].tolist()
    assert sum(net.lengths_m[lanes]) >= AHEAD_M
    slot = 0
    while path[at.CONNECTIONS + slot] >= 0:
        one = road_map.connections[path[at.CONNECTIONS + slot]]
        assert one.from_lane == lanes[slot]
        assert lanes[slot + 1 : slot + 2 + len(one.via)] == [*one.via, one.to_lane]
        slot += 1 + len(one.via)
    assert slot == len(lanes) - 1


def test_lanes_far_behind_are_forgotten() -> None:
    road_map = straight_map()
    net = network(road_map)
    lanes = [lane_called(road_map, name) for name in ("AB_0", ":B_0_0", "BC_0")]
    path = path_on(*lanes)
    assert forget_behind(net, path, 95.0 + BEHIND_M - 0.1) == 95.0 + BEHIND_M - 0.1
    assert forget_behind(net, path, 95.0 + BEHIND_M + 1.0) == BEHIND_M + 1.0
    assert path[at.LANES : at.LANES + path[at.COUNT]].tolist() == lanes[1:]


def test_places_run_on_from_lane_to_lane_and_straight_on_at_the_ends() -> None:
    road_map = straight_map()
    net = network(road_map)
    path = path_on(*(lane_called(road_map, name) for name in ("AB_0", ":B_0_0", "BC_0")))
    for s_m in (-5.0, 0.0, 94.0, 99.0, 105.0, 180.0, 210.0):
        assert place_at(net, path, s_m) == pytest.approx((s_m, -1.6, 1.0, 0.0))
    assert middle_at(net, path, 100.0) == pytest.approx((100.0, -1.6, 1.0, 0.0))


def test_speed_falls_before_a_lower_limit_and_is_the_limit_there() -> None:
    road_map = straight_map()
    net = network(road_map)
    path = path_on(*(lane_called(road_map, name) for name in ("AB_0", ":B_0_0", "BC_0")))
    speeds = [desired_speed(net, path, s_m, 1.0) for s_m in (10.0, 60.0, 80.0, 100.0, 120.0)]
    assert speeds[0] == pytest.approx(13.89)
    assert speeds[3] == pytest.approx((8.33**2 + 2.0 * 1.2 * 5.0) ** 0.5)
    assert speeds[4] == pytest.approx(8.33)
    assert speeds == sorted(speeds, reverse=True)
