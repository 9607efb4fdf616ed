"""The paired report of a counterfactual, as the command writes it."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from simconsole import open_drive
from simconsole.evaluation.counterfactual.drive_again import OPEN_LOOP
from simconsole.evaluation.counterfactual.pair import PAIR
from simconsole.evaluation.report.paired_page import separation_m
from simconsole.recording.bundles.verification import verify
from tests.drives.console import complaint, results, simconsole, within


@pytest.fixture(scope="module")
def heavy(short: Path, tmp_path_factory: pytest.TempPathFactory) -> "subprocess.CompletedProcess[str]":
    """What the command says that drives a heavier car."""
    out = tmp_path_factory.mktemp("pair") / "heavy"
    done = simconsole("replay", short, "--set", "body.mass_kg=1900", "--out", out, "--json")
    assert done.returncode == 0, done.stderr
    return done


@pytest.fixture(scope="module")
def pair(heavy: "subprocess.CompletedProcess[str]") -> Path:
    """The page that it wrote."""
    return Path(results(heavy)["report"])


def test_the_command_writes_a_pair_that_says_it_is_open_loop(
    short: Path, heavy: "subprocess.CompletedProcess[str]", pair: Path
) -> None:
    done, out = heavy, pair.parent
    assert OPEN_LOOP in done.stderr
    found = results(done)
    page = pair.read_text()
    assert pair.name == PAIR
    assert page.count(f"<b>Driver: {OPEN_LOOP}.</b>") == 1
    assert "body.mass_kg = 1900" in page
    assert "vehicle.vx_mps" in page
    assert page.count("<svg") == 1
    assert verify(out) == []
    first, second = (open_drive(folder).column("vehicle.x_m") for folder in (short, out))
    assert found["apart_end_m"] == pytest.approx(abs(first[-1] - second[-1]), rel=0.2)
    assert found["apart_max_m"] >= found["apart_end_m"] > 0.05
    assert found["metrics"][0]["distance_m"] == pytest.approx(open_drive(short).metrics["distance_m"])
    assert found["metrics"][1]["distance_m"] < found["metrics"][0]["distance_m"]


def test_metrics_stand_beside_each_other_with_their_difference(pair: Path) -> None:
    page = pair.read_text()
    row = re.search(
        r"<th>Distance</th><td class=n>([\d.]+) m</td><td class=n>([\d.]+) m</td><td class=n>(-?[\d.]+) m", page
    )
    assert row is not None
    one, other, difference = map(float, row.groups())
    assert difference == pytest.approx(other - one, abs=0.11)


def test_it_lies_beside_the_old_bundle_unless_told_otherwise(short: Path, tmp_path: Path) -> None:
    shutil.copytree(short, tmp_path / "old")
    values = ("body.mass_kg=1600", "scenario.start={x_m: 1, y_m: 2}")
    done = within("replay", tmp_path / "old", *(word for value in values for word in ("--set", value)))
    assert done.returncode == 0, done.stderr
    assert {path.name for path in tmp_path.iterdir()} == {
        "old",
        "old-body.mass_kg=1600-scenario.start=_x_m__1__y_m__2_",
    }


def test_without_a_change_there_is_no_other_drive(short: Path, tmp_path: Path) -> None:
    done = within("replay", short, "--out", tmp_path / "again")
    assert "--out: only with --set" in complaint(done)
    assert done.returncode == 2


def test_separation_is_the_distance_at_each_tick(short: Path) -> None:
    from simconsole.evaluation.metrics.table import recorded_drive
    from simconsole.recording.bundles.bundle import open_bundle

    drive = recorded_drive(open_bundle(short).log)
    assert separation_m(drive, drive).tolist() == [0.0] * drive.ticks
