import subprocess
import sys
from pathlib import Path

import numpy as np

from simconsole.scene.viewer.job import save_job
from tests.scene.drives import job, rows
from tests.scene.viewer.test_export import DRIVE, WORLD, contents, rerun_rrd

# The live drive is fed whole state vectors, 100 ticks at a time, as a ring gives them.
FEEDER = """
import sys
from pathlib import Path
import numpy as np
from simconsole.values.state_vector import Snapshot
from simconsole.scene.viewer.follow import Ports, follow
from simconsole.scene.viewer.job import load_job

folder = Path(sys.argv[1])
job, rows = load_job(folder / "job.npz"), np.load(folder / "rows.npy")
given = 0
def new_ticks():
    global given
    start, given = given, min(given + 100, len(rows))
    return [Snapshot(i + 1, job.tick_hz, rows[i]) for i in range(start, given)]
def stop():
    return given >= len(rows)
if sys.argv[3] == "die":
    def stop():
        if given >= 2000:
            import os, signal
            os.kill(os.getpid(), signal.SIGKILL)
states = iter(["nobody"] * 2 + ["1 client"] * 9 + ["lost"] * 999)
link = (lambda: next(states)) if sys.argv[3] == "link" else lambda: None
follow(Ports(new_ticks, stop, link=link), job._replace(profile=job.profile.__class__(chunk_s=0.05)), Path(sys.argv[2]))
"""


def follow_apart(folder: Path, ending: str) -> tuple[int, Path]:
    save_job(folder / "job.npz", job())
    np.save(folder / "rows.npy", rows(3000))
    path = folder / "scene.rrd"
    done = subprocess.run(
        [sys.executable, "-c", FEEDER, str(folder), str(path), ending], capture_output=True, check=False
    )
    assert not done.stderr, "rerun is not to complain on the console's terminal"
    return done.returncode, path


def test_a_live_drive_is_recorded_whole(tmp_path: Path) -> None:
    code, path = follow_apart(tmp_path, "stop")
    assert code == 0
    found = contents(path)
    assert set(found) >= WORLD | DRIVE
    assert found["/world/ego"] == 600
    assert found["/lanes/mode"] == 5 + 1
    assert found["/log"] == 7


def test_a_killed_scene_leaves_what_it_had_written(tmp_path: Path) -> None:
    code, path = follow_apart(tmp_path, "die")
    assert code == -9
    printed = rerun_rrd("print", str(path))
    assert printed.returncode == 0
    assert "/world/road/surface" in printed.stdout


def test_a_live_drive_has_no_index_and_is_read_from_its_beginning(tmp_path: Path) -> None:
    """What a viewer does that opens it; the index of scene.rrd stands at its end."""
    code, path = follow_apart(tmp_path, "stop")
    assert code == 0
    verified = rerun_rrd("verify", str(path))
    assert "1 errors" in verified.stderr
    assert "Missing RRD footer" in verified.stdout + verified.stderr
    routed = rerun_rrd("stats", str(path))
    assert routed.returncode == 0


def test_how_the_bridge_stands_is_a_lane_of_a_live_drive_that_has_one(tmp_path: Path) -> None:
    code, path = follow_apart(tmp_path, "link")
    assert code == 0
    assert contents(path)["/lanes/link"] == 3
    code, path = follow_apart(tmp_path, "stop")
    assert "/lanes/link" not in contents(path)
