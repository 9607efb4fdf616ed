"""F05 of the fault catalogue, from the command line: a recording that cannot be read is one line and exit code 2."""

import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.drives.console import complaint, results, within
from tests.faults.recorded import unfinish
from tests.manifests import forge
from tests.recording.conftest import change_header, rewrite_checksums

__all__ = ["rewrite_checksums"]


@pytest.fixture
def copy(short: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(short, tmp_path / "copy"))


def resize(bundle: Path) -> None:
    size = (bundle / "drive.log").stat().st_size
    forge(bundle, lambda manifest: manifest["files"]["drive.log"].update(size_bytes=size))


@pytest.mark.fault("F05")
@pytest.mark.parametrize("command", ["replay", "report"])
def test_f05_recording_of_a_newer_version(copy: Path, rewrite_checksums: Callable[[Path], None], command: str) -> None:
    change_header(copy / "drive.log", schema=99)
    resize(copy)
    line = complaint(within(command, copy))
    assert f"{copy / 'drive.log'}: schema: 99 cannot be read, this simconsole reads 1 to 2" in line


@pytest.mark.fault("F05")
def test_f05_bundle_of_a_newer_version(copy: Path) -> None:
    forge(copy, lambda manifest: manifest.update(schema=99, invented=True))
    for command in ("replay", "verify", "report"):
        assert f"{copy / 'manifest.json'}: schema: 99 cannot be read" in complaint(within(command, copy))


@pytest.mark.fault("F05")
def test_f05_recording_of_another_endianness(copy: Path) -> None:
    other = "big" if sys.byteorder == "little" else "little"
    change_header(copy / "drive.log", byte_order=other)
    resize(copy)
    line = complaint(within("replay", copy))
    assert f"{copy / 'drive.log'}: byte_order: '{other}' cannot be read here" in line


@pytest.mark.fault("F05")
def test_f05_recording_cut_in_its_header(copy: Path) -> None:
    with (copy / "drive.log").open("r+b") as file:
        file.truncate(20)
    assert f"{copy / 'drive.log'}: " in complaint(within("replay", copy))


@pytest.mark.fault("F05")
def test_f05_drive_that_was_killed_can_still_be_replayed(copy: Path) -> None:
    # What a kill -9 leaves: the first manifest, and a log that ends in the middle of a tick.
    unfinish(copy)
    log = copy / "drive.log"
    with log.open("r+b") as file:
        file.truncate(log.stat().st_size - 100)
    done = within("replay", copy, "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    assert results(done)["ticks"] == 749
    checked = within("verify", copy)
    assert checked.returncode == 1
    assert "the drive was not finished" in checked.stdout


@pytest.mark.fault("F05")
def test_f05_folder_that_is_no_bundle(tmp_path: Path) -> None:
    for command in ("replay", "verify", "report"):
        assert f"{tmp_path / 'manifest.json'}: not a bundle" in complaint(within(command, tmp_path))
    assert list(tmp_path.iterdir()) == []
