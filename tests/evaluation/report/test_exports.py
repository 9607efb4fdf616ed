import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import pytest

from simconsole.evaluation.report import exports
from simconsole.evaluation.report.exports import PASSES, REPORT, write_exports, write_report, write_scene
from simconsole.evaluation.report.scene_export import SCENE
from simconsole.recording.bundles.bundle import add_export, open_bundle
from simconsole.recording.bundles.manifest import MANIFEST, read_manifest, write_manifest
from simconsole.recording.bundles.signing import make_key, sign
from simconsole.recording.bundles.verification import verify
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.session.scene_worker import LIVE_SCENE
from simconsole.values.errors import RecordingError, WorkerError


def without_exports(bundle: Path, folder: Path) -> Path:
    """Copy a bundle without what was made from it."""
    shutil.copytree(bundle, folder)
    (folder / REPORT).unlink()
    (folder / SCENE).unlink()
    return folder


@pytest.fixture
def bare(short: Path, tmp_path: Path) -> Path:
    """A bundle with nothing made from it yet."""
    return without_exports(short, tmp_path / "bare")


class Exported(NamedTuple):
    """A bundle with its exports, what they found, and what was told meanwhile."""

    folder: Path
    metrics: dict[str, Any]
    told: dict[str, list[float]]


@pytest.fixture(scope="module")
def exported(short: Path, tmp_path_factory: pytest.TempPathFactory) -> Exported:
    """One that a scene worker left its scene in. Not to be changed."""
    folder = without_exports(short, tmp_path_factory.mktemp("exported") / "bundle")
    (folder / LIVE_SCENE).write_bytes(b"what a scene worker saw")
    told: dict[str, list[float]] = {"report": [], "scene": []}
    return Exported(folder, write_exports(folder, told=lambda what, share: told[what].append(share)), told)


def test_exports_are_listed_and_change_nothing_of_the_drive(short: Path, exported: Exported) -> None:
    bare, metrics, _ = exported
    assert metrics["duration_s"] == 3.0
    driven_m = open_bundle(bare).log.table().column("vehicle.distance_m")[-1]
    # The odometer counts each millisecond, metrics each tick: rocking at the start is longer for the one.
    assert metrics["distance_m"] == pytest.approx(driven_m, rel=1e-3)
    assert (bare / "drive.log").read_bytes() == (short / "drive.log").read_bytes()
    assert verify(bare) == []
    assert {name for name, entry in open_bundle(bare).manifest.files.items() if entry.export} == {REPORT, SCENE}
    assert not (bare / LIVE_SCENE).exists(), "the whole scene takes its place"


def test_a_listed_live_scene_gives_way_to_the_whole_one(short: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(short, tmp_path / "bundle"))
    (folder / SCENE).rename(folder / LIVE_SCENE)
    add_export(folder, LIVE_SCENE)
    write_exports(folder, report=False)
    assert LIVE_SCENE not in open_bundle(folder).manifest.files
    assert verify(folder) == []


