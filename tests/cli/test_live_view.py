"""`simconsole view` of a drive that goes on, as people run it."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from simconsole.session.scene_worker import LIVE_SCENE
from tests.drives.console import Running, complaint, results, simconsole
from tests.patience import wait_until
from tests.scene.viewer.viewers import viewer
from tests.session.test_paced import Drive

SESSION = """\
schema: 1
environment: {world: urban}
scenario: {vehicle: hatchback}
outputs: {bridge: null, hud: null, scene: {rate_hz: 20, chunk_s: 0.1}, report: false}
devices:
  driver: virtual
  person: {title: drives on, sit_s: 0.2, cruise_kmh: 30, stop: {distance_m: 2600}}
mode: {pacing: realtime, tick_hz: 250}
"""


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Drive]:
    folder = tmp_path_factory.mktemp("drive")
    (folder / "session.yaml").write_text(SESSION)
    words = ("drive", folder / "session.yaml", "--out", folder / "bundle", "--no-pack")
    with Running(folder / "drive", *words) as running:
        driven = Drive(running, folder / "bundle")
        wait_until(lambda: driven.ended() or (folder / "bundle" / LIVE_SCENE).exists(), "a scene")
        yield driven


def said(running: Running, words: str) -> str:
    """Return what the command said after some words, once it has."""

    def line() -> str | None:
        assert running.process.poll() is None, running.err.read_text()
        found = [line for line in running.err.read_text().splitlines() if words in line]
        return found[0].partition(words)[2].strip() if found else None

    return wait_until(line, words) or ""


def test_viewers_see_the_drive_that_goes_on_and_its_processes_restart(tmp_path: Path, drive: Drive) -> None:
    with Running(tmp_path / "view", "view", drive.bundle, "--no-open", "--json") as shown:
        address = said(shown, "rerun --connect")
        assert said(shown, "browsers of this machine:").startswith("http://127.0.0.1:")
        with viewer(address, tmp_path / "one.rrd") as one, viewer(address, tmp_path / "two.rrd") as two:
            for entity in ("/world/road/surface", "/world/path/driven", "/world/ego/wheels", "/latency"):
                wait_until(lambda entity=entity: one.sees(entity) and two.sees(entity), entity)  # type: ignore[misc]
            os.kill(one.process.pid, signal.SIGKILL)
            drive.kill_worker("scene")
            seen = two.sees("/world/ego")
            wait_until(lambda: two.sees("/world/ego") > seen, "the scene of the new process, in the same viewer")
            assert two.sees("/world/road/surface") == 2, "the new process has said its world again"
        os.kill(shown.process.pid, signal.SIGINT)
        done = shown.end()
    assert done.returncode == 130, done.stderr
    found = results(done)
    assert found["scene"] == str(drive.bundle / LIVE_SCENE)
    assert found["served_bytes"] > 100_000
    assert found["ended"] is False


def test_the_end_of_the_drive_is_told_and_it_is_served_on(tmp_path: Path, drive: Drive) -> None:
    with Running(tmp_path / "view", "view", drive.bundle, "--no-open", "--json") as shown:
        address = said(shown, "rerun --connect")
        drive.running.interrupt_group()
        drive.running.end()
        said(shown, "the drive has ended")
        with viewer(address, tmp_path / "late.rrd") as late:
            wait_until(lambda: late.sees("/world/path/driven"), "the path, after the drive")
        os.kill(shown.process.pid, signal.SIGINT)
        assert results(shown.end())["ended"] is True


def test_a_bundle_that_is_none_is_one_line(tmp_path: Path) -> None:
    assert "not a bundle" in complaint(simconsole("view", tmp_path, "--no-open"))
