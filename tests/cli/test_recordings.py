"""What can be done with a bundle, from the command line."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.drives.console import results, simconsole


def test_verify_says_that_a_bundle_is_whole_or_what_is_wrong(short: Path, tmp_path: Path) -> None:
    done = simconsole("verify", short)
    assert done.returncode == 0
    assert done.stdout == f"{short}: whole\n"
    spoilt = Path(shutil.copytree(short, tmp_path / "spoilt"))
    content = bytearray((spoilt / "drive.log").read_bytes())
    content[-2000] ^= 1
    (spoilt / "drive.log").write_bytes(content)
    done = simconsole("verify", spoilt, "--json")
    assert done.returncode == 1
    found = results(done)
    assert not found["good"]
    assert all(str(spoilt / "drive.log") in problem for problem in found["problems"])


def test_compare_finds_a_bundle_equal_to_itself(short: Path) -> None:
    done = simconsole("compare", short, short, "--json")
    assert done.returncode == 0
    assert results(done) == {"equal": True, "ticks": 750, "difference": None, "problems": []}


def test_report_is_written_again(short: Path, tmp_path: Path) -> None:
    short = Path(shutil.copytree(short, tmp_path / "copy"))
    (short / "report.html").unlink()
    done = simconsole("report", short, "--json")
    assert done.returncode == 0, done.stderr
    assert results(done)["duration_s"] == 3.0
    assert str(short / "report.html") in done.stdout
    assert (short / "report.html").read_text("utf-8").startswith("<!DOCTYPE html>")
    assert simconsole("verify", short).returncode == 0


def test_view_writes_the_scene_without_opening_it(short: Path, tmp_path: Path) -> None:
    short = Path(shutil.copytree(short, tmp_path / "copy"))
    (short / "scene.rrd").unlink()
    done = simconsole("view", short, "--no-open", "--json")
    assert done.returncode == 0, done.stderr
    assert results(done) == {"scene": str(short / "scene.rrd"), "problems": []}
    assert (short / "scene.rrd").read_bytes()[:4] == b"RRF2"


FORGED_TICK = 400


@pytest.fixture
def copy(short: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(short, tmp_path / "copy"))


def test_compare_finds_two_drives_of_one_script_equal(short: Path, script: Path, tmp_path: Path) -> None:
    again = tmp_path / "again"
    done = simconsole("drive", "--headless", "--driver", f"script:{script}", "--for", 3, "--out", again)
    assert done.returncode == 0, done.stderr
    compared = simconsole("compare", short, again, "--json")
    assert compared.returncode == 0, compared.stdout
    assert results(compared) == {"equal": True, "ticks": 750, "difference": None, "problems": []}
    assert (short / "drive.log").read_bytes() == (again / "drive.log").read_bytes()


def test_compare_names_the_first_difference_with_a_window(
    short: Path, copy: Path, rewrite_log: Callable[..., None], rewrite_checksums: Callable[[Path], None]
) -> None:
    rewrite_log(copy / "drive.log", FORGED_TICK, "vehicle.vx_mps", 7.25)
    rewrite_checksums(copy)
    done = simconsole("compare", short, copy, "--json")
    assert done.returncode == 1
    difference = results(done)["difference"]
    assert difference["tick"] == FORGED_TICK
    assert "vehicle.vx_mps" in str(difference)
    assert "7.25" in done.stdout
