"""F05 of the fault catalogue, from the command line: a recording that cannot be read is one line and exit code 2."""

import json
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.drives.console import complaint, results, simconsole
from tests.recording.conftest import change_header, rewrite_checksums

__all__ = ["rewrite_checksums"]


@pytest.fixture
def copy(short: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(short, tmp_path / "copy"))


@pytest.mark.fault("F05")
@pytest.mark.parametrize("command", ["replay", "report"])
def test_f05_recording_of_a_newer_version(copy: Path, rewrite_checksums: Callable[[Path], None], command: str) -> None:
    change_header(copy / "drive.log", schema=99)
    manifest = json.loads((copy / "manifest.json").read_text())
    entry = manifest["files"]["drive.log"]
    entry["size_bytes"] = (copy / "drive.log").stat().st_size
    (copy / "manifest.json").write_text(json.dumps(manifest))
    line = complaint(simconsole(command, copy))
    assert f"{copy / 'drive.log'}: schema: 99 cannot be read, this simconsole reads 1 to 2" in line


@pytest.mark.fault("F05")
def test_f05_bundle_of_a_newer_version(copy: Path) -> None:
    manifest = json.loads((copy / "manifest.json").read_text())
    (copy / "manifest.json").write_text(json.dumps({**manifest, "schema": 99, "invented": True}))
    for command in ("replay", "verify", "report"):
        assert f"{copy / 'manifest.json'}: schema: 99 cannot be read" in complaint(simconsole(command, copy))


@pytest.mark.fault("F05")
def test_f05_recording_of_another_endianness(copy: Path) -> None:
    other = "big" if sys.byteorder == "little" else "little"
    change_header(copy / "drive.log", byte_order=other)
    manifest = json.loads((copy / "manifest.json").read_text())
    manifest["files"]["drive.log"]["size_bytes"] = (copy / "drive.log").stat().st_size
    (copy / "manifest.json").write_text(json.dumps(manifest))
    line = complaint(simconsole("replay", copy))
    assert f"{copy / 'drive.log'}: byte_order: '{other}' cannot be read here" in line


@pytest.mark.fault("F05")
def test_f05_recording_cut_in_its_header(copy: Path) -> None:
    with (copy / "drive.log").open("r+b") as file:
        file.truncate(20)
    assert f"{copy / 'drive.log'}: " in complaint(simconsole("replay", copy))


@pytest.mark.fault("F05")
def test_f05_drive_that_was_killed_can_still_be_replayed(copy: Path) -> None:
    # What a kill -9 leaves: the first manifest, and a log that ends in the middle of a tick.
    manifest = json.loads((copy / "manifest.json").read_text())
    del manifest["files"]["drive.log"], manifest["ticks"], manifest["digest"], manifest["summary"]
    (copy / "manifest.json").write_text(json.dumps({**manifest, "finished": False}))
    log = copy / "drive.log"
    with log.open("r+b") as file:
        file.truncate(log.stat().st_size - 100)
    done = simconsole("replay", copy, "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    assert results(done)["ticks"] == 749
    checked = simconsole("verify", copy)
    assert checked.returncode == 1
    assert "the drive was not finished" in checked.stdout


@pytest.mark.fault("F05")
def test_f05_folder_that_is_no_bundle(tmp_path: Path) -> None:
    for command in ("replay", "verify", "report"):
        assert f"{tmp_path / 'manifest.json'}: not a bundle" in complaint(simconsole(command, tmp_path))
    assert list(tmp_path.iterdir()) == []
