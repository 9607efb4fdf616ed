import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from simconsole.scene.lanes import LANES
from simconsole.scene.plots import PLOTS
from tests.paths import ROOT
from tests.scene.drives import rows

WORLD = {"/world/road/surface", "/world/road/paint", "/world/road/edges", "/world/road/centre", "/world/road/ground",
         "/world/path/theoretical", "/world/lights/posts", "/world/lights/lamps", "/map/road/edges",
         "/map/path/theoretical", "/map/lights"}  # fmt: skip
DRIVE = {"/world/ego", "/world/ego/body", "/world/path/driven", "/map/ego", "/map/path/driven", "/log",
         "/world/ego/wheels", "/world/ego/tyre_forces", "/world/path/ahead", "/map/path/ahead",
         "/world/path/plan", "/world/path/plan/places", "/map/path/plan",
         *(f"/{kind.path}" for kind in LANES), *(f"/{plot.path}" for plot in PLOTS)}  # fmt: skip


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


# A scene is only ever written in a process of its own.
WRITER = """
import sys
from pathlib import Path
import numpy as np
from simconsole.scene.viewer.export import export
from tests.scene.drives import job
from simconsole.values.errors import WorkerError
from simconsole.values.planned_path import PlannedPath

folder, path, block = Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3])
rows = np.load(folder / "rows.npy")
ticks = np.arange(1, len(rows) + 1)
places = np.ones((21, 4))
plans = [PlannedPath(200_000_000 * number, places) for number in range(1, 31)] if sys.argv[4] == "car" else ()
blocks = [(ticks[at : at + block], rows[at : at + block]) for at in range(0, len(rows), block)]
try:
    export(job(kind=sys.argv[4]), blocks, path, plans=plans)
except WorkerError as problem:
    sys.exit(str(problem))
"""


def exported(folder: Path, path: Path, kind: str, count: int, block: int = 1000) -> str:
    """Export a drive of `count` ticks and return what was said about it."""
    np.save(folder / "rows.npy", rows(count))
    words = [sys.executable, "-c", WRITER, str(folder), str(path), str(block), kind]
    return subprocess.run(words, capture_output=True, text=True, check=False, cwd=ROOT).stderr


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("scene") / "scene.rrd"
    assert exported(tmp_path_factory.mktemp("job"), path, "car", 3000) == ""
    return path


def test_the_recording_is_sound(recording: Path) -> None:
    done = rerun_rrd("verify", str(recording))
    assert done.returncode == 0, done.stdout + done.stderr
    assert [path.name for path in recording.parent.iterdir()] == ["scene.rrd"]


def test_the_recording_holds_world_and_drive(recording: Path) -> None:
    found = contents(recording)
    assert set(found) >= WORLD | DRIVE
    assert found["/plots/speed"] == 600 + 1  # 12 s at 50 Hz, and the line's name
    assert found["/world/ego"] == 600
    assert found["/lanes/mode"] == 5 + 1
    assert found["/log"] == 7
    assert found["/world/path/plan"] == 30 + 1 + 1, "its look, 30 plans, and that there is none after the last"


def test_the_recording_brings_its_blueprint(recording: Path) -> None:
    printed = rerun_rrd("print", str(recording)).stdout
    assert "Blueprint" in printed
    at_length = rerun_rrd("print", "-vvv", str(recording)).stdout
    for view in ("3D", "2D", "StateTimeline", "TimeSeries", "TextLog"):
        assert view in at_length


def test_a_drive_without_a_course_is_shown_too(tmp_path: Path) -> None:
    path = tmp_path / "ball.rrd"
    assert exported(tmp_path, path, "ball", 500) == ""
    assert rerun_rrd("verify", str(path)).returncode == 0
    found = contents(path)
    assert not WORLD & set(found)
    assert found["/world/ego"] == 100
    assert found["/world/path/plan"] == 1


def test_the_blocks_in_which_a_drive_comes_change_nothing_of_what_it_was(tmp_path: Path, recording: Path) -> None:
    path = tmp_path / "scene.rrd"
    assert exported(tmp_path, path, "car", 3000, 170) == ""
    strips = {"/world/path/driven", "/map/path/driven"}  # one of them ends with each block
    found, whole = contents(path), contents(recording)
    assert {name: found[name] for name in DRIVE - strips} == {name: whole[name] for name in DRIVE - strips}


def test_a_folder_that_is_not_there_leaves_a_clear_line(tmp_path: Path) -> None:
    said = exported(tmp_path, tmp_path / "nowhere" / "scene.rrd", "car", 10)
    assert re.search(r"scene\.rrd.*cannot be written", said.splitlines()[-1])
    assert "Traceback" not in said
