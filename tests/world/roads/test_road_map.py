from tests.world.nets import straight_map


def test_lanes_know_their_length_and_edges_are_found_by_name() -> None:
    road_map = straight_map()
    place = road_map.edge("BC")
    assert place is not None
    (lane,) = road_map.edges[place].lanes
    assert road_map.lanes[lane].length_m == 95.0
    assert road_map.edge("CB") is None
