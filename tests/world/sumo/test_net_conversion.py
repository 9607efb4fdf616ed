import pytest

from simconsole.world.roads.road_map import CROSSING, INTERNAL, ROAD, WALKING_AREA
from tests.world.nets import CITY, generated_map, straight_map


def test_functions_of_edges_and_who_may_use_lanes() -> None:
    road_map = generated_map(*CITY)
    assert {edge.function for edge in road_map.edges} == {ROAD, INTERNAL, CROSSING, WALKING_AREA}
    for lane in road_map.lanes:
        function = road_map.edges[lane.edge].function
        if function in (CROSSING, WALKING_AREA):
            assert not lane.drivable
        assert road_map.edges[lane.edge].lanes[lane.number] == road_map.lanes.index(lane) or len(lane.line) == 0
        break
    assert any(not lane.drivable for lane in road_map.lanes if road_map.edges[lane.edge].function == ROAD)


def test_connections_lead_over_lanes_inside_junctions_only() -> None:
    road_map = generated_map(*CITY)
    for one in road_map.connections:
        assert all(road_map.edges[road_map.lanes[lane].edge].function == INTERNAL for lane in one.via)
    turns = [one for one in road_map.connections if len(one.via) > 1]
    assert turns, "turns that wait inside the junction lead over two lanes"
    for one in turns:
        ends = [road_map.lanes[lane].line for lane in one.via]
        assert ends[0][-1, :2] == pytest.approx(ends[1][0, :2], abs=0.2)


def test_crossings_know_the_edges_that_they_lead_over() -> None:
    road_map = generated_map(*CITY)
    crossings = [edge for edge in road_map.edges if edge.function == CROSSING]
    assert all(edge.crossed for edge in crossings)
    assert all(road_map.edges[place].function == ROAD for edge in crossings for place in edge.crossed)


def test_counts_are_those_of_the_map() -> None:
    counts = dict(straight_map().report.counts)
    assert (counts["edges"], counts["lanes inside junctions"], counts["junctions"]) == (2, 1, 3)
