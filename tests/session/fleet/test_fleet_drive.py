"""Three robots in one session over one rosbridge server: they see, touch and outlive each other; each replays alone."""

import shutil
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.profiles.session import SessionProfile
from simconsole.profiles.validation import convert
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.manifest import read_manifest
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.session.fleet.fleet_drive import drive_fleet
from simconsole.session.resolution import resolve
from simconsole.values.signals import NO_AHEAD, Mode
from tests.ports import free_port
from tests.session.fleet.fleet_client import NAMES, FleetClient

SECONDS = 6.0
RADIUS_M = 0.105


def session_of(port: int, seconds: float = SECONDS, **changes: Any) -> SessionProfile:
    """Robots in a row: the first drives at the second, which stands; the third turns in place."""
    starts = [{"x_m": 0.6, "y_m": 0.8}, {"x_m": 1.4, "y_m": 0.8}, {"x_m": 0.8, "y_m": 1.6}]
    plain: dict[str, Any] = {
        "schema": 1,
        "environment": {"world": "arena"},
        "scenario": {
            "vehicle": "turtlebot3_burger",
            "duration_s": seconds,
            "platforms": [{"name": name, "start": start} for name, start in zip(NAMES, starts, strict=True)],
        },
        "features": {"control": {"person_required": False, "standstill_speed_mps": 0.01}},
        "outputs": {"bridge": {"port": port}, "hud": None},
        "devices": {"driver": "none"},
        "mode": {"tick_hz": 200, "pacing": "lockstep", "control_period_ms": 20, "answer_timeout_s": 60.0},
    }
    return convert(plain | changes, SessionProfile, "test")


class Driven:
    def __init__(self, folder: Path, speeds: list[tuple[float, float]]) -> None:
        port = free_port()
        self.bundle = folder / "bundle"
        self.client = FleetClient(f"ws://127.0.0.1:{port}", speeds)
        thread = threading.Thread(target=self.client.run)
        thread.start()
        self.result = drive_fleet(resolve(session_of(port)), self.bundle)
        thread.join()
        self.folders = [self.bundle, self.bundle / "tb3_1", self.bundle / "tb3_2"]
        self.tables = [open_bundle(own).log.table() for own in self.folders]

    def digests(self) -> list[str]:
        return [read_manifest(folder).digest for folder in self.folders]


SPEEDS = [(0.2, 0.0), (0.0, 0.0), (0.0, 1.0)]


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Driven:
    return Driven(tmp_path_factory.mktemp("fleet"), SPEEDS)


def test_each_follows_its_own_commander(driven: Driven) -> None:
    for table, (speed, turn) in zip(driven.tables, SPEEDS, strict=True):
        assert (table.column("arbitration.mode")[100:] == Mode.AUTONOMOUS).all()
        assert table.column("command.target_speed_mps")[-1] == pytest.approx(speed)
        assert table.column("command.target_yaw_rate_radps")[-1] == pytest.approx(turn)
        assert (table.column("ros.refused") == 0.0).all()
        assert table.column("ros.sequence")[-1] == SECONDS * 50 - 1, "one for each odometry but the last"
    assert np.ptp(driven.tables[2].column("vehicle.x_m")) < 1e-9, "it turns in place"


def test_one_drives_into_another_and_stays_in_front_of_it(driven: Driven) -> None:
    first, second = driven.tables[:2]
    assert first.column("platform.motion.collisions")[-1] >= 1.0
    x = first.column("vehicle.x_m")
    apart = second.column("vehicle.x_m") - x
    assert apart.min() > 2.0 * RADIUS_M - 0.005, "by less than what it drives between two periods"
    assert x[-1] > 0.8
    assert (first.column("platform.motion.bumper")[-100:] == 1.0).any(), "with its front"


def test_what_each_is_told_of_the_others_is_where_they_were(driven: Driven) -> None:
    told, other = driven.tables[1], driven.tables[0]
    ahead_m = told.column("others.x_0_m")[800] - other.column("vehicle.x_m")[799]
    assert ahead_m == pytest.approx(-0.032, abs=0.002), "the middle of the body, as the second robot was told it"
    assert told.column("others.radius_0_m")[100] == pytest.approx(RADIUS_M, abs=0.01)
    # Of the end of the control period before, and the same throughout a period.
    assert (told.column("others.x_0_m")[800:804] == told.column("others.x_0_m")[800]).all()


def test_views_have_the_other_robots_as_road_users(driven: Driven) -> None:
    at = next(at for at in recorded_road_users(open_bundle(driven.folders[2]).log) if at.tick == 800)
    assert at.users[:, 0].tolist() == [0.0, 1.0]
    x_m = [driven.tables[number].column("vehicle.x_m")[799] for number in (0, 1)]
    assert at.users[:, 2] == pytest.approx(np.array(x_m) - 0.032, abs=0.002), "the middle of each body"
    assert (driven.tables[2].column("ahead.lead_gap_m") == NO_AHEAD.lead_gap_m).all(), "it is not told so"


def test_lidars_see_the_other_robots(driven: Driven) -> None:
    scan = driven.client.scans[2]  # of 0.4 to 0.6 s; its first ray goes straight ahead
    x = driven.tables[0].column("vehicle.x_m")[round(0.4 * 200) - 1]
    away_m = 1.4 - 0.032 - RADIUS_M - (x - 0.032)
    assert scan.ranges[0] == pytest.approx(away_m, abs=0.05), "ahead stands the second robot"
    assert scan.ranges[180] < 1.0, "and behind is the wall"
    alone = driven.client.scans[2].ranges[15]
    assert alone > away_m + 1.0, "beside it there is nobody"


def test_topics_and_frames_are_in_each_robots_namespace(driven: Driven) -> None:
    heard = driven.client.heard
    for name in NAMES:
        assert heard[f"/{name}/odom"] == round(SECONDS * 50)
        assert heard[f"/{name}/scan"] == round(SECONDS * 5)
        for frame in ("base_footprint", "wheel_left_link", "base_link", "base_scan"):
            assert f"{name}/{frame}" in driven.client.frames
    assert heard["/clock"] <= SECONDS * 50, "one robot tells the time"


def test_each_chain_replays_alone(driven: Driven) -> None:
    for folder in driven.folders:
        found = replay_bundle(folder)
        assert found.hashes_equal, found.differences
    assert verify(driven.bundle) == []


def test_the_bundle_vouches_for_the_other_platforms(driven: Driven, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(driven.bundle, copy)
    shutil.rmtree(copy / "tb3_2")
    assert any("tb3_2" in problem for problem in verify(copy))
    shutil.copytree(driven.bundle / "tb3_1", copy / "tb3_2")
    assert any("hash" in problem for problem in verify(copy))


def test_two_drives_are_equal(driven: Driven, tmp_path: Path) -> None:
    again = Driven(tmp_path, SPEEDS)
    assert again.digests() == driven.digests()
    assert len(set(again.digests())) == 3


def test_topics_that_the_server_has_kept_are_in_the_manifest(tmp_path: Path) -> None:
    port = free_port()
    client = FleetClient(f"ws://127.0.0.1:{port}", [(0.0, 0.0)] * 3)
    thread = threading.Thread(target=client.run)
    thread.start()
    outputs = {"bridge": {"port": port, "record": ["*"]}, "hud": None}
    drive_fleet(resolve(session_of(port, 1.0, outputs=outputs)), tmp_path / "bundle")
    thread.join()
    assert "topics.mcap" in read_manifest(tmp_path / "bundle").files
    assert verify(tmp_path / "bundle") == []
