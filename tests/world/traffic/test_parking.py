import math

import numpy as np

from simconsole.values.host.jit import plain
from simconsole.world import traffic_columns as at
from simconsole.world.roads.lane_index import LaneIndex, nearest_segment
from simconsole.world.traffic.parking import parked_cars
from tests.world.nets import CITY, generated_map, straight_map


def test_parked_cars_stand_beside_the_road_out_of_every_lane() -> None:
    road_map = generated_map(*CITY)
    cars = [place for place, lane in enumerate(road_map.lanes) if lane.drivable]
    index = LaneIndex(road_map.lanes, cars, plain(nearest_segment))
    found = parked_cars(road_map, 20, np.random.default_rng(1))
    assert len(found) == 20
    for box in found:
        at_lane = index.locate(box[at.X], box[at.Y], math.atan2(box[at.SINE], box[at.COSINE]))
        assert at_lane.lane is not None
        assert -4.0 < at_lane.lateral_m < -2.4
        assert abs(at_lane.heading_error_rad) < 1e-9
    apart = np.hypot(found[:, None, at.X] - found[None, :, at.X], found[:, None, at.Y] - found[None, :, at.Y])
    assert apart[~np.eye(20, dtype=bool)].min() > 8.0


def test_none_are_asked_for_or_find_room() -> None:
    assert parked_cars(straight_map(), 0, np.random.default_rng(1)).shape == (0, at.BOX)
    assert 1 <= len(parked_cars(straight_map(), 30, np.random.default_rng(1))) < 30
