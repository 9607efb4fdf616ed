"""The use case of three robots by one command: all tasks are done, nobody touches anything, everything replays."""

import json
import os
from pathlib import Path
from typing import Any

import pytest

from simconsole.cli.main import parser
from simconsole.cli.turtlebot.turtlebot_command import failing
from simconsole.drivers.robots.navigation.planner import KEEP_M
from simconsole.profiles.faults import Silent
from simconsole.profiles.files.loader import profiles_folder
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.session.fleet.members import members
from simconsole.session.resolution import load_session, override, resolve
from simconsole.values.errors import ProfileError
from tests.drives.console import complaint, results, simconsole
from tests.samples import Sample

CPU_S = 150.0
SHIPPED = profiles_folder() / "sessions" / "turtlebot3_team.yaml"
ROOMS = """schema: 1
kind: arena
title: Two rooms with a door between them
walls:
  - {closed: true, points: [{x_m: 0, y_m: 0}, {x_m: 4.6, y_m: 0}, {x_m: 4.6, y_m: 3.2}, {x_m: 0, y_m: 3.2}]}
  - {points: [{x_m: 2.6, y_m: 0}, {x_m: 2.6, y_m: 1.9}]}
pillars: [{x_m: 3.6, y_m: 1.6, radius_m: 0.15}]
starts:
  - {name: tb3_0, x_m: 0.8, y_m: 0.8, yaw_deg: 38.66}
  - {name: tb3_1, x_m: 0.8, y_m: 1.8, yaw_deg: 0}
  - {name: tb3_2, x_m: 1.9, y_m: 0.8, yaw_deg: 90}
targets:
  - {name: A, x_m: 0.8, y_m: 2.6, yaw_deg: 90}
  - {name: B, x_m: 3.9, y_m: 2.5, yaw_deg: 0}
  - {name: C, x_m: 3.9, y_m: 0.7, yaw_deg: 0}
  - {name: D, x_m: 3.1, y_m: 0.7, yaw_deg: -90}
  - {name: E, x_m: 1.9, y_m: 2.2, yaw_deg: 180}
"""
"""The sample's arena: the door is met by all three, and what is behind it has to be explored. One robot explores the
shipped arena in the sample (tests/drivers/robots/navigation/test_mission.py)."""


class Run:
    """One run of the command, and what it took of the processor."""

    def __init__(self, folder: Path, seed: int, objective: str, *more: object, code: int = 0) -> None:
        before = os.times()
        self.folder = folder / f"{objective}-{seed}"
        done = simconsole("turtlebot", "--out", self.folder, "--seed", seed, "--objective", objective, "--json", *more)
        after = os.times()
        assert done.returncode == code, done.stdout + done.stderr
        self.cpu_s = after.children_user + after.children_system - before.children_user - before.children_system
        self.said = results(done)
        self.text = done.stderr


def in_rooms(folder: Path, seconds: int = 600) -> Path:
    """The shipped session, but in the sample's arena, and as long as is asked for."""
    world, session = folder / "rooms.world.yaml", folder / "session.yaml"
    world.write_text(ROOMS)
    text = SHIPPED.read_text().replace("world: arena", f"world: {world}")
    session.write_text(text.replace("duration_s: 600", f"duration_s: {seconds}"))
    return session


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory, module_sample: Sample) -> list[Run]:
    """The sample drives once through two rooms; the full size is the command as it is, twenty times."""
    folder = tmp_path_factory.mktemp("turtlebot")
    count = module_sample.of(1, 20)
    more = () if module_sample.long else ("--session", in_rooms(folder))
    return [
        Run(folder, (module_sample.seed + number) % 100_000, ("makespan", "sum")[number % 2], *more)
        for number in range(count)
    ]


def test_its_session_is_the_team_in_the_shipped_arena() -> None:
    assert parser().parse_args(["turtlebot"]).session == SHIPPED.stem
    assert "world: arena\n" in SHIPPED.read_text()


