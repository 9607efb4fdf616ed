import numpy as np
import pytest

from simconsole.world.traffic.network import CHANGING_M, network
from tests.world.nets import CITY, TOWN, generated_map, straight_map


def test_rows_of_lanes_and_connections_are_those_of_the_map() -> None:
    road_map = generated_map(*TOWN)
    net = network(road_map)
    for place, lane in enumerate(road_map.lanes):
        points = net.points[net.point_starts[place] : net.point_starts[place + 1]]
        assert np.array_equal(points[:, :2], lane.line[:, :2])
        assert points[-1, 2] == pytest.approx(net.lengths_m[place])
    for place, one in enumerate(road_map.connections):
        via = net.via[net.via_starts[place] : net.via_starts[place + 1]]
        assert tuple(via) == one.via
        assert net.goals[place] == one.to_lane


def test_foes_are_mutual_and_who_goes_first_is_a_foe() -> None:
    net = network(generated_map(*CITY))
    rows = range(len(net.goals))
    foes = {row: set(net.foes[net.foe_starts[row] : net.foe_starts[row + 1]].tolist()) for row in rows}
    firsts = {row: set(net.firsts[net.first_starts[row] : net.first_starts[row + 1]].tolist()) for row in rows}
    assert sum(len(some) for some in foes.values()) > 1000
    assert all(row in foes[foe] for row in rows for foe in foes[row])
    assert all(firsts[row] <= foes[row] for row in rows)


def test_nobody_is_led_onto_a_lane_that_ends_too_soon() -> None:
    road_map = generated_map(*CITY)
    net = network(road_map)
    for connection in net.out.tolist():
        goal = net.goals[connection]
        gets_on = net.out_starts[goal] < net.out_starts[goal + 1]
        assert gets_on or net.leaves[goal] or net.lengths_m[goal] >= CHANGING_M


def test_the_end_of_the_map_is_where_vehicles_leave() -> None:
    road_map = straight_map()
    net = network(road_map)
    assert [road_map.lanes[place].id for place in np.flatnonzero(net.leaves)] == [":B_0_0", "BC_0"]
