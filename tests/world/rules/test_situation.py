"""What lies ahead of a vehicle that moves over a map."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from simconsole.values.host.jit import compiled, plain
from simconsole.values.kernels import Row
from simconsole.values.layout import write
from simconsole.values.signals import FAR, NO_AHEAD, NO_SITUATION, SignalState, Situation, VehicleState
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from simconsole.values.trigonometry import direction
from simconsole.world.roads.lane_graph import LaneGraph, Leg
from simconsole.world.roads.lane_index import Found
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.roads.road_route import route_over
from simconsole.world.rules.road_rules import RoadRules, road_rules
from simconsole.world.rules.situation import OWN, Lead, look_around, place_of, situation_at, time_to_collision
from simconsole.world.rules.timetable import Signals
from tests.world.nets import CITY, generated_map, straight_map

HZ = 50
FRONT_M = 3.4
Execution = Callable[[Callable[..., Any]], Callable[..., Any]]
STANDING = VehicleState(*(0.0,) * len(VehicleState._fields))


class Mover:
    """A vehicle that is put somewhere in each tick."""

    def __init__(self, rules: RoadRules, execution: Execution = plain) -> None:
        self.rules, self._look = rules, execution(look_around)
        self.row: Row = np.zeros(PLATFORM_AT)
        write(self.row, LAYOUT.situation, NO_SITUATION)

    def at(self, x_m: float, y_m: float, yaw_rad: float, speed_mps: float = 10.0) -> Snapshot:
        row = np.zeros(PLATFORM_AT)
        write(row, LAYOUT.ahead, NO_AHEAD)
        write(row, LAYOUT.vehicle, STANDING._replace(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad, vx_mps=speed_mps))
        self._look(self.row, row, self.rules, 1.0 / HZ)
        self.row = row
        return Snapshot(int(row[LAYOUT.situation.at("tick")]), HZ, row)


def city() -> tuple[RoadMap, list[Leg]]:
    road_map = generated_map(*CITY)
    return road_map, LaneGraph(road_map).drawn(3, 900.0)


def test_lane_limit_and_offset_are_those_of_the_map() -> None:
    road_map = straight_map()
    mover = Mover(road_rules(road_map, (), HZ, FRONT_M))
    seen = mover.at(110.0, -0.6, 0.1).situation
    assert road_map.lanes[int(seen.lane)].id == "BC_0"
    assert road_map.edges[int(seen.edge)].id == "BC"
    assert (seen.tick, seen.lane_s_m, seen.lateral_m) == (1.0, pytest.approx(5.0), pytest.approx(1.0))
    assert seen.speed_limit_mps == pytest.approx(8.33)
    assert (seen.signal_state, seen.signal_distance_m, seen.lead_gap_m, seen.time_to_collision_s) == (0, FAR, FAR, FAR)


def test_off_the_map_there_is_nothing_and_the_vehicle_is_off_the_road() -> None:
    mover = Mover(road_rules(straight_map(), (), HZ, FRONT_M))
    for _ in range(HZ):
        snapshot = mover.at(5000.0, 0.0, 0.0)
    assert snapshot.situation == NO_SITUATION._replace(tick=float(HZ))
    assert snapshot.rules.off_road == 1.0
    assert mover.at(math.nan, 0.0, 0.0).situation.lane == -1.0


@pytest.mark.parametrize("execution", [plain, compiled])
def test_drive_along_the_route_sees_each_signal_of_it_and_tells_red_ones(execution: Execution) -> None:
    """The vehicle ignores all signals: the events are those stop lines that its front passes at red, no others."""
    road_map, legs = city()
    route = route_over(road_map, legs)
    mover, signals = Mover(road_rules(road_map, legs, HZ, FRONT_M), execution), Signals(road_map.signals, HZ)
    told, passed_red, before = [], [], None
    turns = [leg.connection for leg in legs if leg.connection is not None and leg.connection.signal >= 0]
    step_m = 0.2
    for number in range(int(route.length_m / step_m)):
        point = route.at(number * step_m)
        snapshot = mover.at(point.x_m, point.y_m, point.yaw_rad)
        seen = snapshot.situation
        now = (seen.lane, seen.signal_distance_m)
        turn = next((one for one in turns if one.from_lane == seen.lane), None)
        if turn is not None:
            link = signals.link(turn.signal, turn.link, snapshot.tick)
            assert seen.signal_state == link.state
            assert seen.signal_change_s == pytest.approx(link.change_s)
            end = road_map.lanes[turn.from_lane].line[-1]
            away = math.hypot(end[0] - point.x_m, end[1] - point.y_m)
            assert seen.signal_distance_m == pytest.approx(away - FRONT_M, abs=0.3)
        if before is not None and before[0] == now[0] and before[1] > 0.0 >= now[1]:
            passed_red.append((snapshot.tick, seen.signal_state == SignalState.STOP_AND_REMAIN))
        if snapshot.rules.red_light and snapshot.rules.red_light_s == 0.0:
            told.append(snapshot.tick)
        before = now
        assert not snapshot.rules.off_road
        assert not snapshot.rules.wrong_way
    assert len(passed_red) == len(turns)
    assert told == [tick for tick, red in passed_red if red]
    assert 0 < len(told) < len(turns)


def test_against_the_lanes_is_the_wrong_way() -> None:
    road_map, legs = city()
    route = route_over(road_map, legs)
    mover = Mover(road_rules(road_map, (), HZ, FRONT_M))
    point = route.at(5.0)
    for number in range(2 * HZ):
        rules = mover.at(
            point.x_m + 0.1 * number * math.cos(point.yaw_rad),
            point.y_m + 0.1 * number * math.sin(point.yaw_rad),
            point.yaw_rad + math.pi,
        ).rules
    assert (rules.wrong_way, rules.off_road) == (1.0, 0.0)


def test_kernels_alone_agree() -> None:
    rules = road_rules(straight_map(), (), HZ, FRONT_M)
    lead = Lead(gap_m=20.0, speed_mps=5.0, contact_s=4.0, yield_m=12.0, yield_s=3.0)
    assert situation_at(Found(0.0, 1.0, 0.2), 7.0, rules, lead, OWN, 0.02)[-2:] == (12.0, 3.0)
    nowhere = Found(-1.0, 0.0, 0.0)
    assert situation_at(nowhere, 7.0, rules, lead, OWN, 0.02) == compiled(situation_at)(
        nowhere, 7.0, rules, lead, OWN, 0.02
    )
    assert isinstance(situation_at(Found(0.0, 1.0, 0.2), 7.0, rules, lead, OWN, 0.02), Situation)
    assert place_of(Found(0.0, 1.0, 0.2), direction(0.3), STANDING, rules).along == pytest.approx(math.cos(0.3))


@pytest.mark.parametrize(
    ("gap_m", "lead_mps", "contact_s"),
    [(25.0, 10.0, 5.0), (25.0, -10.0, 1.0), (25.0, 15.0, FAR), (25.0, 20.0, FAR), (FAR, 0.0, FAR), (0.0, 10.0, 0.0)],
)
def test_time_to_collision_is_that_of_a_gap_that_closes(gap_m: float, lead_mps: float, contact_s: float) -> None:
    ahead = NO_AHEAD._replace(lead_gap_m=gap_m, lead_speed_mps=lead_mps)
    assert time_to_collision(ahead, 15.0) == contact_s
    assert compiled(time_to_collision)(ahead, 15.0) == contact_s
