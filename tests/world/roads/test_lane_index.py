import json
import math
import subprocess
import sys
from collections.abc import Callable

import numpy as np
import pytest

from simconsole.values.host.jit import compiled, plain
from simconsole.world.roads.lane_index import HEADING_M, REACH_M, LaneIndex, LanePosition, nearest_segment
from simconsole.world.roads.road_map import Lane, RoadMap
from tests.paths import ROOT
from tests.samples import Sample
from tests.world.nets import CITY, TOWN, generated_map, straight_map

POSES = 10_000
QUERY_US = 20.0
TIMED = """
import json, sys, time
import numpy as np
from simconsole.values.host.jit import compiled
from simconsole.world.roads.lane_index import LaneIndex, nearest_segment
from tests.world.nets import CITY, generated_map
road_map = generated_map(*CITY)
cars = [place for place, lane in enumerate(road_map.lanes) if lane.drivable]
index = LaneIndex(road_map.lanes, cars, compiled(nearest_segment))
rng = np.random.default_rng(1)
poses = np.column_stack((rng.uniform(-100, 1000, (10_000, 2)), rng.uniform(-3, 3, 10_000))).tolist()
index.locate(*poses[0])
took = []
for _ in range(5):
    began = time.process_time()
    for pose in poses:
        index.locate(*pose)
    took.append((time.process_time() - began) / len(poses) * 1e6)
print(json.dumps([len(road_map.edges), min(took)]))
"""


def cars(road_map: RoadMap) -> list[int]:
    return [place for place, lane in enumerate(road_map.lanes) if lane.drivable]


def poses(road_map: RoadMap, count: int, rng: np.random.Generator) -> list[list[float]]:
    """Places on the map and up to 200 m beside it, with any heading."""
    points = np.vstack([lane.line[:, :2] for lane in road_map.lanes])
    low, high = points.min(axis=0) - 200.0, points.max(axis=0) + 200.0
    found: list[list[float]] = np.column_stack((rng.uniform(low, high, (count, 2)), rng.uniform(-4, 4, count))).tolist()
    return found


def least_cost(lane: Lane, x_m: float, y_m: float, yaw_rad: float, heading_m: float) -> float:
    """The cost of a lane by its definition, without any grid."""
    start, steps = lane.line[:-1, :2], np.diff(lane.line[:, :2], axis=0)
    lengths = np.hypot(*steps.T)
    start, forward, lengths = start[lengths > 0], (steps / lengths[:, None])[lengths > 0], lengths[lengths > 0]
    along = np.clip(((np.array((x_m, y_m)) - start) * forward).sum(axis=1), 0.0, lengths)
    away = np.hypot(*(np.array((x_m, y_m)) - start - along[:, None] * forward).T)
    cost = away + heading_m * (1.0 - forward @ (math.cos(yaw_rad), math.sin(yaw_rad)))
    return float(np.where(away <= REACH_M, cost, np.inf).min(initial=np.inf))


def cost_of(found: LanePosition, heading_m: float) -> float:
    if found.lane is None:
        return math.inf
    return abs(found.lateral_m) + heading_m * (1.0 - math.cos(found.heading_error_rad))


@pytest.mark.parametrize("heading_m", [HEADING_M, 0.0])
@pytest.mark.parametrize("options", [CITY, TOWN])
def test_every_pose_is_where_brute_force_finds_it(sample: Sample, options: tuple[str, ...], heading_m: float) -> None:
    road_map = generated_map(*options)
    index = LaneIndex(road_map.lanes, cars(road_map), compiled(nearest_segment))
    asked = poses(road_map, sample.of(500, POSES), np.random.default_rng(sample.seed))
    segments, off_map = index.segments, 0
    for x_m, y_m, yaw_rad in asked:
        found = index.locate(x_m, y_m, yaw_rad, heading_m)
        offset = np.array((x_m, y_m)) - segments[:, :2]
        along = np.clip((offset * segments[:, 2:4]).sum(axis=1), 0.0, segments[:, 4])
        away = np.hypot(*(offset - along[:, None] * segments[:, 2:4]).T)
        cost = away + heading_m * (1.0 - segments[:, 2:4] @ (math.cos(yaw_rad), math.sin(yaw_rad)))
        least = float(np.where(away <= REACH_M, cost, np.inf).min())
        off_map += math.isinf(least)
        assert cost_of(found, heading_m) == pytest.approx(least, abs=1e-6)
        if found.lane is not None:
            assert least_cost(road_map.lanes[found.lane], x_m, y_m, yaw_rad, heading_m) == pytest.approx(least)
    print(f"measured: {len(asked)} poses equal brute force, {off_map} of them off the map")
    assert off_map > 0


def test_query_takes_at_most_20_us() -> None:
    done = subprocess.run([sys.executable, "-c", TIMED], cwd=ROOT, capture_output=True, text=True, check=True)
    edges, took_us = json.loads(done.stdout)
    print(f"measured: {took_us:.1f} us per query on {edges} edges")
    assert edges >= 500
    assert took_us <= QUERY_US


@pytest.mark.parametrize("execution", [plain, compiled])
def test_lane_coordinates(execution: Callable[..., Callable[..., object]]) -> None:
    road_map = straight_map()
    index = LaneIndex(road_map.lanes, cars(road_map), execution(nearest_segment))  # type: ignore[arg-type]
    found = index.locate(110.0, -0.6, 0.1)
    assert found.lane is not None
    assert road_map.lanes[found.lane].id == "BC_0"
    assert found[1:] == pytest.approx((5.0, 1.0, 0.1, True))
    assert not index.locate(110.0, 5.0, 0.0).on_lane


@pytest.mark.parametrize("place", [(1e9, 0.0), (0.0, -150.0), (math.nan, 0.0), (math.inf, 3.0), (-1e300, 1e300)])
def test_poses_off_the_map_are_answered(place: tuple[float, float]) -> None:
    road_map = straight_map()
    for execution in (plain, compiled):
        assert LaneIndex(road_map.lanes, cars(road_map), execution(nearest_segment)).locate(*place, 0.0).lane is None


def test_map_without_lanes_answers_too() -> None:
    assert LaneIndex((), (), plain(nearest_segment)).locate(0.0, 0.0, 0.0).lane is None


def test_lane_of_the_other_direction_is_told_by_the_heading() -> None:
    there = np.array(((0.0, -1.0, 0.0), (50.0, -1.0, 0.0)))
    lanes = [
        Lane("there", 0, 0, there, 2.0, 10.0, drivable=True),
        Lane("back", 1, 0, np.add(there[::-1], (0.0, 2.0, 0.0)), 2.0, 10.0, drivable=True),
    ]
    index = LaneIndex(lanes, (0, 1), plain(nearest_segment))
    assert [index.locate(20.0, 0.0, yaw).lane for yaw in (0.0, math.pi)] == [0, 1]
    assert index.locate(20.0, -1.0, math.pi, 0.0).lane == 0  # the wrong way on it, told by the heading error
