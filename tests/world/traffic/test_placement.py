import numpy as np

from simconsole.world import traffic_columns as at
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.traffic.network import network
from simconsole.world.traffic.placement import CLEAR_M, Placement
from tests.world.nets import SMALL, generated_map, straight_map


def placed(road_map: RoadMap, count: int, *, anywhere: bool) -> np.ndarray:
    place = Placement(network(road_map), np.random.default_rng(3))
    found: list[np.ndarray] = []
    for _ in range(count):
        values, path = np.zeros(at.VALUES), np.zeros(at.PATH, np.int64)
        taken = np.array([(one[at.X], one[at.Y], CLEAR_M) for one in found]).reshape(-1, 3)
        if place.place(values, path, taken, anywhere=anywhere):
            found.append(values)
    return np.array(found)


def test_vehicles_stand_apart_on_lanes_with_room() -> None:
    found = placed(generated_map(*SMALL), 20, anywhere=True)
    assert len(found) > 10
    apart = np.hypot(found[:, None, at.X] - found[None, :, at.X], found[:, None, at.Y] - found[None, :, at.Y])
    assert apart[~np.eye(len(found), dtype=bool)].min() >= CLEAR_M
    assert len(set(found[:, at.LENGTH].tolist())) == len(found)


def test_where_there_is_no_room_nobody_is_put() -> None:
    assert len(placed(straight_map(), 20, anywhere=True)) < 6


def test_later_ones_come_where_roads_come_into_the_map() -> None:
    found = placed(straight_map(), 3, anywhere=False)
    assert len(found) == 1
    assert found[0, at.X : at.Y + 1].tolist() == [8.0, -1.6]
