import numpy as np
import pytest

from simconsole.world.roads.lane_graph import LaneGraph, Leg
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.roads.road_route import MAX_CURVATURE_1PM, route_over, too_tight
from simconsole.world.route import Route
from tests.samples import Sample
from tests.world.nets import CITY, TOWN, generated_map, straight_map

PLAN_M = 0.20
"""How far a plan may be from its lane's centre, outside junctions and lane changes."""


def from_centres(road_map: RoadMap, legs: list[Leg], route: Route) -> float:
    """The largest distance of the route from the centre of a lane, measured from the lane."""
    worst = 0.0
    for leg in legs:
        if len(leg.lanes) > 1:
            continue
        line = road_map.lanes[leg.lanes[0]].line[:, :2]
        steps = np.hypot(*np.diff(line, axis=0).T)
        way = np.concatenate(((0.0,), np.cumsum(steps)))
        places = np.linspace(0.0, way[-1], max(2, int(way[-1])))
        for x, y in zip(*(np.interp(places, way, line[:, axis]).tolist() for axis in (0, 1)), strict=True):
            near = float(route.s[int(np.argmin((route.x - x) ** 2 + (route.y - y) ** 2))])
            worst = max(worst, abs(route.project(x, y, near).lateral_m))
    return worst


def test_plan_keeps_to_the_lanes_and_is_smooth(sample: Sample) -> None:
    worst_m = worst_1pm = 0.0
    for number in range(sample.of(6, 100)):
        road_map = generated_map(*(CITY if number % 2 else TOWN))
        legs = LaneGraph(road_map).drawn(sample.seed + number, 500.0)
        route = route_over(road_map, legs)
        if too_tight(road_map, legs, route) is not None:
            continue
        worst_m = max(worst_m, from_centres(road_map, legs, route))
        joints = np.abs(
            route.curvature[1:] - (route.curvature + route.curvature_rate * np.diff(route.s, append=0.0))[:-1]
        )
        worst_1pm = max(worst_1pm, float(joints.max()))
        assert float(np.abs(route.curvature).max()) <= MAX_CURVATURE_1PM
    print(
        f"measured: plans at most {100 * worst_m:.1f} cm from the lanes' centres, curvature steps {worst_1pm:.1e} 1/m"
    )
    assert worst_m <= PLAN_M
    assert worst_1pm < 1e-9


def test_route_has_the_limits_of_its_lanes_and_ends_where_they_end() -> None:
    road_map = straight_map()
    legs = LaneGraph(road_map).drawn(1, 180.0)
    route = route_over(road_map, legs)
    assert route.length_m == pytest.approx(200.0, abs=0.1)
    assert set(route.limit.tolist()) == {13.89, 8.33}
    assert route.limits_at(np.array((90.0, 120.0))).tolist() == [13.89, 8.33]
    assert not route.closed


def test_signals_and_crossings_stand_along_the_route() -> None:
    road_map = generated_map(*CITY)
    legs = LaneGraph(road_map).drawn(1, 800.0)
    route = route_over(road_map, legs)
    kinds = {mark.kind for mark in route.landmarks}
    assert kinds == {"traffic lights", "crossing"}
    for mark in route.landmarks:
        assert abs(route.project(mark.x_m, mark.y_m, mark.s_m).lateral_m) < 7.0
