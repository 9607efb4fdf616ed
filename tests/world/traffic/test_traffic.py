"""Traffic as a whole: nobody touches anybody, everybody obeys, equal seeds give equal bits."""

import math
from itertools import pairwise

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.traffic import LeadVehicle, SpeedFrom, TrafficProfile
from simconsole.values.host.jit import compiled, plain
from simconsole.values.trigonometry import wrap_angle
from simconsole.world.kinds.worlds import open_map
from simconsole.world.roads.lane_graph import LaneGraph
from simconsole.world.roads.lane_index import LaneIndex, nearest_segment
from simconsole.world.roads.road_map import Array, RoadMap
from simconsole.world.roads.road_route import route_over
from simconsole.world.traffic.collisions import overlapping
from simconsole.world.traffic.road_users import Box, users
from simconsole.world.traffic.traffic import Traffic
from tests.bits import difference
from tests.samples import Sample
from tests.world.nets import CITY, SMALL, TOWN, generated_map, straight_map

BY_RULE = ("--rand", "--rand.iterations", "60", "--seed", "9", "--default-junction-type", "right_before_left")
SIGNALLED = ("--grid", "--grid.number", "3", "--grid.length", "80", "--default-junction-type", "traffic_light")
MAPS = {"city": CITY, "town": TOWN, "small": SMALL, "right before left": BY_RULE}


def traffic_on(road_map: RoadMap, seed: int, vehicles: int = 30, ego: Box | None = None) -> Traffic:
    return Traffic(road_map, TrafficProfile(seed=seed, vehicles=vehicles), compiled, ego=ego)


def box(x_m: float, y_m: float, yaw_rad: float, speed_mps: float = 0.0) -> Box:
    return Box(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad, speed_mps=speed_mps, length_m=4.5, width_m=1.8)


@pytest.mark.parametrize("name", MAPS)
def test_nobody_touches_anybody_and_everybody_gets_on(sample: Sample, name: str) -> None:
    road_map = generated_map(*MAPS[name])
    for number in range(sample.of(2, 10)):
        traffic = traffic_on(road_map, sample.seed % 2**31 + number)
        steps = round(60.0 * sample.of(3, 10) / traffic.period_s)
        driven: dict[float, float] = {}
        for step in range(steps):
            rows = traffic.step(None)
            if step % 3 == 0:
                assert overlapping(rows) == [], f"seed {sample.seed % 2**31 + number}, step {step}"
            for number_, speed in rows[:, (0, 5)].tolist():
                driven[number_] = driven.get(number_, 0.0) + speed * traffic.period_s
        moving = [way for number_, way in driven.items() if number_ > 9]  # the first are parked
        print(f"measured: {name}: mean way of a vehicle {np.mean(moving):.0f} m in {steps * traffic.period_s:.0f} s")
        assert len(rows) >= 30
        assert np.mean(moving) > 100.0


def test_nobody_stands_for_ever_where_a_lane_ends(sample: Sample) -> None:
    road_map = open_map(load_world("motorway"))  # type: ignore[arg-type]  # it is a road map
    for number in range(sample.of(1, 8)):
        traffic = traffic_on(road_map, 100 + number)
        stood: dict[float, float] = {}
        for _ in range(round(240.0 / traffic.period_s)):
            rows = traffic.step(None)
            for user in users(rows):
                waits = stood.get(user.id, 0.0) + traffic.period_s if user.speed_mps < 0.3 else 0.0
                stood[user.id] = waits
                assert waits < 90.0 or user.id <= 9  # the first are parked
        assert overlapping(rows) == []


def test_equal_seeds_give_equal_bits_and_others_do_not() -> None:
    road_map = generated_map(*SMALL)

    def driven(seed: int) -> bytes:
        traffic = traffic_on(road_map, seed)
        return b"".join(traffic.step(None).tobytes() for _ in range(500))

    assert driven(4) == driven(4)
    assert driven(4) != driven(5)


def test_plain_and_compiled_execution_give_equal_bits() -> None:
    road_map = generated_map(*SMALL)
    profile = TrafficProfile(seed=3, vehicles=6)
    one, other = Traffic(road_map, profile, compiled), Traffic(road_map, profile, plain)
    for _ in range(50):
        assert not difference(one.step(None), other.step(None))


def test_vehicles_keep_to_the_centre_of_lanes_outside_changes(sample: Sample) -> None:
    road_map = generated_map(*SMALL)  # one lane each way: nobody changes
    cars = [place for place, lane in enumerate(road_map.lanes) if lane.drivable]
    index = LaneIndex(road_map.lanes, cars, compiled(nearest_segment))
    traffic = Traffic(road_map, TrafficProfile(seed=sample.seed % 2**31, parked=0), compiled)
    off = [
        abs(index.locate(user.x_m, user.y_m, user.yaw_rad).lateral_m)
        for _ in range(1000)
        for user in users(traffic.step(None))
    ]
    assert max(off) < 0.6  # where lanes bend, the middle between two axles cuts the corner
    assert float(np.median(off)) < 0.02


