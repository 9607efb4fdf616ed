"""The traffic lights of a map as they are told."""

import math

import numpy as np

from simconsole.values.signals import SignalState
from simconsole.world.rules.road_signals import IN_REACH_M, NEVER_S, RoadSignals
from simconsole.world.rules.timetable import Signals
from tests.world.nets import CITY, generated_map, straight_map

HZ = 250


def test_what_is_told_is_what_each_link_shows() -> None:
    road_map = generated_map(*CITY)
    told, signals = RoadSignals(road_map, HZ), Signals(road_map.signals, HZ)
    changes = 0
    for number in range(3):
        for tick in range(0, 100 * HZ, 3 * HZ + 1):
            shown = told.shown(number, tick)
            assert shown.id == road_map.signals[number].id
            for link, state in enumerate(shown.states):
                own = signals.link(number, link, tick)
                assert (state, shown.next_states[link]) == (own.state, own.next_state)
                never = shown.change_s[link] == NEVER_S
                assert never or shown.change_s[link] == own.change_s
                changes += not never
    assert changes > 1000


def test_times_of_green_are_those_of_the_program() -> None:
    """Against what is shown, tick by tick."""
    road_map = generated_map(*CITY)
    told = RoadSignals(road_map, 10)
    states = np.array([told.shown(0, tick).states for tick in range(4000)])
    green = (states == SignalState.PERMISSIVE_MOVEMENT_ALLOWED) | (states == SignalState.PROTECTED_MOVEMENT_ALLOWED)
    assert len(set(green.mean(axis=0))) > 1
    for tick in range(0, 1500, 7):
        shown = told.shown(0, tick)
        for link in range(states.shape[1]):
            changes = np.flatnonzero(np.diff(green[tick:, link].astype(int))) + 1
            ends = [0, *changes] if green[tick, link] else list(changes)
            times = (shown.green_from_s, shown.green_to_s, shown.later_green_from_s, shown.later_green_to_s)
            assert [round(10.0 * one[link]) for one in times] == ends[:4]


def test_only_those_within_reach_are_told() -> None:
    road_map = generated_map(*CITY)
    told = RoadSignals(road_map, HZ)
    x, y = road_map.junctions[0].x_m, road_map.junctions[0].y_m
    found = {one.id for one in told.in_reach(x, y, 0)}
    assert 0 < len(found) < len(road_map.signals)
    for signal in road_map.signals:
        places = [line for line in told.stop_lines if line.signal == signal.id]
        assert (signal.id in found) == any(math.hypot(at.x_m - x, at.y_m - y) <= IN_REACH_M for at in places)
    assert told.in_reach(1e6, 0.0, 0) == []


def test_stop_lines_are_the_ends_of_lanes_with_all_their_links() -> None:
    road_map = generated_map(*CITY)
    lanes = {lane.id: lane for lane in road_map.lanes}
    told = RoadSignals(road_map, HZ)
    assert len({line.lane for line in told.stop_lines}) == len(told.stop_lines)
    for line in told.stop_lines:
        assert (line.x_m, line.y_m) == tuple(lanes[line.lane].line[-1, :2])
        assert line.links
        assert line.width_m == lanes[line.lane].width_m
    covered = sum(len(line.links) for line in told.stop_lines)
    assert covered == sum(one.signal >= 0 and road_map.lanes[one.from_lane].drivable for one in road_map.connections)


def test_map_without_lights_has_none() -> None:
    told = RoadSignals(straight_map(), HZ)
    assert (told.stop_lines, told.in_reach(0.0, 0.0, 0)) == ((), [])
    assert SignalState.UNAVAILABLE == 0
