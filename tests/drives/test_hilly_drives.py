"""Whole drives over hills: the first 950 m of the shipped country road, up to 42 m, by a program and by a person."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from simconsole.profiles.files.loader import profiles_folder
from simconsole.profiles.files.world_files import load_world
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.height_field import spline_at
from simconsole.values.signals import Mode
from simconsole.world.kinds.worlds import open_world
from simconsole.world.world import World
from tests.drives.random_courses import tracked_on
from tests.samples import Sample

PART_M = 550.0
"""From here the sample drives: over the top of the hill, to the end."""
HALF_LANE_M = 1.625
HALF_CAR_M = 0.9


def hills(folder: Path) -> World:
    """Write the first edge of the country road as a world of its own."""
    shutil.copy(profiles_folder() / "worlds" / "country.net.xml", folder / "map.net.xml")
    (folder / "world.yaml").write_text(
        "schema: 1\nkind: roads\ntitle: hills\nmap: {name: map.net.xml}\n"
        'route: {by: edges, edges: ["valley-chapel"]}\nground: {bank_percent: 5}\n'
    )
    return open_world(load_world(str(folder / "world.yaml")))


def judge_pose(bundle: Path, world: World) -> float:
    """Compare height and lean with the field under the car; return how high it came, in m."""
    names = ("vehicle.x_m", "vehicle.y_m", "vehicle.z_m", "vehicle.yaw_rad", "vehicle.pitch_rad", "vehicle.roll_rad")
    table = open_bundle(bundle).log.table(names)
    x, y, z, yaw, pitch, roll = (table.column(name) for name in names)
    assert world.ground is not None
    assert z == pytest.approx(spline_at(world.ground, 0, x, y), abs=0.02)
    ahead_x, ahead_y = np.cos(yaw), np.sin(yaw)
    front = spline_at(world.ground, 0, x + 2.5 * ahead_x, y + 2.5 * ahead_y)
    left = spline_at(world.ground, 0, x - 0.7 * ahead_y, y + 0.7 * ahead_x)
    right = spline_at(world.ground, 0, x + 0.7 * ahead_y, y - 0.7 * ahead_x)
    assert np.abs(pitch + np.arctan((front - z) / 2.5)).max() < 0.03, "beyond the road it leans on its springs"
    assert np.abs(roll - np.arctan((left - right) / 1.4)).max() < 0.05
    return float(z.max())


def test_the_autopilot_drives_over_hills_to_the_end(sample: Sample, tmp_path: Path) -> None:
    world = hills(tmp_path)
    link = "{seed: 3, delay_ms: 40, localisation: {position_noise_m: 0.02, yaw_noise_deg: 0.2}}"
    hand_over_m, start_m = (5.0, 0.0) if sample.long else (None, PART_M)
    done = tracked_on(world.route, "world.yaml", "hatchback", link, tmp_path, hand_over_m, start_m=start_m)
    print(f"measured: {done}, up to {judge_pose(tmp_path / 'bundle', world):.1f} m")
    assert not done.stopped
    assert done.rms_cm < 3.0
    assert -0.5 < done.left_m < 3.0
    assert replay_bundle(tmp_path / "bundle").problems == ()


def test_a_person_drives_up_the_hill_in_their_lane(tmp_path: Path) -> None:
    world = hills(tmp_path)
    (tmp_path / "session.yaml").write_text(
        "schema: 1\nenvironment: {world: world.yaml}\nscenario: {vehicle: hatchback, duration_s: 40}\n"
        "outputs: {hud: null, scene: null, report: false}\n"
        "devices:\n  driver: virtual\n"
        "  person: {along: route, cruise_kmh: 70, top_gear: 4, sit_s: 0.3, seed: 2}\n"
        "mode: {pacing: free}\n"
    )
    drive(resolve(load_session(str(tmp_path / "session.yaml"))), tmp_path / "bundle")
    assert judge_pose(tmp_path / "bundle", world) > 5.0
    table = open_bundle(tmp_path / "bundle").log.table(
        ("vehicle.x_m", "vehicle.y_m", "vehicle.vx_mps", "arbitration.mode")
    )
    x, y = table.column("vehicle.x_m"), table.column("vehicle.y_m")
    _, lateral = world.route.project_all(x, y, 0.0)
    assert np.abs(lateral).max() + HALF_CAR_M < HALF_LANE_M
    assert table.column("vehicle.vx_mps")[-1] > 8.0
    assert set(table.column("arbitration.mode")[5000:].tolist()) == {float(Mode.MANUAL)}
    assert replay_bundle(tmp_path / "bundle").problems == ()
