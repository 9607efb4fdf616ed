"""The autopilot drives random routes over maps that nobody made by hand, and the shipped road maps, to their ends."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session, replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.values.signals import Mode
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_map import ROAD
from simconsole.world.roads.road_world import roads_of
from tests.drives.random_courses import SETTLED_M, Tracked, tracked_on
from tests.samples import Sample
from tests.world.nets import CITY, SMALL, TOWN, generated

LINK = "{seed: SEED, delay_ms: 40, localisation: {position_noise_m: 0.02, yaw_noise_deg: 0.2}}"
RMS_CM = 3.0
"""Outside junctions; inside them the other one."""
INSIDE_CM = 10.0
SMALLER = {"8": "3", "120": "80"}  # junctions of the grid, and m between two
BLOCKS = (*(SMALLER.get(word, word) for word in CITY), "--tls.cycle.time", "40")
VILLAGE = tuple("12" if word == "120" else word for word in TOWN)
"""The sample drives over these maps, which are smaller than CITY and TOWN."""
PAD_M = 480.0
"""From here the sample drives on the skid pad: a straight, the bend, and the end."""
HAND_OVER_M = 5.0
"""The person drives straight on: as far as every route does."""


class Apart(NamedTuple):
    """RMS of the errors of one drive, in cm, on roads and inside junctions; by base_link's lane."""

    outside_cm: float
    inside_cm: float


def apart(folder: Path, world: str) -> Apart:
    """Measure a drive that the autopilot has taken over, once it has settled."""
    opened = open_world(load_world(world))
    roads = roads_of(opened)
    assert roads is not None
    names = ("arbitration.mode", "vehicle.x_m", "vehicle.y_m", "vehicle.distance_m", "situation.edge")
    table = open_bundle(folder / "bundle").log.table(names)
    mode, x, y, distance, edge = (table.column(name) for name in names)
    driven = mode == float(Mode.AUTONOMOUS)
    settled = driven & (distance > distance[np.flatnonzero(driven)[0]] + SETTLED_M)
    on_road = np.array([one.function == ROAD for one in roads.road_map.edges])[edge.astype(int)]
    squares = np.square(100.0 * opened.route.project_all(x, y, 0.0)[1])
    outside, inside = (squares[settled & (on_road == value)] for value in (True, False))
    return Apart(float(np.sqrt(outside.mean())), float(np.sqrt(inside.mean())) if len(inside) else 0.0)


def driven(folder: Path, net: bytes, seed: int, length_m: float, hand_over_m: float | None = None) -> Tracked:
    folder.mkdir()
    (folder / "map.net.xml").write_bytes(net)
    (folder / "world.yaml").write_text(
        "schema: 1\nkind: roads\ntitle: random\nmap: {name: map.net.xml}\n"
        f"route: {{by: random, seed: {seed}, length_m: {length_m}}}\n"
    )
    route = open_world(load_world(str(folder / "world.yaml"))).route
    return tracked_on(route, "world.yaml", "hatchback", LINK.replace("SEED", str(seed)), folder, hand_over_m)


def on_shipped(world: str, folder: Path, start_m: float = 0.0) -> Tracked:
    route = open_world(load_world(world)).route
    return tracked_on(route, world, "hatchback", LINK.replace("SEED", "1"), folder, HAND_OVER_M, start_m=start_m)


def judge(done: Tracked) -> None:
    assert not done.stopped
    assert done.rms_cm <= RMS_CM
    assert -0.5 < done.left_m < 3.0
    assert done.longitudinal_kept >= 0.999


def judge_errors(done: Tracked, errors: Apart) -> None:
    judge(done)
    assert errors.outside_cm <= RMS_CM
    assert errors.inside_cm <= INSIDE_CM


def test_random_routes(sample: Sample, tmp_path: Path) -> None:
    """The sample drives over a town; over a city it does in tests/drives/test_traffic_lights.py."""
    rng = np.random.default_rng(sample.seed)
    count, length_m, maps = (50, 800.0, (TOWN, CITY)) if sample.long else (1, 250.0, (VILLAGE,))
    hand_over_m = HAND_OVER_M if sample.long else None
    all_done, all_apart = list[Tracked](), list[Apart]()
    for number in range(count):
        net = generated(*maps[number % len(maps)])
        folder = tmp_path / str(number)
        all_done.append(driven(folder, net, int(rng.integers(2**31)), length_m, hand_over_m))
        all_apart.append(apart(folder, str(folder / "world.yaml")))
        print(all_done[-1], all_apart[-1])
    worst_rms, worst = max(one.rms_cm for one in all_done), max(one.max_cm for one in all_done)
    outside, inside = (max(one[place] for one in all_apart) for place in range(2))
    print(
        f"measured: {count} routes over road maps: RMS at most {worst_rms:.2f} cm, max {worst:.1f} cm; "
        f"RMS outside junctions at most {outside:.2f} cm, inside {inside:.2f} cm; "
        f"commands within the jerk {100.0 * min(one.longitudinal_kept for one in all_done):.2f} %"
    )
    assert np.mean([one.lateral_kept for one in all_done]) >= 0.999
    for one, errors in zip(all_done, all_apart, strict=True):
        judge_errors(one, errors)


@pytest.mark.parametrize("world", ["skid_pad"])
def test_shipped_roads_are_driven_to_their_end(sample: Sample, world: str, tmp_path: Path) -> None:
    judge(on_shipped(world, tmp_path, 0.0 if sample.long else PAD_M))


@pytest.mark.parametrize("world", ["urban_signals", "motorway", "country"])
def test_long_shipped_roads_are_driven_to_their_end(sample: Sample, world: str, tmp_path: Path) -> None:
    assert open_world(load_world(world)).route.length_m > 500.0
    if sample.long:
        judge(on_shipped(world, tmp_path))


def test_bundle_holds_the_map_once_and_needs_no_other_file(tmp_path: Path) -> None:
    net = generated(*SMALL)
    driven(tmp_path / "drive", net, 5, 60.0)
    for name in ("map.net.xml", "world.yaml"):
        (tmp_path / "drive" / name).unlink()
    bundle = tmp_path / "drive" / "bundle"
    (held,) = bundle.glob("map.*")
    assert held.name.endswith(".net.xml.gz")
    assert held.stat().st_size < 0.2 * len(net)
    assert verify(bundle) == []
    assert replay_bundle(bundle).problems == ()
    world = recorded_session(open_bundle(bundle)).world
    assert world is not None
    assert open_world(world).route.length_m >= 60.0
    held.write_bytes(held.read_bytes()[:-9] + b"x" * 9)
    assert verify(bundle) != []
