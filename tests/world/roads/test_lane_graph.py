from itertools import pairwise

import pytest

from simconsole.world.roads.lane_graph import CHANGE_M, LaneGraph, Leg
from simconsole.world.roads.road_map import RoadMap
from tests.world.nets import CITY, TOWN, generated_map, straight_map


def connected(road_map: RoadMap, legs: list[Leg]) -> None:
    for leg, after in pairwise(legs):
        assert leg.connection is not None
        assert (leg.connection.from_lane, leg.connection.to_lane) == (leg.lanes[-1], after.lanes[0])
    assert legs[-1].connection is None
    for leg in legs:
        assert len({road_map.lanes[lane].edge for lane in leg.lanes}) == 1
        assert all(road_map.lanes[lane].drivable for lane in leg.lanes)
        assert (len(leg.lanes) - 1) * CHANGE_M <= road_map.lanes[leg.lanes[0]].length_m


def edges_of(road_map: RoadMap, legs: list[Leg]) -> list[int]:
    return [road_map.lanes[leg.lanes[0]].edge for leg in legs]


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("options", [CITY, TOWN])
def test_drawn_way_is_connected_long_enough_and_nowhere_twice(options: tuple[str, ...], seed: int) -> None:
    road_map = generated_map(*options)
    graph = LaneGraph(road_map)
    legs = graph.drawn(seed, 600.0)
    connected(road_map, legs)
    edges = edges_of(road_map, legs)
    assert len(set(edges)) == len(edges)
    ways = [road_map.lanes[lane].length_m for leg in legs for lane in leg.lanes[:1]]
    inside = [road_map.lanes[lane].length_m for leg in legs if leg.connection for lane in leg.connection.via]
    assert sum(ways) + sum(inside) >= 600.0
    assert graph.drawn(seed, 600.0) == legs
    found = graph.by_edges(edges)
    assert found is not None
    connected(road_map, found)
    assert edges_of(road_map, found) == edges


def test_quickest_way_is_no_longer_than_a_drawn_one() -> None:
    road_map = generated_map(*CITY)
    graph = LaneGraph(road_map)
    drawn = graph.drawn(3, 900.0)
    edges = edges_of(road_map, drawn)
    found = graph.between(edges[0], edges[-1])
    assert found is not None
    connected(road_map, found)
    assert (edges_of(road_map, found)[0], edges_of(road_map, found)[-1]) == (edges[0], edges[-1])
    assert len(found) <= len(drawn)


def test_no_way_is_none() -> None:
    road_map = straight_map()
    graph = LaneGraph(road_map)
    there, back = (road_map.edge(name) for name in ("AB", "BC"))
    assert there is not None
    assert back is not None
    assert graph.between(back, there) is None
    assert graph.by_edges([back, there]) is None
    assert graph.by_edges([there, back]) is not None
    assert LaneGraph(road_map, road_map.connections).by_edges([there, back]) is None


def test_drawn_way_that_cannot_be_long_enough_is_the_longest() -> None:
    legs = LaneGraph(straight_map()).drawn(1, 5000.0)
    assert len(legs) == 2
