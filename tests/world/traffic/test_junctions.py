"""Grants: who gets one, who waits for whom, and when one is taken back."""

import numpy as np
import pytest

from simconsole.world import traffic_columns as at
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.traffic import junctions
from simconsole.world.traffic.junctions import GIVE_WAY, GO, STOP, STOP_IF_POSSIBLE, asking_m
from simconsole.world.traffic.network import Network, network
from tests.world.nets import SMALL, generated_map
from tests.world.traffic.made import path_on, turn_of, vehicle_on


def crossing_ways(road_map: RoadMap, net: Network) -> tuple[int, int]:
    """A connection that must let another one go first, and that other."""
    for place in range(len(net.goals)):
        firsts = net.firsts[net.first_starts[place] : net.first_starts[place + 1]].tolist()
        ahead = [first for first in firsts if road_map.connections[first].direction != "t"]
        if ahead and road_map.connections[place].direction != "t":
            return place, ahead[0]
    raise AssertionError("no such junction")


class Scene:
    """Two vehicles that come to a junction on ways that cross: the first must let the second go first."""

    def __init__(self, gaps_m: tuple[float, float], speeds_mps: tuple[float, float]) -> None:
        self.road_map = generated_map(*SMALL)
        self.net = network(self.road_map)
        self.ways = crossing_ways(self.road_map, self.net)
        self.turn = turn_of(self.road_map, 2)
        self.paths = np.zeros((2, at.PATH), np.int64)
        self.values = np.zeros((2, at.VALUES))
        for row, (way, gap_m, speed_mps) in enumerate(zip(self.ways, gaps_m, speeds_mps, strict=True)):
            one = self.road_map.connections[way]
            self.paths[row] = path_on(one.from_lane, *one.via, one.to_lane, connections=(way,))
            s_m = float(self.net.lengths_m[one.from_lane]) - gap_m - 2.0
            self.values[row] = vehicle_on(self.net, self.paths[row], s_m, speed_mps)
        self.boxes = self.values[:, : at.BOX].copy()

    def decided(self) -> list[bool]:
        self.turn.granted[:] = 0
        for row in range(2):
            junctions.count_grants(self.net, self.paths[row], self.values[row], self.turn.granted, self.turn.lights)
            junctions.find_line(self.net, self.paths[row], self.values[row], self.turn.lines[row])
        for row in range(2):
            junctions.decide(self.net, self.paths, self.boxes, self.values, row, self.turn)
        return [bool(self.paths[row, at.GRANTS]) for row in range(2)]


def test_distance_to_the_line_is_that_of_the_front() -> None:
    scene = Scene((7.5, 30.0), (3.0, 3.0))
    junctions.find_line(scene.net, scene.paths[0], scene.values[0], scene.turn.lines[0])
    assert scene.turn.lines[0].tolist() == pytest.approx([0.0, scene.ways[0], 7.5])


def test_who_must_gives_way_and_who_goes_first_goes() -> None:
    assert Scene((5.0, 8.0), (3.0, 6.0)).decided() == [False, True]


def test_who_is_far_enough_away_need_not_be_waited_for() -> None:
    scene = Scene((3.0, 60.0), (4.0, 4.0))
    assert scene.decided() == [True, False]


def test_nobody_gets_a_way_that_crosses_a_granted_one() -> None:
    scene = Scene((3.0, 60.0), (4.0, 4.0))
    scene.decided()
    scene.values[1, at.S] += 58.0
    assert scene.decided() == [True, False]


def test_who_has_stood_long_is_no_longer_waited_for() -> None:
    scene = Scene((3.0, 3.0), (0.0, 0.0))
    scene.values[1, at.STOOD] = 1.0
    assert scene.decided() == [False, True]
    scene = Scene((3.0, 3.0), (0.0, 0.0))
    scene.values[1, at.STOOD] = 2.5
    assert scene.decided() == [True, False]


def test_nobody_asks_from_afar() -> None:
    assert Scene((asking_m(10.0) + 1.0, 70.0), (10.0, 0.0)).decided() == [False, False]


@pytest.mark.parametrize(
    ("lights", "expected"),
    [
        ((STOP, STOP), [False, False]),
        ((GO, STOP), [True, False]),
        ((GO, GO), [True, False]),  # who has priority green waits for nobody
        ((GIVE_WAY, STOP), [True, False]),  # a red light need not be waited for
        ((STOP_IF_POSSIBLE, STOP), [False, False]),
    ],
)
def test_lights_decide(lights: tuple[int, int], expected: list[bool]) -> None:
    scene = Scene((5.0, 8.0), (3.0, 6.0))
    scene.turn.lights[list(scene.ways)] = lights
    assert scene.decided() == expected


def test_yellow_takes_a_grant_back_only_from_who_can_still_stop() -> None:
    for gap_m, kept in ((10.0, False), (3.0, True)):
        scene = Scene((gap_m, 90.0), (6.0, 0.0))
        assert scene.decided()[0]
        scene.turn.lights[scene.ways[0]] = STOP_IF_POSSIBLE
        scene.decided()
        assert bool(scene.paths[0, at.GRANTS]) is kept


def test_ego_inside_the_junction_blocks_the_ways_that_cross_its_own() -> None:
    scene = Scene((3.0, 60.0), (4.0, 4.0))
    boxes = np.vstack((scene.boxes, scene.boxes[:1]))
    boxes[2, at.LANE] = scene.road_map.connections[scene.ways[1]].via[0]
    scene.turn.granted[:] = 0
    junctions.count_others(scene.net, boxes, 2, scene.turn.granted)
    assert scene.turn.granted[scene.ways[1]] == 1
    for row in range(2):
        junctions.find_line(scene.net, scene.paths[row], scene.values[row], scene.turn.lines[row])
    junctions.decide(scene.net, scene.paths, boxes, scene.values, 0, scene.turn)
    assert scene.paths[0, at.GRANTS] == 0


def test_full_exit_is_not_driven_into() -> None:
    scene = Scene((3.0, 60.0), (4.0, 4.0))
    one = scene.road_map.connections[scene.ways[0]]
    scene.paths[1] = path_on(one.to_lane)
    scene.values[1] = vehicle_on(scene.net, scene.paths[1], 4.0, 0.0)
    scene.boxes = scene.values[:, : at.BOX].copy()
    assert scene.decided()[0] is False
    scene.values[1, at.S] = 20.0
    assert scene.decided()[0] is True
