"""Ways of people: over the crossing from kerb to kerb, and lanes that lead there."""

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.world.kinds.worlds import open_map
from simconsole.world.people.crossings import crossings_of
from simconsole.world.people.footways import KERB_M, PAVEMENT_M, SEEN_M, footways
from tests.world.nets import straight_map


def test_each_crossing_has_a_way_in_each_direction() -> None:
    road_map = open_map(load_world("urban_signals"))  # type: ignore[arg-type]  # it is a road map
    crossings = crossings_of(road_map)
    ways = footways(road_map, crossings)
    assert ways.crossings.tolist() == [number for number in range(len(crossings)) for _ in range(2)]
    assert ways.ons_m - ways.kerbs_m == pytest.approx(np.full(2 * len(crossings), KERB_M))
    for number in range(len(ways.kerbs_m)):
        points = ways.points[ways.point_starts[number] : ways.point_starts[number + 1]]
        crossing = crossings[int(ways.crossings[number])]
        assert (np.diff(points[:, 2]) >= 0.0).all()
        assert ways.offs_m[number] - ways.ons_m[number] == pytest.approx(crossing.length_m)
        assert ways.kerbs_m[number] <= PAVEMENT_M + 8.0 + 1e-9
        lows = ways.lows_m[ways.strip_starts[number] : ways.strip_starts[number + 1]]
        assert (np.diff(lows) >= 0.0).all()
        assert lows.min() >= ways.ons_m[number] - 1e-9


def test_way_to_a_crossing_is_counted_from_the_beginning_of_each_lane() -> None:
    road_map = open_map(load_world("urban_signals"))  # type: ignore[arg-type]  # it is a road map
    crossings = crossings_of(road_map)
    number = next(n for n, one in enumerate(crossings) if road_map.edges[one.edge].id == ":crossing0_c0")
    ways = footways(road_map, crossings)
    strip = sum(len(one.strips) for one in crossings[:number])
    rows = slice(*ways.reach_starts[strip : strip + 2].tolist())
    reach = dict(zip(ways.reach_lanes[rows].tolist(), ways.reach_m[rows].tolist(), strict=True))
    own = crossings[number].strips[0].lane
    assert reach[own] == pytest.approx(0.0)
    (before,) = [one.from_lane for one in road_map.connections if one.via == (own,)]
    assert reach[before] == pytest.approx(road_map.lanes[before].length_m, abs=0.01)
    assert all(way - road_map.lanes[lane].length_m < SEEN_M for lane, way in reach.items())


def test_map_without_crossings_has_no_ways() -> None:
    ways = footways(straight_map(), [])
    assert len(ways.points) == len(ways.near_m) == 0
    assert len(ways.over_starts) == len(straight_map().lanes) + 1
