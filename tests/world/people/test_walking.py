"""Who walks waits for vehicles that could not stop, crosses before those that can, and stands before who does not."""

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.world import traffic_columns as at
from simconsole.world.kinds.worlds import open_map
from simconsole.world.people.crossings import crossings_of
from simconsole.world.people.footways import Footways, footways
from simconsole.world.people.walking import (
    PACE,
    PERSON,
    SIZE_M,
    STEPPED,
    WALK,
    WAY,
    Crowd,
    Others,
    Walkers,
    step_people,
)
from simconsole.world.roads.road_map import Array

PERIOD_S = 0.04


class Scene:
    """Somebody before the first crossing of the urban course, and one vehicle whose lane and place is set."""

    def __init__(self) -> None:
        road_map = open_map(load_world("urban_signals"))  # type: ignore[arg-type]  # it is a road map
        crossings = crossings_of(road_map)
        number = next(n for n, one in enumerate(crossings) if road_map.edges[one.edge].id == ":crossing0_c0")
        self.ways: Footways = footways(road_map, crossings)
        self.way = 2 * number
        self.lengths = np.array([lane.length_m for lane in road_map.lanes])
        own = crossings[number].strips[0].lane
        self.lane = next(one.from_lane for one in road_map.connections if one.via == (own,))
        self.people = np.zeros((1, PERSON))
        self.people[0, [at.LENGTH, at.WIDTH]] = SIZE_M
        self.people[0, [WALK, WAY, PACE]] = self.way, self.ways.kerbs_m[self.way] - 3.0, 1.3
        self.people[0, at.SPEED] = 1.3
        self.crowd = Crowd(np.ones(len(crossings), np.int64), np.zeros(len(self.ways.near_m), np.int64))
        self.boxes = np.zeros((1, at.BOX))
        self.boxes[0, at.LANE] = -1.0

    def vehicle(self, front_m: float, speed_mps: float) -> None:
        self.boxes[0, [at.LENGTH, at.WIDTH, at.SPEED]] = 4.0, 1.8, speed_mps
        self.boxes[0, [at.LANE, at.ALONG]] = self.lane, self.lengths[self.lane] - front_m - 2.0

    def walk(self, time_s: float) -> Array:
        others = Others(self.boxes, np.zeros((0, at.VALUES)), np.zeros((0, at.PATH), np.int64), self.lengths)
        for _ in range(round(time_s / PERIOD_S)):
            step_people(Walkers(self.ways, self.people, self.crowd, others), PERIOD_S)
        return np.asarray(self.people[0])


def test_nobody_waits_on_an_empty_road() -> None:
    scene = Scene()
    person = scene.walk(4.0)
    assert person[WAY] == pytest.approx(scene.ways.kerbs_m[scene.way] - 3.0 + 4.0 * 1.3, abs=0.2)
    assert person[STEPPED] == 1.0
    assert scene.crowd.occupied.sum() == 2
    scene.walk(4.0)
    assert scene.crowd.occupied.sum() < 2
    scene.walk(20.0)
    assert person[at.LENGTH] == 0.0


@pytest.mark.parametrize(
    ("front_m", "speed_mps", "crosses"), [(40.0, 14.0, False), (40.0, 5.0, True), (2.0, 0.0, True)]
)
def test_people_step_before_vehicles_that_can_stop(front_m: float, speed_mps: float, crosses: bool) -> None:
    scene = Scene()
    scene.vehicle(front_m, speed_mps)
    person = scene.walk(5.0)
    if crosses:
        assert person[WAY] > scene.ways.ons_m[scene.way]
    else:
        assert person[WAY] == pytest.approx(scene.ways.kerbs_m[scene.way])
        assert person[at.SPEED] == 0.0
        assert scene.crowd.occupied.sum() == 0


def test_red_light_keeps_people_at_the_kerb() -> None:
    scene = Scene()
    scene.crowd.walks[:] = 0
    assert scene.walk(6.0)[WAY] == pytest.approx(scene.ways.kerbs_m[scene.way])
    scene.crowd.walks[:] = 1
    assert scene.walk(3.0)[WAY] > scene.ways.ons_m[scene.way]


def test_who_is_on_the_crossing_stands_before_a_vehicle_that_does_not_stop() -> None:
    scene = Scene()
    scene.people[0, [WAY, STEPPED, at.SPEED]] = scene.ways.ons_m[scene.way] - 0.5, 1.0, 1.3
    scene.boxes[0, [at.LENGTH, at.WIDTH, at.SPEED]] = 4.0, 1.8, 20.0
    place = scene.ways.strip_starts[scene.way] + 1
    strip = int(scene.ways.strips[place])
    scene.boxes[0, [at.LANE, at.ALONG]] = scene.ways.reach_lanes[scene.ways.reach_starts[strip]], -15.0
    person = scene.walk(5.0)
    assert person[at.SPEED] == 0.0
    assert person[WAY] < scene.ways.lows_m[place]
    scene.boxes[0, at.LANE] = -1.0
    assert scene.walk(3.0)[WAY] > scene.ways.lows_m[place]
