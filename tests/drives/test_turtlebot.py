"""TurtleBot3 robots as two programs: stock roslibpy drives by /cmd_vel as it drives a real one; the console moves."""

import json
import math
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.profiles.files.loader import profiles_folder
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.values.signals import Mode
from tests.drives.console import Running, environment, within
from tests.patience import PATIENCE_S
from tests.ports import free_port
from tests.samples import Sample

PROGRAM = Path(__file__).with_name("turtlebot_client.py")
SECONDS = 14
TOLD_S = 13.5
"""The client listens and drives so long; then it leaves, and the robot stops."""
ROBOTS = ("burger", "waffle")


class Driven:
    """What is left of one drive."""

    def __init__(self, folder: Path, robot: str) -> None:
        self.bundle = folder / "bundle"
        port = free_port()
        shipped = (profiles_folder() / "sessions" / f"turtlebot3_{robot}.yaml").read_text()
        session = folder / "session.yaml"
        session.write_text(
            shipped.replace("port: 9090", f"port: {port}").replace("duration_s: 60", f"duration_s: {SECONDS}")
        )
        with Running(folder, "drive", session, "--out", self.bundle, "--json") as console:
            client = subprocess.run(
                [sys.executable, "-W", "ignore", str(PROGRAM), str(port), str(SECONDS)],
                capture_output=True,
                text=True,
                timeout=PATIENCE_S,
                env=environment(PYTHONPATH=os.pathsep.join(entry for entry in sys.path if entry)),
                check=False,
            )
            self.done = console.end()
        assert client.returncode == 0, client.stderr
        assert self.done.returncode == 0, self.done.stderr
        self.said: dict[str, Any] = json.loads(client.stdout.splitlines()[-1])
        self.table = open_bundle(self.bundle).log.table()

    def column(self, name: str) -> Any:
        return self.table.column(name)


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory, module_sample: Sample) -> list[Driven]:
    """The sample has one robot: both have the same code, and other figures."""
    return [Driven(tmp_path_factory.mktemp(robot), robot) for robot in ROBOTS[: module_sample.of(1, len(ROBOTS))]]


def test_it_turns_in_place_and_drives_into_a_wall_where_it_stays(drives: list[Driven]) -> None:
    for driven in drives:
        assert driven.said["finished"]
        modes = driven.column("arbitration.mode")
        assert (modes[200 : round(13.4 * 200)] == Mode.AUTONOMOUS).all()
        assert modes[-1] in (Mode.MINIMAL_RISK, Mode.STOPPED), "who commanded has left"
        x, y, rate = (driven.column(f"vehicle.{name}") for name in ("x_m", "y_m", "yaw_rate_radps"))
        first = slice(0, round(1.9 * 200))
        assert np.hypot(x[first] - 0.8, y[first] - 0.8).max() < 1e-9, "on the spot"
        assert rate[first].max() == pytest.approx(1.0)
        assert driven.column("platform.motion.collisions")[-1] >= 1.0
        assert driven.said["bumped"] == 1, "with its front"
        assert abs(driven.column("vehicle.vx_mps")[-1]) < 1e-6
        assert x.min() > 0.0
        assert y.min() > 0.0
        assert (driven.column("ros.refused") == 0.0).all()


def test_its_topics_are_those_of_the_real_one(drives: list[Driven]) -> None:
    for driven in drives:
        heard, last = driven.said["heard"], driven.said["last"]
        assert heard["/scan"] == pytest.approx(5 * TOLD_S, abs=3)
        assert heard["/odom"] == pytest.approx(50 * TOLD_S, abs=8), "once a control period, in lockstep"
        assert heard["/joint_states"] == pytest.approx(30 * TOLD_S, abs=6)
        assert heard["/imu"] == pytest.approx(50 * TOLD_S, abs=8)
        assert heard["/battery_state"] == pytest.approx(TOLD_S, abs=2)
        assert heard["/tf_static"] == 1
        scan, odometry = last["/scan"], last["/odom"]
        assert (scan["header"]["frame_id"], odometry["header"]["frame_id"]) == ("base_scan", "odom")
        assert odometry["child_frame_id"] == "base_footprint"
        assert len(scan["ranges"]) == 360
        assert (scan["range_min"], scan["range_max"]) == pytest.approx((0.12, 3.5))
        assert last["/imu"]["linear_acceleration"]["z"] == pytest.approx(9.8, abs=0.15)
        assert last["/joint_states"]["name"] == ["wheel_left_joint", "wheel_right_joint"]
        assert 12.0 < last["/battery_state"]["voltage"] < 12.6
        assert 0.9 < last["/battery_state"]["percentage"] < 1.0
        frames = {(tf["header"]["frame_id"], tf["child_frame_id"]) for tf in last["/tf"]["transforms"]}
        assert ("odom", "base_footprint") in frames
        static = {(tf["header"]["frame_id"], tf["child_frame_id"]) for tf in last["/tf_static"]["transforms"]}
        assert ("base_footprint", "base_link") in static
        assert ("base_link", "base_scan") in static
        assert not {child for _, child in frames | static} & {"odom", "map"}, "map to odom is left to who localises"


def test_odometry_counts_on_while_wheels_slip_at_the_wall(drives: list[Driven]) -> None:
    for driven in drives:
        told = driven.said["last"]["/odom"]["pose"]["pose"]["position"]
        by_odometry = math.hypot(told["x"], told["y"])
        really = math.hypot(driven.column("vehicle.x_m")[-1] - 0.8, driven.column("vehicle.y_m")[-1] - 0.8)
        assert by_odometry > really + 0.1


def test_it_replays_is_reported_and_exported(drives: list[Driven], tmp_path: Path) -> None:
    for driven in drives:
        assert verify(driven.bundle) == []
        found = replay_bundle(driven.bundle)
        assert found.hashes_equal, found.differences
        assert found.ticks == 200 * SECONDS
        assert "<svg" in (driven.bundle / "report.html").read_text("utf-8")
        assert (driven.bundle / "scene.rrd").stat().st_size > 10_000
        done = within(
            "export", driven.bundle, "--to", "mcap", "--out", tmp_path / f"{driven.bundle.parent.name}.mcap", "--json"
        )
        assert done.returncode == 0, done.stderr
        counts = json.loads(done.stdout.splitlines()[-1])["counts"]
        assert counts["/scan"] == 5 * SECONDS
        assert counts["/cmd_vel"] > 0
