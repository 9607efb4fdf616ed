"""The autopilot drives through traffic lights of maps that nobody made by hand, over the WebSocket, with noise."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.values.signals import FAR, SignalState
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.approaches import stop_lines
from tests.drives.random_courses import Tracked
from tests.drives.test_road_maps import BLOCKS, HAND_OVER_M, Apart, apart, driven, judge_errors
from tests.samples import Sample
from tests.world.nets import CITY, generated


class Obeyed(NamedTuple):
    """How one drive obeyed the lights."""

    lines: int  # on the route
    passed: list[int]  # the light's state at each line that the front has passed
    red_lights: int
    broken: list[str]  # other rules
    stood: list[float]  # distance of the front before a line in m, where it stood at red
    hardest_mps2: float


def obeyed(folder: Path) -> Obeyed:
    world = open_world(load_world(str(folder / "world.yaml")))
    roads = roads_of(world)
    assert roads is not None
    table = open_bundle(folder / "bundle").log.table(
        (
            "situation.lane", "situation.signal_state", "situation.signal_distance_m", "rules.red_light",
            "rules.wrong_way", "rules.off_road", "rules.speeding", "vehicle.vx_mps", "ros.accel_mps2",
        )
    )  # fmt: skip
    state, left = table.column("situation.signal_state"), table.column("situation.signal_distance_m")
    lane, speed = table.column("situation.lane"), table.column("vehicle.vx_mps")
    passed = np.flatnonzero((lane[1:] == lane[:-1]) & (left[:-1] > 0.0) & (left[1:] <= 0.0)) + 1
    stands = (speed < 0.02) & (left < 30.0) & (state == SignalState.STOP_AND_REMAIN)
    ends = np.flatnonzero(np.diff(stands.astype(int)) < 0)  # not where the route ends
    return Obeyed(
        lines=len(stop_lines(roads.road_map, roads.legs, world.route)),
        passed=state[passed].astype(int).tolist(),
        red_lights=int((np.diff(table.column("rules.red_light"), prepend=0.0) > 0.0).sum()),
        broken=[name for name in ("wrong_way", "off_road", "speeding") if table.column(f"rules.{name}").any()],
        stood=left[ends].tolist(),
        hardest_mps2=float(table.column("ros.accel_mps2").min()),
    )


def judge(found: Obeyed, drive: Tracked, errors: Apart) -> None:
    assert found.red_lights == 0
    assert found.broken == []
    assert len(found.passed) == found.lines
    assert SignalState.STOP_AND_REMAIN not in found.passed
    assert all(0.0 < left < 3.0 for left in found.stood)
    assert found.hardest_mps2 >= -2.5
    judge_errors(drive, errors)


def test_city_drives_pass_no_red_light(sample: Sample, tmp_path: Path) -> None:
    rng = np.random.default_rng(sample.seed)
    drives = []
    net, length_m = generated(*(CITY if sample.long else BLOCKS)), 500.0 if sample.long else 240.0
    hand_over_m = HAND_OVER_M if sample.long else None
    for number in range(sample.of(1, 20)):
        drive = driven(tmp_path / str(number), net, int(rng.integers(2**31)), length_m, hand_over_m)
        errors = apart(tmp_path / str(number), str(tmp_path / str(number) / "world.yaml"))
        drives.append((obeyed(tmp_path / str(number)), drive, errors))
        print(drives[-1])
    print(
        f"measured: {sum(len(found.passed) for found, _, _ in drives)} lights passed in {len(drives)} drives; "
        f"stood at {sum(len(found.stood) for found, _, _ in drives)} of them"
    )
    for found, drive, errors in drives:
        judge(found, drive, errors)
    assert sum(len(found.passed) for found, _, _ in drives) >= 3 * len(drives)
    assert any(found.stood for found, _, _ in drives)
    assert replay_bundle(tmp_path / "0" / "bundle").hashes_equal, "made again to the bit"
    table = open_bundle(tmp_path / "0" / "bundle").log.table(("situation.tick", "situation.lead_gap_m"))
    assert table.column("situation.tick").tolist() == list(range(1, len(table.column("situation.tick")) + 1))
    assert set(table.column("situation.lead_gap_m").tolist()) == {FAR}


@pytest.mark.parametrize("world", ["urban_signals", "motorway", "country", "skid_pad"])
def test_shipped_maps_have_rules(world: str) -> None:
    assert roads_of(open_world(load_world(world))) is not None
