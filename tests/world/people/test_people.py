"""People of a map: as many as asked for, by the seed, at a walking pace, and never in front of anybody's wheels."""

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.traffic import TrafficProfile
from simconsole.values.host.jit import compiled, plain
from simconsole.world.kinds.worlds import open_map
from simconsole.world.people.people import FASTEST_MPS, PACE_DEVIATION_MPS, PACE_MPS, SLOWEST_MPS, People
from simconsole.world.people.walking import PACE
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.traffic.collisions import overlapping
from simconsole.world.traffic.road_users import RoadUserKind
from simconsole.world.traffic.traffic import Traffic
from tests.samples import Sample
from tests.world.nets import CITY, generated_map, straight_map


def urban() -> RoadMap:
    return open_map(load_world("urban_signals"))  # type: ignore[arg-type]  # it is a road map


def test_paces_are_those_of_people() -> None:
    paces = np.array([People(urban(), 30, seed, plain).rows[:, PACE] for seed in range(10)])
    assert paces.mean() == pytest.approx(PACE_MPS, abs=0.1)
    assert paces.std() == pytest.approx(PACE_DEVIATION_MPS, abs=0.08)
    assert paces.min() >= SLOWEST_MPS
    assert paces.max() <= FASTEST_MPS


def test_nobody_walks_where_there_is_no_crossing() -> None:
    assert len(People(straight_map(), 10, 1, plain).rows) == 0


@pytest.mark.parametrize("name", ["urban", "city"])
def test_people_cross_and_no_vehicle_touches_them(sample: Sample, name: str) -> None:
    road_map = urban() if name == "urban" else generated_map(*CITY)
    for number in range(sample.of(1, 8)):
        seed = (sample.seed + number) % 2**31
        traffic = Traffic(road_map, TrafficProfile(vehicles=30, pedestrians=30, seed=seed), compiled)
        seen: set[float] = set()
        for step in range(round(60.0 * sample.of(3, 10) / traffic.period_s)):
            rows = traffic.step(None)
            walks = rows[:, 1] == RoadUserKind.PEDESTRIAN
            seen.update(rows[walks, 0].tolist())
            if step % 3 == 0:
                touched = [pair for pair in overlapping(rows) if not walks[list(pair)].all()]
                assert touched == [], f"seed {seed}, step {step}"
        print(f"measured: {name}: {len(seen)} people have come in {step * traffic.period_s:.0f} s")
        assert len(seen) > 60


def test_equal_seeds_give_equal_bits_compiled_or_not() -> None:
    profile = TrafficProfile(vehicles=6, parked=0, pedestrians=12, seed=4)
    first, second, third = (Traffic(urban(), profile, how) for how in (compiled, compiled, plain))
    other = Traffic(urban(), TrafficProfile(vehicles=6, parked=0, pedestrians=12, seed=5), compiled)
    for _ in range(250):
        rows = [traffic.step(None) for traffic in (first, second, third, other)]
    assert rows[0].tobytes() == rows[1].tobytes() == rows[2].tobytes()
    assert rows[0].tobytes() != rows[3].tobytes()
