import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from simconsole.scene.entities import Dimensions
from simconsole.scene.timeline import PLOTS
from simconsole.scene.viewer.export import export_apart, main
from simconsole.scene.viewer.job import save_job
from simconsole.values.errors import WorkerError
from tests.scene.drives import job

WORLD = {"/world/road/surface", "/world/road/paint", "/world/road/edges", "/world/road/centre", "/world/road/ground",
         "/world/path/theoretical", "/world/lights/posts", "/world/lights/lamps", "/map/road/edges",
         "/map/path/theoretical", "/map/lights"}  # fmt: skip
DRIVE = {"/world/ego", "/world/ego/body", "/world/path/driven", "/map/ego", "/map/path/driven", "/lanes/mode",
         "/lanes/remote", "/lanes/takeover", "/lanes/transmission", "/lanes/turn_indicators", "/lanes/hazard_lights",
         "/log",
         *(f"/{plot.path}" for plot in PLOTS)}  # fmt: skip


def rerun_rrd(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [str(Path(sys.executable).with_name("rerun")), "rrd", *arguments]
    # CI keeps the command-line tool from counting its users.
    return subprocess.run(command, capture_output=True, text=True, check=False, env={**os.environ, "CI": "1"})


def contents(path: Path) -> dict[str, int]:
    """Return the rows of each entity of a recording, read in a process of its own."""
    program = (
        "import sys, json, rerun as rr\n"
        "rows = {}\n"
        "for entry in rr.chunk.RrdReader(sys.argv[1]).stream():\n"
        "    rows[entry.entity_path] = rows.get(entry.entity_path, 0) + entry.num_rows\n"
        "print(json.dumps(rows))\n"
    )

    done = subprocess.run([sys.executable, "-c", program, str(path)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found: dict[str, int] = json.loads(done.stdout)
    return found


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("scene") / "scene.rrd"
    export_apart(job(), path)
    return path


def test_the_recording_is_sound(recording: Path) -> None:
    done = rerun_rrd("verify", str(recording))
    assert done.returncode == 0, done.stdout + done.stderr
    assert [path.name for path in recording.parent.iterdir()] == ["scene.rrd"]


def test_the_recording_holds_world_and_drive(recording: Path) -> None:
    rows = contents(recording)
    assert set(rows) >= WORLD | DRIVE
    assert rows["/plots/speed"] == 600 + 1  # 12 s at 50 Hz, and the line's name
    assert rows["/world/ego"] == 600
    assert rows["/lanes/mode"] == 5 + 1
    assert rows["/log"] == 7


def test_the_recording_brings_its_blueprint(recording: Path) -> None:
    printed = rerun_rrd("print", str(recording)).stdout
    assert "Blueprint" in printed
    for view in ("3D", "2D", "StateTimeline", "TimeSeries", "TextLog"):
        assert view in rerun_rrd("print", "-vvv", str(recording)).stdout


def test_a_drive_without_a_course_is_shown_too(tmp_path: Path) -> None:
    path = tmp_path / "ball.rrd"
    export_apart(job(500, with_course=False)._replace(dimensions=Dimensions(1.0, 1.0, 1.0, 0.5)), path)
    assert rerun_rrd("verify", str(path)).returncode == 0
    rows = contents(path)
    assert not WORLD & set(rows)
    assert rows["/world/ego"] == 100


@pytest.mark.parametrize("content", [b"", b"not a job", b"PK\x03\x04 torn"])
def test_a_damaged_job_is_one_clear_line(tmp_path: Path, content: bytes, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "job.npz"
    path.write_bytes(content)
    assert main([str(path), str(tmp_path / "scene.rrd")]) == 2
    said = capsys.readouterr().err
    assert str(path) in said
    assert said.count("\n") == 1
    assert "Traceback" not in said


def test_missing_files_are_one_clear_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path / "none.npz"), str(tmp_path / "scene.rrd")]) == 2
    assert "none.npz: cannot be read" in capsys.readouterr().err
    assert main([]) == 2
    assert "usage" in capsys.readouterr().err
    with pytest.raises(WorkerError, match=r"job\.npz: cannot be written"):
        save_job(tmp_path / "nowhere" / "job.npz", job(1))


def test_a_folder_that_is_not_there_leaves_a_clear_line(tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match=r"scene\.rrd.*(cannot|not) be written|was not written"):
        export_apart(job(10), tmp_path / "nowhere" / "scene.rrd")


def test_an_export_that_hangs_is_ended(tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match=r"was not written within 0\.001 s"):
        export_apart(job(10), tmp_path / "scene.rrd", deadline_s=0.001)
    assert not (tmp_path / "scene.rrd").exists()
