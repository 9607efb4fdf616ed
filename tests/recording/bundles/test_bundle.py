import shutil
import subprocess
import sys
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import LOG, BundleWriter, add_export, open_bundle
from simconsole.recording.bundles.manifest import read_manifest
from simconsole.recording.bundles.verification import verify
from simconsole.recording.log_header import LogHeader
from simconsole.values.errors import RecordingError
from tests.recording.conftest import TEXTS


def test_a_finished_bundle_opens_and_verifies(bundle: Path) -> None:
    opened = open_bundle(bundle)
    assert opened.text("session.yaml") == TEXTS["session.yaml"]
    assert len(list(opened.log)) == opened.manifest.ticks == 40
    assert opened.manifest.summary == {"late_p99_us": 12.5}
    assert opened.manifest.versions == {"simconsole": "0"}
    assert opened.manifest.provenance.participant == "P07"
    assert verify(bundle) == []


def test_a_killed_drive_is_still_a_bundle(tmp_path: Path, header: LogHeader) -> None:
    with BundleWriter(tmp_path / "drive", header, TEXTS) as writer:
        writer.log.append(1, np.zeros(4))
        opened = open_bundle(tmp_path / "drive")
        assert not opened.manifest.finished
        assert [record.tick for record in opened.log] == [1]
        assert opened.text("vehicle.yaml") == TEXTS["vehicle.yaml"]
        assert verify(tmp_path / "drive") == [f"{tmp_path / 'drive' / 'manifest.json'}: the drive was not finished"]


def test_a_recording_that_stopped_says_so(tmp_path: Path, header: LogHeader, monkeypatch: pytest.MonkeyPatch) -> None:
    with BundleWriter(tmp_path / "drive", header, {}) as writer:
        writer.log.append(1, np.zeros(4))
        with monkeypatch.context() as patch:
            patch.setattr("os.write", lambda fd, frame: 0)
            writer.log.append(2, np.zeros(4))
        manifest = writer.finish({})
    assert manifest.ticks == 1
    assert verify(tmp_path / "drive") == [manifest.recording_failure]
    assert "recording stopped at tick 2: only 0 of 56 bytes fit" in str(manifest.recording_failure)


def test_a_folder_with_files_is_not_recorded_into(bundle: Path, header: LogHeader) -> None:
    before = {path.name: path.read_bytes() for path in bundle.iterdir()}
    with pytest.raises(RecordingError, match="the folder is not empty"):
        BundleWriter(bundle, header, TEXTS)
    assert {path.name: path.read_bytes() for path in bundle.iterdir()} == before


def test_a_place_that_cannot_be_written_is_one_line(tmp_path: Path, header: LogHeader) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordingError, match="cannot be recorded to"):
        BundleWriter(tmp_path / "file" / "drive", header, TEXTS)


@pytest.mark.fault("F05")
def test_f05_a_truncated_bundle_is_one_line_and_exit_code_2(bundle: Path) -> None:
    log = bundle / "drive.log"
    whole = log.stat().st_size
    log.write_bytes(log.read_bytes()[:-100])
    with pytest.raises(RecordingError) as caught:
        open_bundle(bundle)
    assert str(caught.value) == f"{log}: truncated, {whole - 100} of {whole} bytes"
    assert caught.value.exit_code == 2
    assert verify(bundle)[0] == str(caught.value)


@pytest.mark.parametrize("name", ["drive.log", "session.yaml"])
def test_a_missing_file_is_named(bundle: Path, name: str) -> None:
    (bundle / name).unlink()
    with pytest.raises(RecordingError, match=f"{name}: listed in manifest.json, cannot be read: No such file"):
        open_bundle(bundle)
    assert any(name in problem for problem in verify(bundle))


def test_verify_names_an_altered_value_and_the_first_tick_it_breaks(
    bundle: Path, rewrite_log: Callable[..., None], rewrite_checksums: Callable[[Path], None]
) -> None:
    rewrite_log(bundle / "drive.log", 12, "driver.brake", 0.25)
    problems = verify(bundle)
    assert any("altered, sha256" in problem for problem in problems)
    assert any("manifest.json says 40 ticks" in problem for problem in problems)
    rewrite_checksums(bundle)
    assert verify(bundle) == []  # only a replay can tell now: test_replay


def test_verify_names_the_tick_whose_hash_does_not_hold(
    bundle: Path, rewrite_checksums: Callable[[Path], None]
) -> None:
    from simconsole.recording.framing import seal
    from simconsole.recording.log_header import encode_header

    records = list(open_bundle(bundle).log)
    parts = [encode_header(open_bundle(bundle).log.header)]
    for before, record in zip([bytes(8), *(record.digest for record in records)], records, strict=False):
        parts.append(seal(before if record.tick != 5 else bytes(8), record.tick, record.vector.tobytes())[0])
    (bundle / "drive.log").write_bytes(b"".join(parts))
    rewrite_checksums(bundle)
    assert verify(bundle) == [f"{bundle / 'drive.log'}: stream state: the chained hash does not hold at tick 5"]


