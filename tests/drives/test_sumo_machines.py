"""SUMO, console and autopilot on three machines, over links of 0, 20 and 100 ms: network namespaces and a proxy."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from simconsole.recording.bundles.bundle import Bundle, open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.recorded_road_users import recorded_road_users
from tests.drives import sumo_machines
from tests.drives.fixtures import Once
from tests.paths import ROOT
from tests.samples import Sample

DELAYS_MS = (0, 100, 20)


@pytest.fixture(scope="module")
def delays_ms(module_sample: Sample) -> tuple[int, ...]:
    return DELAYS_MS[: module_sample.of(2, len(DELAYS_MS))]


@pytest.fixture(scope="module")
def drives(once: Once, delays_ms: tuple[int, ...]) -> Path:
    def make(folder: Path) -> None:
        words = [sys.executable, "-m", sumo_machines.__name__, str(folder), *map(str, delays_ms)]
        done = subprocess.run(
            ["unshare", "--map-root-user", "--net", *words],
            capture_output=True,
            text=True,
            cwd=ROOT,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            check=False,
        )
        assert done.returncode == 0, done.stderr
        (folder / "said").write_text(done.stderr)

    return once("machines", make)


def places(bundle: Bundle) -> list[bytes]:
    return [at.users.tobytes() for at in recorded_road_users(bundle.log)]


def test_a_headless_drive_waits_for_both_and_goes_the_same_way_over_any_link(
    drives: Path, delays_ms: tuple[int, ...]
) -> None:
    bundles = [open_bundle(drives / f"lockstep-{delay_ms}") for delay_ms in delays_ms]
    for bundle in bundles:
        summary = bundle.manifest.summary
        assert summary["traffic"]["ego_error_m"] == 0.0
        assert "lost" not in summary["traffic"]
        assert (summary["exchanges"], summary["unanswered"]) == (15, 0)
        assert bundle.log.table(("ros.sequence",)).column("ros.sequence")[-1] > 0.0, "the autopilot's commands came"
    assert len({bundle.manifest.digest for bundle in bundles}) == 1
    first, *others = map(places, bundles)
    assert len(set(first)) > 5, "SUMO's vehicles drive"
    assert all(other == first for other in others)


def test_a_seated_drive_never_waits_counts_late_steps_and_goes_on(drives: Path) -> None:
    bundle = open_bundle(drives / "seated")
    traffic = bundle.manifest.summary["traffic"]
    assert len(bundle.log.table(("events.events",)).ticks) == 5 * bundle.log.header.tick_hz
    assert "lost" not in traffic
    assert traffic["late_steps"] > 60, "of 125: a step is three questions and answers of 200 ms"
    assert traffic["ego_error_m"] == 0.0
    assert len(set(places(bundle))) > 2, "others move on"
    assert "SUMO is too slow for the drive: its time stands still" in (drives / "said").read_text()
    assert replay_bundle(bundle.folder).hashes_equal
