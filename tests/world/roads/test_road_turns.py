import math

import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.lane_graph import LaneGraph
from simconsole.world.roads.road_route import route_over
from simconsole.world.roads.road_turns import turns
from tests.samples import Sample
from tests.world.nets import CITY, TOWN, generated_map


def test_turns_are_those_of_the_way_in_its_order_and_lead_where_it_goes(sample: Sample) -> None:
    told = 0
    for number in range(sample.of(4, 50)):
        road_map = generated_map(*(CITY if number % 2 else TOWN))
        legs = LaneGraph(road_map).drawn(sample.seed + number, 800.0)
        route = route_over(road_map, legs)
        found = list(turns(road_map, legs, route))
        assert [turn.s_m for turn in found] == sorted(turn.s_m for turn in found)
        ways = [leg.connection.direction for leg in legs if leg.connection is not None]
        assert len(found) <= sum(direction != "s" for direction in ways)
        for turn in found:
            assert turn.exit == 0
            assert 0.0 <= turn.s_m < turn.end_s_m <= route.length_m
            before, after = route.at(turn.s_m - 3.0), route.at(turn.end_s_m + 3.0)
            turned = math.remainder(after.yaw_rad - before.yaw_rad, math.tau)
            assert turned == pytest.approx(turn.angle_rad, abs=math.radians(25.0))
            told += 1
    assert told > 0


def test_a_roundabout_is_one_turn_with_its_exit() -> None:
    (turn,) = open_world(load_world("urban_signals")).route.turns
    assert turn.exit == 1  # of this map no other road leaves the ring
    assert math.degrees(turn.angle_rad) == pytest.approx(90.0, abs=1.0)
    (as_a_course,) = open_world(load_world("urban")).route.turns
    assert as_a_course.exit == 3  # right, straight on, left
    assert as_a_course.angle_rad == pytest.approx(turn.angle_rad, abs=0.02)


def test_a_road_without_junctions_has_no_turns() -> None:
    for name in ("motorway", "country", "skid_pad"):
        assert open_world(load_world(name)).route.turns == ()