def test_all_tasks_are_done_and_nobody_touches_anything(runs: list[Run]) -> None:
    for run in runs:
        assert run.said["good"]
        robots: list[dict[str, Any]] = run.said["robots"]
        assert [robot["collisions"] for robot in robots] == [0, 0, 0]
        assert sorted(target for robot in robots for target in robot["tour"]) == ["A", "B", "C", "D", "E"]
        assert run.said["driven_m"] == pytest.approx(run.said["planned_m"], rel=0.1)
        assert all(min(robot["least_to_wall_m"], robot["least_to_robot_m"]) >= KEEP_M for robot in robots)


def test_slam_keeps_its_bounds_with_the_other_robots_moving(runs: list[Run]) -> None:
    for run in runs:
        for robot in run.said["robots"]:
            assert robot["slam_rms_m"] <= 0.05
            assert robot["odometry_rms_m"] > robot["slam_rms_m"]
        assert run.said["map"]["precision"] >= 0.85
        assert run.said["map"]["recall"] >= 0.85


def test_it_takes_no_more_of_the_processor_than_it_may(runs: list[Run]) -> None:
    for run in runs:
        print(f"{run.cpu_s:.1f} s of CPU time")
        assert run.cpu_s <= CPU_S


def test_everything_is_written_and_replays(runs: list[Run]) -> None:
    run = runs[0]
    names = {path.name for path in run.folder.iterdir()}
    assert names == {"bundle", "map.yaml", "map.pgm", "mission.json", "mission.svg", "results.json", "table.txt"}
    assert "12.76 m" in (run.folder / "table.txt").read_text(), "as the paper's, beside ours"
    assert json.loads((run.folder / "results.json").read_text())["digests"] == run.said["digests"]
    bundle = run.folder / "bundle"
    assert {"report.html", "scene.rrd", "tb3_1", "tb3_2"} <= {path.name for path in bundle.iterdir()}
    assert verify(bundle) == []
    for folder in (bundle, bundle / "tb3_1", bundle / "tb3_2"):
        assert replay_bundle(folder).hashes_equal


def test_one_seed_gives_one_drive(runs: list[Run], sample: Sample, tmp_path: Path) -> None:
    """The sample drives its beginning again, in which the robots map and no task is done yet."""
    first, seconds = runs[0], sample.of(8, 600)
    session = SHIPPED if sample.long else in_rooms(tmp_path, seconds)
    objective, _, seed = first.folder.name.partition("-")
    again = Run(tmp_path, int(seed), objective, "--session", session, "--no-pack", code=sample.of(1, 0))
    for robot in ("", "tb3_1", "tb3_2"):
        one, other = (open_bundle(run.folder / "bundle" / robot) for run in (first, again))
        assert other.manifest.ticks == sample.of(seconds * 200, one.manifest.ticks)
        for before, after in zip(one.log, other.log, strict=sample.long):
            assert (before.tick, before.vector.tobytes()) == (after.tick, after.vector.tobytes())


def test_a_session_without_platforms_is_refused() -> None:
    assert "scenario.platforms" in complaint(simconsole("turtlebot", "--session", "turtlebot3_burger"))


def test_a_robot_that_is_to_fail_hears_nothing_from_then_on_and_the_others_do() -> None:
    parts = members(resolve(failing(load_session("turtlebot3_team"), "tb3_1", 70.0)))
    faults = {name: part.session.scenario.faults for name, part in parts.items()}
    assert faults == {"tb3_1": (Silent(at_s=70.0),), "tb3_0": (), "tb3_2": ()}


@pytest.mark.parametrize("robot", ["nobody", "tb3_2"])
def test_a_robot_that_cannot_be_made_to_fail_is_named(robot: str) -> None:
    session = load_session("turtlebot3_team")
    busy = override(session, scenario={"seat": "tb3_1", "faults": [{"kind": "refused", "at_s": 3.0}]})
    with pytest.raises(ProfileError, match=robot):
        failing(session if robot == "nobody" else busy, robot, 70.0)