def stop_line_passes(road_map: RoadMap, tables: list[Array], period_s: float) -> list[tuple[str, float]]:
    """Which letter each vehicle saw whose middle went from a lane before a signal into the junction."""
    cars = [place for place, lane in enumerate(road_map.lanes) if lane.drivable]
    index = LaneIndex(road_map.lanes, cars, compiled(nearest_segment))
    by_via = {one.via[0]: one for one in road_map.connections if one.signal >= 0 and one.via}
    seen: list[tuple[str, float]] = []
    for number, (before, after) in enumerate(pairwise(tables)):
        was = {user.id: index.locate(user.x_m, user.y_m, user.yaw_rad).lane for user in users(before)}
        for user in users(after):
            lane = index.locate(user.x_m, user.y_m, user.yaw_rad).lane
            one = by_via.get(lane) if lane is not None else None
            if one is None or was.get(user.id) != one.from_lane:
                continue
            program = road_map.signals[one.signal].programs[0]
            left = (number * period_s - program.offset_s) % sum(phase.duration_s for phase in program.phases)
            for phase in program.phases:
                if left < phase.duration_s:
                    seen.append((phase.state[one.link], user.speed_mps))
                    break
                left -= phase.duration_s
    return seen


def test_signals_are_obeyed() -> None:
    road_map = generated_map(*SIGNALLED)
    traffic = Traffic(road_map, TrafficProfile(seed=2, parked=0), compiled)
    tables = [traffic.step(None) for _ in range(4000)]
    seen = [letter for letter, _ in stop_line_passes(road_map, tables, traffic.period_s)]
    print(
        f"measured: {len(seen)} passes: {', '.join(f'{letter} {seen.count(letter)}' for letter in sorted(set(seen)))}"
    )
    assert len(seen) > 50
    # The front passes the line two metres before the middle does: that may be at the beginning of red.
    assert seen.count("r") <= 0.05 * len(seen)


def test_the_ego_is_an_obstacle() -> None:
    road_map = straight_map()
    ego = box(60.0, -1.6, 0.0)
    traffic = Traffic(road_map, TrafficProfile(seed=1, vehicles=4, parked=0), compiled, ego=ego)
    for _ in range(2000):
        rows = traffic.step(ego)
        assert overlapping(np.vstack((rows, [(-1.0, 1.0, 60.0, -1.6, 0.0, 0.0, 4.5, 1.8, 1.5, 0.0, 0.0)]))) == []
    behind = [user for user in users(rows) if user.x_m < 60.0]
    assert behind
    nearest = max(user.x_m + 0.5 * user.length_m for user in behind)
    assert 60.0 - 2.25 - nearest == pytest.approx(2.0, abs=0.5)


def test_lead_vehicle_drives_its_script_whatever_is_before_it() -> None:
    road_map = generated_map(*TOWN)
    route = route_over(road_map, LaneGraph(road_map).drawn(3, 800.0))
    start = route.at(0.0)
    lead = LeadVehicle(gap_m=30.0, speeds=(SpeedFrom(speed_kmh=36.0), SpeedFrom(from_s=20.0, speed_kmh=18.0)))
    profile = TrafficProfile(vehicles=0, parked=0, lead=lead)
    traffic = Traffic(road_map, profile, compiled, route=route, ego=box(start.x_m, start.y_m, start.yaw_rad))
    speeds = [users(traffic.step(None))[0].speed_mps for _ in range(1000)]
    assert speeds[450] == pytest.approx(10.0)
    assert speeds[-1] == pytest.approx(5.0)
    user = users(traffic.road_users())[0]
    there = route.project(user.x_m, user.y_m)
    assert there.lateral_m == pytest.approx(0.0, abs=1e-3)
    assert there.s_m == pytest.approx(30.0 + 10.0 * 20.0 - 25.0 + 5.0 * 20.0 + 6.25, rel=1e-2)
    assert wrap_angle(user.yaw_rad - route.at(there.s_m).yaw_rad) == pytest.approx(0.0, abs=1e-3)


def test_ids_are_nobody_elses() -> None:
    traffic = traffic_on(straight_map(), 1, vehicles=4)
    seen: dict[float, float] = {}
    for _ in range(3000):
        rows = traffic.step(None)
        ids = rows[:, 0].tolist()
        assert len(set(ids)) == len(ids)
        for number, length in rows[:, (0, 6)].tolist():
            assert seen.setdefault(number, length) == length
    assert len(seen) > 6  # some have left the map, others came
    assert math.isfinite(float(rows.sum()))
