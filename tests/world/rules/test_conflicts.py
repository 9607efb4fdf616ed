"""Where the route of the urban course gives way."""

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.lane_graph import LaneGraph, Leg
from simconsole.world.roads.road_route import route_over
from simconsole.world.roads.road_world import Roads, roads_of
from simconsole.world.route import Route
from simconsole.world.rules.conflicts import CRITICAL_S, LEFT_FROM_MAJOR_S, ROUNDABOUT_S, SEEN_M, _Ways, duties
from tests.world.nets import generated_map, straight_map


def urban() -> tuple[Roads, Route]:
    world = open_world(load_world("urban_signals"))
    roads = roads_of(world)
    assert roads is not None
    return roads, world.route


def test_every_crossing_and_the_roundabout_lie_on_the_route() -> None:
    roads, route = urban()
    found = duties(roads.road_map, roads.legs, route)
    names = [roads.road_map.edges[foot.crossing.edge].id for foot in found.crossings]
    expected = [":junction0_c3", ":junction0_c1", ":crossing0_c0", ":crossing1_c0", ":crossing2_c0", ":crossing3_c0"]
    assert names == expected
    for foot in found.crossings:
        point = route.at(foot.line_m + 0.5 * foot.crossing.width_m)
        assert np.hypot(foot.crossing.line - (point.x_m, point.y_m), 0.0).min() < 5.0
        assert foot.high_m - foot.low_m == pytest.approx(3.5, abs=0.5)
    edges = [roads.road_map.edges[roads.road_map.lanes[one.connection.to_lane].edge].id for one in found.entries]
    entry = found.entries[edges.index("ring0in-ring0out")]
    assert entry.critical_s == ROUNDABOUT_S
    assert entry.watched.first.any()
    assert entry.watched.to_m.max() > 60.0, "the ring is seen before the entry, too"
    assert entry.watched.to_m.max() < SEEN_M


def test_green_light_makes_others_wait_but_for_who_is_inside() -> None:
    roads, route = urban()
    found = duties(roads.road_map, roads.legs, route)
    lights = next(one for one in found.entries if one.connection.signal >= 0)
    assert lights.critical_s == LEFT_FROM_MAJOR_S
    assert (lights.watched.inside > 0.0).any()


def test_who_turns_left_at_lights_may_wait_inside_before_the_ways_of_oncoming_vehicles() -> None:
    roads, _ = urban()
    road_map = roads.road_map
    for one in road_map.connections:
        if one.signal < 0 or not (road_map.lanes[one.from_lane].drivable and road_map.lanes[one.to_lane].drivable):
            continue
        legs = [Leg((one.from_lane,), one), Leg((one.to_lane,), None)]
        entries = duties(road_map, legs, route_over(road_map, legs)).entries
        within = [entry for entry in entries if entry.inside]
        assert len(within) == (1 if one.direction == "l" else 0), one
        for entry in within:
            at_line = next(other for other in entries if not other.inside)
            way_m = entry.line_m - at_line.line_m
            assert 3.0 < way_m <= road_map.lanes[one.via[0]].length_m, "further on, SUMO's vehicles let it go first"
            assert entry.watched.first.all()
            own = road_map.lanes[one.from_lane].line[-1, :2] - road_map.lanes[one.from_lane].line[-2, :2]
            far = entry.watched.to_m > 40.0
            towards = entry.watched.cosine[far] * own[0] + entry.watched.sine[far] * own[1]
            assert far.any()
            assert (towards < 0.0).all(), "they come from the other side"


def test_movements_of_any_junction_are_looked_at() -> None:
    """Over one lane inside the junction, too, where the map tells no place to wait, and one oncoming way only."""
    road_map = generated_map("--rand", "--rand.iterations", "100", "--seed", "6", "--tls.guess")
    ways = _Ways(road_map)
    lanes = [len(one.via) for one in road_map.connections if ways.oncoming(one) is not None]
    assert {1, 2} <= set(lanes)


def test_critical_headways_of_minor_roads_are_longest_to_the_left() -> None:
    assert ROUNDABOUT_S < CRITICAL_S["r"] < CRITICAL_S["s"] < CRITICAL_S["l"]


def test_road_without_crossings_and_junctions_owes_nothing() -> None:
    road_map = straight_map()
    legs = LaneGraph(road_map).drawn(1, 100.0)
    assert legs is not None
    assert duties(road_map, legs, route_over(road_map, legs)) == ((), ())