def test_where_the_report_fails_the_scene_is_listed_all_the_same(bare: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise MemoryError

    monkeypatch.setattr(exports, "_report", fail)
    with pytest.raises(MemoryError):
        write_exports(bare)
    assert open_bundle(bare).manifest.files[SCENE].export
    assert not [problem for problem in verify(bare) if SCENE in problem]


def test_exports_of_a_signed_bundle_stay_as_they_are(short: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(short, tmp_path / "signed"))
    make_key(tmp_path / "key")
    sign(folder, tmp_path / "key")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    for make in (write_exports, write_report, write_scene):
        with pytest.raises(RecordingError, match="signed, so nothing of this bundle may change"):
            make(folder)
    assert write_exports(folder, report=False, scene=False)["duration_s"] == 3.0
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_the_report_says_who_drove_on_what(bare: Path) -> None:
    known = msgspec.structs.replace(read_manifest(bare).provenance, participant="P<07>", notes=("tired",))
    write_manifest(bare, msgspec.structs.replace(read_manifest(bare), provenance=known))
    write_report(bare)
    page = (bare / REPORT).read_text("utf-8")
    assert "P&lt;07&gt;" in page
    assert "tired" in page
    assert "CPUs, " in page


def test_a_report_alone_leaves_the_scene_alone(bare: Path) -> None:
    write_report(bare)
    assert (bare / REPORT).exists()
    assert not (bare / SCENE).exists()


def test_metrics_without_any_file(bare: Path) -> None:
    before = (bare / MANIFEST).read_bytes()
    assert write_exports(bare, report=False, scene=False)["duration_s"] == 3.0
    assert (bare / MANIFEST).read_bytes() == before
    assert not (bare / REPORT).exists()


def test_a_scene_is_made_by_a_process_of_its_own(bare: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rerun", None)  # who imports it in this process gets an ImportError
    assert write_scene(bare) == bare / SCENE
    assert (bare / SCENE).stat().st_size > 1000


def test_it_is_told_how_much_is_done_and_all_of_it_at_the_end(exported: Exported) -> None:
    told = exported.told
    for shares in told.values():
        assert shares == sorted(shares)
        assert 0.0 < shares[0] <= shares[-1] <= 1.0
    assert told["report"][-1] >= (PASSES - 1) / PASSES, "only the pass over the take-overs may be left out"
    assert told["scene"][-1] == 1.0


def test_a_scene_that_fails_leaves_no_file_and_no_lasting_process(bare: Path) -> None:
    (bare / "scene.rrd.new").mkdir()  # where its draft belongs
    with pytest.raises(WorkerError, match=r"scene\.rrd: the scene was not written"):
        write_scene(bare)
    assert not (bare / SCENE).exists()


def test_a_folder_that_is_no_bundle_gets_nothing(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="not a bundle"):
        write_exports(tmp_path)
    assert list(tmp_path.iterdir()) == []


SMALL = """
import json, resource, sys
from pathlib import Path
from simconsole.cli.driven import finish
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
done = drive(resolve(load_session(sys.argv[1])), Path(sys.argv[2]))
pages = int(Path("/proc/self/statm").read_text().split()[0])
resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize(),) * 2)
outcome = finish(done, scene=False)
print(json.dumps([outcome.code, outcome.results["exports_failure"], outcome.results["digest"], outcome.text]))
"""


def test_a_report_without_memory_changes_nothing_of_the_drives_result(tmp_path: Path) -> None:
    session = tmp_path / "plain.yaml"
    session.write_text(
        "schema: 1\nscenario: {vehicle: hatchback, duration_s: 1}\ndevices: {driver: none}\n"
        "outputs: {hud: null, scene: null}\nmode: {pacing: free}\n"
    )
    bundle = tmp_path / "bundle"
    words = [sys.executable, "-c", SMALL, str(session), str(bundle)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    code, failure, digest, text = json.loads(done.stdout)
    assert code == 0
    assert failure
    assert f"report and scene  not written: {failure}" in text
    assert (verify(bundle), open_bundle(bundle).manifest.digest) == ([], digest)
    assert sorted(path.name for path in bundle.iterdir()) == ["drive.log", "manifest.json", "session.json"]


def test_the_report_of_a_robot_tells_of_a_robot(tmp_path: Path) -> None:
    script = tmp_path / "script.yaml"
    forward = "{time_s: 0.3, throttle: 1.0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}"
    script.write_text(f"schema: 1\npoints:\n  - {forward.replace('0.3', '0.0').replace('1.0', '0')}\n  - {forward}\n")
    session = override(
        load_session("turtlebot3_burger"),
        scenario={"duration_s": 2.0},
        outputs={"bridge": None, "hud": None, "scene": None},
        mode={"pacing": "free"},
        devices={"driver": f"script:{script}"},
    )
    folder = drive(resolve(session), tmp_path / "bundle").folder
    found = write_report(folder)
    page = (folder / REPORT).read_text()
    assert (found["speed_limit_kmh"], found["above_limit_s"]) == (None, 0.0)
    assert f"<b>{found['distance_m']:.2f} m</b>" in page
    assert "<th>times that it touched something</th><td>0</td>" in page
    assert "km/h</td></tr>" not in page.split("<h2>Drive</h2>")[1], "no share of a car's torque"
