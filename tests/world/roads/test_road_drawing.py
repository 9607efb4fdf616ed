import numpy as np
import pytest

from simconsole.world.roads.lane_graph import LaneGraph
from simconsole.world.roads.road_drawing import HEIGHTS_M, NEAR_M, beside, draw_roads
from simconsole.world.roads.road_map import BUILDING, TREE, Obstacle
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


def test_fixed_things_near_the_route_stand_upright_and_closed() -> None:
    near, far = np.array(((5.0, 9.0), (8.0, 9.0), (8.0, 12.0))), np.array(((5.0, 900.0), (8.0, 900.0), (8.0, 912.0)))
    road_map = straight_map()._replace(obstacles=(Obstacle(TREE, near), Obstacle(BUILDING, far)))
    drawing = draw_roads(road_map, route_over(road_map, LaneGraph(road_map).drawn(1, 150.0)))
    (wall,) = drawing.walls
    assert wall[:, :2].tolist() == [*near.tolist(), [5.0, 9.0]]
    assert set(wall[:, 2].tolist()) == {HEIGHTS_M[TREE]}


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


def test_who_waits_at_a_stop_line_sees_a_light_before_them() -> None:
    """From 4 m behind the line a post at the line is beside the driver, out of a picture of 62 degrees."""
    road_map = generated_map(*CITY)
    drawing = draw_roads(road_map, route_over(road_map, LaneGraph(road_map).drawn(1, 300.0)))
    straight = {one.from_lane for one in road_map.connections if one.signal >= 0 and one.direction == "s"}
    lights = np.array([light[:3] for light in drawing.lights])
    seen = 0
    for place in straight:
        line = road_map.lanes[place].line
        end, before = line[-1, :2], line[-2, :2]
        if np.hypot(drawing.path[:, 0] - end[0], drawing.path[:, 1] - end[1]).min() > 100.0:
            continue
        ahead = (end - before) / np.hypot(*(end - before))
        away = lights[:, :2] - (end - 4.0 * ahead)
        forward, left = away @ ahead, away @ np.array((-ahead[1], ahead[0]))
        facing = np.cos(lights[:, 2]) * ahead[0] + np.sin(lights[:, 2]) * ahead[1] > 0.99
        in_sight = facing & (forward > 10.0) & (forward < 45.0) & (np.abs(left) < 0.4 * forward)
        assert in_sight.any(), place
        seen += 1
    assert seen > 10