def test_exports_may_be_added_and_lost(bundle: Path) -> None:
    (bundle / "report.html").write_text("<html>")
    add_export(bundle, "report.html")
    assert read_manifest(bundle).files["report.html"].export
    assert verify(bundle) == []
    (bundle / "report.html").write_text("<html>changed")
    assert len(verify(bundle)) == 1
    (bundle / "report.html").unlink()
    assert len(list(open_bundle(bundle).log)) == 40
    with pytest.raises(RecordingError, match=r"scene\.rrd: cannot be added"):
        add_export(bundle, "scene.rrd")


def test_a_text_the_bundle_does_not_have(bundle: Path) -> None:
    with pytest.raises(RecordingError, match=r"world\.yaml: not in manifest\.json"):
        open_bundle(bundle).text("world.yaml")


def test_the_end_of_a_drive_does_not_read_the_whole_log_again(
    tmp_path: Path, header: LogHeader, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its checksum was kept up to date meanwhile; what is left to read is what came since."""
    with BundleWriter(tmp_path / "b", header, {}) as writer:
        for tick in range(1, 3000):
            writer.log.append(tick, np.full(len(header.columns), float(tick)))
        monkeypatch.setattr("simconsole.recording.bundles.bundle.file_entry", None)
        manifest = writer.finish({})
    monkeypatch.undo()
    assert manifest.files[LOG].sha256 == sha256((tmp_path / "b" / LOG).read_bytes()).hexdigest()
    assert verify(tmp_path / "b") == []


def test_a_folder_that_was_removed_is_made_again_with_all_that_was_recorded(tmp_path: Path, header: LogHeader) -> None:
    folder = tmp_path / "of" / "drives" / "b"
    with BundleWriter(folder, header, {"session.json": "{}"}) as writer:
        for tick in range(1, 4):
            writer.log.append(tick, np.zeros(len(header.columns)))
        shutil.rmtree(tmp_path / "of")
        writer.log.append(4, np.zeros(len(header.columns)))
        manifest = writer.finish({})
    assert str(manifest.recording_failure).endswith("recording stopped at tick 4: the file was removed")
    bundle = open_bundle(folder)
    assert [record.tick for record in bundle.log] == [1, 2, 3]
    assert bundle.text("session.json") == "{}"
    assert sorted(path.name for path in folder.iterdir()) == [LOG, "manifest.json", "session.json"]


AT_EACH_STEP = """
import os, sys
from hashlib import sha256
from pathlib import Path
from simconsole.processes.lifetimes import end_at_once
from simconsole.recording.bundles.bundle import BundleWriter
from simconsole.recording.log_header import LogHeader, vector_stream
ends = {"ended": end_at_once, "killed": os._exit}[sys.argv[2]]
session = sha256(b"{}").hexdigest()
header = LogHeader(
    tick_hz=250, streams=(vector_stream(("vehicle.x_m", "vehicle.y_m"), 1),),
    console_version="0", source_sha256="", session_sha256=session,
)
steps = ("open", "os.mkdir", "os.remove", "os.rmdir", "os.rename", "os.truncate")
def drive(folder, last):
    left = [last]
    def step(event, arguments):
        if event in steps and str(folder) in str(arguments[0]):
            left[0] -= 1
            if left[0] == 0:
                ends(130)
    sys.addaudithook(step)
    with BundleWriter(folder, header, {"session.json": "{}", "road.osm": "<osm/>"}) as writer:
        writer.extend_provenance(writer.manifest.provenance)
        raise KeyboardInterrupt
number, code = 0, 130
while code == 130:
    number += 1
    folder = Path(sys.argv[1], str(number), "bundle")
    if number % 2:
        folder.mkdir(parents=True)  # as somebody may have made it, empty
    else:
        folder.parent.mkdir(parents=True)
    process = os.fork()
    if process == 0:
        try:
            drive(folder, number)
        except KeyboardInterrupt:
            os._exit(0)
        os._exit(1)
    code = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
sys.exit(code)
"""


@pytest.mark.fault("P11")
@pytest.mark.parametrize("how", ["ended", "killed"])
def test_no_manifest_ever_vouches_for_what_is_not_there(how: str, tmp_path: Path) -> None:
    """A drive that begins and is given up before its first tick, ended before each of its steps on the disk."""
    done = subprocess.run(
        [sys.executable, "-c", AT_EACH_STEP, str(tmp_path), how], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    folders = sorted(tmp_path.glob("*/bundle"), key=lambda folder: int(folder.parent.name))
    assert len(list(tmp_path.iterdir())) > 15
    for folder in folders:
        if how == "ended":
            assert list(folder.iterdir()) == []
            assert int(folder.parent.name) % 2, "it was not there before"
        elif (folder / "manifest.json").exists():
            assert verify(folder) == [f"{folder / 'manifest.json'}: the drive was not finished"]
