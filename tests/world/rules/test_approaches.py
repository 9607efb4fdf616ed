"""Which signal lies ahead of a lane."""

import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.lane_graph import LaneGraph
from simconsole.world.roads.road_route import route_over
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.approaches import AHEAD_M, ahead_of_lanes, stop_lines
from tests.world.nets import CITY, generated_map, straight_map


def test_lane_before_a_signal_has_its_stop_line_at_its_end() -> None:
    road_map = generated_map(*CITY)
    ahead = ahead_of_lanes(road_map, ())
    held = {one.from_lane for one in road_map.connections if one.signal >= 0 and road_map.lanes[one.from_lane].drivable}
    assert len(held) > 400
    for lane in held:
        found = ahead[lane]
        assert found is not None
        assert found.beyond_m == 0.0
        links = {(one.signal, one.link) for one in road_map.connections if one.from_lane == lane}
        assert {(found.approach.signal, link) for link in found.approach.links} <= links


def test_lane_inside_a_junction_sees_the_signal_after_the_next_edge() -> None:
    road_map = generated_map(*CITY)
    ahead = ahead_of_lanes(road_map, ())
    one = next(one for one in road_map.connections if one.signal >= 0 and len(one.via) == 1)
    inside, after = ahead[one.via[0]], ahead[one.to_lane]
    assert inside is not None
    assert after is not None
    assert inside.beyond_m == road_map.lanes[one.to_lane].length_m + after.beyond_m
    assert inside.approach == after.approach


def test_on_the_route_its_own_movement_counts() -> None:
    road_map = generated_map(*CITY)
    legs = LaneGraph(road_map).drawn(3, 900.0)
    ahead = ahead_of_lanes(road_map, legs)
    turns = [(leg.connection, lane) for leg in legs for lane in leg.lanes if leg.connection is not None]
    signalled = [(turn, lane) for turn, lane in turns if turn.signal >= 0]
    assert len(signalled) > 3
    for turn, lane in signalled:
        found = ahead[lane]
        assert found is not None
        assert found.approach == (turn.signal, (turn.link,))


def test_stop_lines_stand_at_the_ends_of_the_route_s_lanes() -> None:
    road_map = generated_map(*CITY)
    legs = LaneGraph(road_map).drawn(3, 900.0)
    route = route_over(road_map, legs)
    lines = stop_lines(road_map, legs, route)
    held = [leg.lanes[-1] for leg in legs if leg.connection is not None and leg.connection.signal >= 0]
    assert len(lines) > 3
    for line, lane in zip(lines, held, strict=True):
        here, end = route.at(line.s_m), road_map.lanes[lane].line[-1]
        assert abs(here.x_m - end[0]) + abs(here.y_m - end[1]) < 0.6
    assert [line.s_m for line in lines] == sorted(line.s_m for line in lines)


def test_where_the_route_ends_at_a_signal_its_stop_line_is_the_last() -> None:
    """Base_link stops at the end: the front would be beyond a line that nobody looked at."""
    road_map = generated_map(*CITY)
    legs = LaneGraph(road_map).drawn(3, 900.0)
    place = next(at for at, leg in enumerate(legs) if leg.connection is not None and leg.connection.signal >= 0)
    turn, cut = legs[place].connection, (*legs[:place], legs[place]._replace(connection=None))
    route = route_over(road_map, cut)
    (*_, last) = stop_lines(road_map, cut, route)
    assert turn is not None
    assert last.signal == turn.signal
    assert last.s_m == pytest.approx(route.length_m, abs=0.01)
    links = {one.link for one in road_map.connections if one.from_lane == legs[place].lanes[-1]}
    assert last.link in links


def test_map_without_signals_has_none_and_a_far_one_is_not_looked_for() -> None:
    assert ahead_of_lanes(straight_map(), ()) == [None] * len(straight_map().lanes)
    roads = roads_of(open_world(load_world("urban_signals")))
    assert roads is not None
    found = [one for one in ahead_of_lanes(roads.road_map, roads.legs) if one is not None]
    assert 0 < len(found) < len(roads.road_map.lanes)
    assert all(one.beyond_m <= AHEAD_M for one in found)
