"""The autopilot among vehicles and people of SUMO, by its signals: it touches nobody, passes no red light, yields."""

from pathlib import Path

import numpy as np

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.log_header import SIGNALS
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.signals import FAR, NO_AHEAD
from simconsole.world.traffic.road_users import RoadUserKind
from tests.drives.random_courses import SCRIPT
from tests.drives.test_traffic_obeyed import BY_ROS, LINK, ONLY_ASKS, PART, RESTS
from tests.paths import ROOT
from tests.samples import Sample

SEEDS, LONG_SEEDS = 1, 20
PART_S, LONG_S = 56, 80
SOON = b'offset="80"'
"""With signals 10 s ahead of their time the sample waits less at the first one."""
COLUMNS = (
    *("rules.red_light", "rules.collision", "rules.failing_to_yield", "vehicle.distance_m", "situation.signal_state"),
    *(f"ahead.{name}" for name in ("traffic_lost", "approach", "signal_state", "signal_tick", "yield_m")),
)
"""All columns of a drive are 150 MB."""
SUMO = "{vehicles: 30, pedestrians: 12}"


def driven(seed: int, sample: Sample, folder: Path) -> Path:
    folder.mkdir()
    net = (ROOT / "profiles/worlds/urban_signals.net.xml").read_bytes()
    (folder / "map.net.xml").write_bytes(net if sample.long else net.replace(b'offset="0"', SOON))
    (folder / "world.yaml").write_text(
        f"schema: 1\nkind: roads\ntitle: on SUMO\nmap: {{name: map.net.xml}}\nroute: {{by: edges, edges: {PART}}}\n"
    )
    (folder / "asks.yaml").write_text(SCRIPT)
    (folder / "session.yaml").write_text(
        f"schema: 1\nenvironment: {{world: world.yaml, traffic: {{seed: {seed}, sumo: {SUMO}}}}}\n"
        f"scenario: {{vehicle: hatchback, duration_s: {sample.of(PART_S, LONG_S)}}}\n"
        "outputs: {hud: null, scene: null, report: false, bridge: {port: 0, link: "
        f"{LINK.replace('SEED', str(seed))}}}}}\n{BY_ROS}{RESTS if sample.long else ONLY_ASKS}"
    )
    return drive(resolve(load_session(str(folder / "session.yaml"))), folder / "bundle").folder


def test_nobody_is_touched_and_no_red_light_is_passed(tmp_path: Path, sample: Sample) -> None:
    owed = 0
    for number in range(sample.of(SEEDS, LONG_SEEDS)):
        owed += judge(driven((sample.seed + number) % 2**31, sample, tmp_path / f"drive{number}"))
    assert owed, "somebody had to be let pass"


def judge(folder: Path) -> int:
    """Judge a drive, and return in how many ticks somebody had to be let pass."""
    bundle = open_bundle(folder)
    table = bundle.log.table(COLUMNS)
    assert bundle.manifest.summary["unanswered"] == 0
    assert not table.column("rules.red_light").any()
    assert not table.column("rules.collision").any()
    assert not table.column("rules.failing_to_yield").any()
    assert not table.column("ahead.traffic_lost").any()
    assert table.column("vehicle.distance_m")[-1] > 150.0
    told = [at.users for at in recorded_road_users(bundle.log)]
    assert max(map(len, told)) > 3
    assert any((users[:, 1] == RoadUserKind.PEDESTRIAN).any() for users in told)
    assert list(bundle.log.messages(SIGNALS))
    seen = table.column("ahead.approach") > 0.0
    assert seen.any()
    same = table.column("situation.signal_state")[seen] == table.column("ahead.signal_state")[seen]
    assert np.mean(same) > 0.99, "but for changes of lanes"
    assert (table.column("ahead.signal_tick")[seen] < FAR).any()
    assert replay_bundle(bundle.folder).hashes_equal
    return int(np.count_nonzero(table.column("ahead.yield_m") < NO_AHEAD.yield_m))
