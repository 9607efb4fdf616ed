import numpy as np
import pytest

from simconsole.world.roads.lane_graph import LaneGraph
from simconsole.world.roads.road_drawing import NEAR_M, beside, draw_roads
from simconsole.world.roads.road_route import route_over
from tests.world.nets import CITY, generated_map, straight_map


def test_straight_road_is_drawn_as_wide_as_its_lane() -> None:
    road_map = straight_map()
    drawing = draw_roads(road_map, route_over(road_map, LaneGraph(road_map).drawn(1, 150.0)))
    area = sum(
        0.5 * abs(np.dot(p[:, 0], np.roll(p[:, 1], 1)) - np.dot(p[:, 1], np.roll(p[:, 0], 1))) for p in drawing.surfaces
    )
    assert area == pytest.approx(190.0 * 3.2 + 10.0 * 3.2, rel=0.01)
    assert len(drawing.edges) == 4
    assert drawing.lights == ()


def test_city_has_lights_stop_lines_and_zebras_near_the_route_only() -> None:
    road_map = generated_map(*CITY)
    route = route_over(road_map, LaneGraph(road_map).drawn(1, 300.0))
    drawing = draw_roads(road_map, route)
    assert len(drawing.stop_lines) > 10
    assert len(drawing.zebras) > 50
    assert len(drawing.lights) == len(set(drawing.lights))
    path = drawing.path
    for light in drawing.lights:
        assert np.hypot(path[:, 0] - light.x_m, path[:, 1] - light.y_m).min() < NEAR_M + 30.0
    whole = sum(len(lane.line) for lane in road_map.lanes)
    assert len(drawing.centre_lines) < whole


def test_line_beside_a_corner_is_mitred() -> None:
    line = beside(np.array(((0.0, 0.0), (10.0, 0.0), (10.0, 10.0))), 1.0)
    assert line == pytest.approx(np.array(((0.0, 1.0), (9.0, 1.0), (9.0, 10.0))))
