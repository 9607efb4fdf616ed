"""Crossings of maps: lights, widths, and the lanes that lead over them."""

import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.world.kinds.worlds import open_map
from simconsole.world.people.crossings import crossings_of
from simconsole.world.roads.road_map import CROSSING, RoadMap
from tests.world.nets import CITY, generated_map, straight_map


def urban() -> RoadMap:
    return open_map(load_world("urban_signals"))  # type: ignore[arg-type]  # it is a road map


def test_crossing_of_a_road_has_a_strip_for_each_direction() -> None:
    road_map = urban()
    crossing = next(one for one in crossings_of(road_map) if road_map.edges[one.edge].id == ":crossing0_c0")
    assert (crossing.length_m, crossing.width_m) == pytest.approx((7.0, 4.0))
    assert (crossing.signal, crossing.link) == (-1, -1)
    assert sorted((one.low_m, one.high_m) for one in crossing.strips) == [
        pytest.approx((0.0, 3.5)),
        pytest.approx((3.5, 7.0)),
    ]
    assert all((one.near_m, one.far_m) == pytest.approx((0.0, 4.0)) for one in crossing.strips)


def test_crossing_at_lights_knows_the_link_for_people() -> None:
    road_map = urban()
    crossing = next(one for one in crossings_of(road_map) if road_map.edges[one.edge].id == ":junction0_c1")
    assert (road_map.signals[crossing.signal].id, crossing.link) == ("junction0", 13)
    # straight on and both turns on the way in, and as many on the way out
    assert len(crossing.strips) == 6


def test_every_crossing_of_a_generated_city_is_led_over() -> None:
    road_map = generated_map(*CITY)
    found = crossings_of(road_map)
    assert len(found) == sum(edge.function == CROSSING for edge in road_map.edges)
    assert all(0.0 <= strip.low_m < strip.high_m <= one.length_m for one in found for strip in one.strips)


def test_only_crossings_over_given_lanes_are_looked_for() -> None:
    road_map = urban()
    all_of_them = crossings_of(road_map)
    lane = all_of_them[0].strips[0].lane
    (only,) = crossings_of(road_map, {lane})
    assert [strip.lane for strip in only.strips] == [lane]
    assert crossings_of(straight_map()) == []
