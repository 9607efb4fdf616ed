"""Who drives and walks where, by a seed."""

from itertools import pairwise
from xml.etree import ElementTree

from simconsole.world.roads.road_map import ROAD
from simconsole.world.sumo.net_reader import read_net
from simconsole.world.sumo_traffic.demand import demand
from simconsole.world.sumo_traffic.walks import FASTEST_MPS
from tests.world.nets import CITY, TOWN, generated_map, straight_map
from tests.world.sumo_traffic.on_sumo import NET


def test_equal_seeds_give_equal_texts_and_others_do_not() -> None:
    road_map = generated_map(*TOWN)
    first, again, other = (
        demand(road_map, vehicles=20, pedestrians=5, seed=seed, horizon_s=300.0) for seed in (4, 4, 5)
    )
    assert first == again
    assert first != other


def test_every_way_is_connected_and_departures_are_in_order() -> None:
    road_map = read_net(NET.read_bytes(), NET.name)
    text = demand(road_map, vehicles=30, pedestrians=10, seed=2, horizon_s=900.0)
    lanes, names = road_map.lanes, [edge.id for edge in road_map.edges]
    follows = {
        (names[lanes[one.from_lane].edge], names[lanes[one.to_lane].edge])
        for one in road_map.connections
        if lanes[one.from_lane].drivable and lanes[one.to_lane].drivable
    }
    root = ElementTree.fromstring(text)
    ways = [str(route.get("edges")).split() for route in root.iter("route")]
    assert sum(len(way) for way in ways) > 100
    assert all(pair in follows for way in ways for pair in pairwise(way))
    departs = [float(str(one.get("depart"))) for one in root if one.tag in ("vehicle", "person")]
    assert departs == sorted(departs)
    assert departs.count(0.0) == 40


def test_who_comes_later_comes_where_no_road_leads_to() -> None:
    road_map = straight_map()
    root = ElementTree.fromstring(demand(road_map, vehicles=3, pedestrians=2, seed=1, horizon_s=600.0))
    later = [one.find("route") for one in root.iter("vehicle") if one.get("depart") != "0.00"]
    assert len(later) > 20
    assert {str(route.get("edges")).split()[0] for route in later if route is not None} == {"AB"}
    assert not list(root.iter("person")), "no pavements"


def test_nobody_gets_to_the_end_of_a_way_that_ends_in_the_middle_of_the_map() -> None:
    road_map, horizon_s = generated_map(*TOWN), 110.0
    root = ElementTree.fromstring(demand(road_map, vehicles=40, pedestrians=0, seed=3, horizon_s=horizon_s))
    lane_of = {edge.id: next(road_map.lanes[at] for at in edge.lanes if road_map.lanes[at].drivable)
               for edge in road_map.edges if edge.function == ROAD}  # fmt: skip
    goes_on = {road_map.edges[road_map.lanes[one.from_lane].edge].id for one in road_map.connections}
    for vehicle in root.iter("vehicle"):
        way = str(vehicle[0].get("edges")).split()
        fastest_s = sum(lane_of[edge].length_m / (1.3 * lane_of[edge].limit_mps) for edge in way)
        assert way[-1] not in goes_on or float(str(vehicle.get("depart"))) + fastest_s >= horizon_s


def test_people_walk_for_as_long_as_there_shall_be_some() -> None:
    road_map = generated_map(*CITY)
    root = ElementTree.fromstring(demand(road_map, vehicles=0, pedestrians=4, seed=1, horizon_s=300.0))
    people = list(root.iter("person"))
    assert len(people) == 4
    lane_of = {edge.id: road_map.lanes[edge.lanes[0]] for edge in road_map.edges if edge.function == ROAD}
    for person in people:
        edges = [edge for walk in person for edge in str(walk.get("edges")).split()]
        assert sum(lane_of[edge].length_m for edge in edges) / FASTEST_MPS >= 300.0
