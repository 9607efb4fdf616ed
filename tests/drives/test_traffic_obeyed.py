"""Drives among vehicles and people on the urban course with signals: nobody is touched, nothing is broken.

The full size drives the whole course; the sample for a minute from a side road over the lights and crossings towards
the roundabout.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.signals import FAR, Event, Mode
from simconsole.world.traffic.road_users import RoadUserKind
from tests.drives.random_courses import ASKS, SCRIPT
from tests.paths import ROOT
from tests.samples import Sample

PART = '["-junction0left", "road1", "road2", "road3", "ring0in-ring0out", "road4", "road5"]'
PART_S, WHOLE_S = 60, 420
PART_M, WHOLE_M = 250.0, 2500.0
"""So far everybody gets at least, whatever the lights show and who crosses."""
SOON = b'offset="65"'
"""With signals 25 s ahead of their time the sample waits at the first one for some seconds only."""
BY_ROS = "features: {autopilot: world.yaml}\nmode: {pacing: lockstep, answer_timeout_s: 60}\n"
RESTS = "devices: {driver: virtual, person: {sit_s: 0.5, cruise_kmh: 15, top_gear: 2, autonomy: {distance_m: 5}}}\n"
ONLY_ASKS = f"devices: {{driver: '{ASKS}'}}\n"
"""In the sample nobody rests the hands on the wheel meanwhile."""
BY_HAND = "devices: {driver: virtual, person: {sit_s: 0.5, along: route, seed: SEED}}\nmode: {pacing: free}\n"
LINK = "{seed: SEED, delay_ms: 40, localisation: {position_noise_m: 0.02, yaw_noise_deg: 0.2}}"
RULES = ("red_light", "wrong_way", "off_road", "speeding", "failing_to_yield")
MOVING_MPS = 0.5
NEAR_M = 0.8


class Among(NamedTuple):
    """How one drive went among others."""

    distance_m: float
    collisions: int
    broken: list[str]
    duties: int  # how often somebody had to be let pass
    nearest_m: float  # to the middle of somebody on foot from the outline of the moving vehicle


def driven(driver: str, seed: int, whole: bool, folder: Path) -> Path:
    folder.mkdir()
    edges = PART
    if whole:
        edges = (ROOT / "profiles/worlds/urban_signals.yaml").read_text().partition("edges: ")[2].strip().rstrip("}")
    net = (ROOT / "profiles/worlds/urban_signals.net.xml").read_bytes()
    (folder / "map.net.xml").write_bytes(net if whole else net.replace(b'offset="0"', SOON))
    (folder / "world.yaml").write_text(
        "schema: 1\nkind: roads\ntitle: among others\nmap: {name: map.net.xml}\n"
        f"route: {{by: edges, edges: {edges}}}\n"
    )
    (folder / "asks.yaml").write_text(SCRIPT)
    bridge = f"{{port: 0, link: {LINK}}}" if driver == "autopilot" else "null"
    (folder / "session.yaml").write_text(
        (
            f"schema: 1\nenvironment: {{world: world.yaml, traffic: {{pedestrians: 20, seed: {seed}}}}}\n"
            f"scenario: {{vehicle: hatchback, duration_s: {WHOLE_S if whole else PART_S}}}\n"
            f"outputs: {{hud: null, scene: null, report: false, bridge: {bridge}}}\n"
            f"{BY_ROS + (RESTS if whole else ONLY_ASKS) if driver == 'autopilot' else BY_HAND}"
        ).replace("SEED", str(seed))
    )
    return drive(resolve(load_session(str(folder / "session.yaml"))), folder / "bundle").folder


def among(folder: Path) -> Among:
    log = open_bundle(folder).log
    names = (*(f"rules.{rule}" for rule in RULES), "events.events", "situation.yield_m", "arbitration.mode")
    table = log.table((*names, "vehicle.x_m", "vehicle.y_m", "vehicle.yaw_rad", "vehicle.vx_mps", "vehicle.distance_m"))
    stops = (Mode.MINIMAL_RISK, Mode.STOPPED, Mode.EMERGENCY_STOP)
    assert not np.isin(table.column("arbitration.mode"), stops).any()
    owed = table.column("situation.yield_m") < FAR
    place = [table.column(f"vehicle.{name}") for name in ("x_m", "y_m", "yaw_rad", "vx_mps")]
    nearest = np.inf
    for at in recorded_road_users(log):
        x, y, yaw, speed = (float(column[max(at.tick - 1, 0)]) for column in place)
        people = at.users[at.users[:, 1] == RoadUserKind.PEDESTRIAN]
        if abs(speed) > MOVING_MPS and len(people):
            dx, dy = people[:, 2] - x, people[:, 3] - y
            ahead, aside = dx * np.cos(yaw) + dy * np.sin(yaw), np.abs(dy * np.cos(yaw) - dx * np.sin(yaw))
            beyond = np.maximum(np.maximum(ahead - 3.3, -0.9 - ahead), 0.0)
            nearest = min(nearest, float(np.hypot(beyond, np.maximum(aside - 0.9, 0.0)).min()))
    return Among(
        distance_m=float(table.column("vehicle.distance_m")[-1]),
        collisions=int(((table.column("events.events").astype(int) & int(Event.COLLISION)) > 0).sum()),
        broken=[rule for rule in RULES if table.column(f"rules.{rule}").any()],
        duties=int((np.diff(owed.astype(int), prepend=0) > 0).sum()),
        nearest_m=nearest,
    )


@pytest.mark.parametrize("driver", ["autopilot", "person"])
def test_nobody_is_touched_no_rule_is_broken_and_a_replay_is_equal(sample: Sample, driver: str, tmp_path: Path) -> None:
    found = []
    for number in range(sample.of(1, 20)):
        seed = (sample.seed + number) % 2**31
        found.append(among(driven(driver, seed, sample.long, tmp_path / str(number))))
        print(f"seed {seed}: {found[-1]}")
    assert replay_bundle(tmp_path / "0" / "bundle").hashes_equal, "made again to the bit"
    print(
        f"measured: {driver}: {len(found)} drives, {sum(one.distance_m for one in found):.0f} m, "
        f"{sum(one.duties for one in found)} times somebody went first, "
        f"nobody on foot nearer than {min(one.nearest_m for one in found):.2f} m"
    )
    for one in found:
        assert (one.collisions, one.broken) == (0, [])
        assert one.distance_m > (WHOLE_M if sample.long else PART_M)
        assert one.nearest_m > NEAR_M
    assert sum(one.duties for one in found) >= len(found)
