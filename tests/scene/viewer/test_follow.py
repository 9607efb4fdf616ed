import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from simconsole.scene.viewer.live_file import HEAD
from tests.paths import ROOT
from tests.scene.drives import rows
from tests.scene.viewer.test_export import DRIVE, WORLD, contents, rerun_rrd

# The live drive is fed whole state vectors, 100 ticks at a time, as a ring gives them.
FEEDER = """
import itertools, sys
from pathlib import Path
import numpy as np
from simconsole.processes.notices import Notice
from simconsole.values.state_vector import Snapshot
from simconsole.scene.timeline import Entry
from simconsole.values.planned_path import PlannedPath
from simconsole.scene.viewer.follow import Ports, Shot, follow
from tests.scene.drives import job as make_job

folder = Path(sys.argv[1])
job, rows = make_job()._replace(has_camera=True), np.load(folder / "rows.npy")
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
link = (lambda: next(states)) if sys.argv[3] == "beside" else lambda: None
if sys.argv[3] == "beside":
    told = iter([PlannedPath(400_000_000 * number, np.ones((21, 4))) for number in range(1, 11)])
    def plans():
        plan = next(told, None)
        return [] if plan is None else [plan]
else:
    plans = tuple
pictures = {"camera": lambda: Shot(given // 500, b"no picture")} if sys.argv[3] == "beside" else {}
hops = {"receive, hud": {"p50": 410.0, "p99": 800.0, "max": 900.0, "count": 7.0}}
lines = iter([[Entry(1, "INFO", "operator: mark")]])
if sys.argv[3] == "beside":
    clock = itertools.count(0.0, 0.06)  # which passes by being asked
    notices = iter([[Notice("WARN", "supervisor: the hud worker has ended (signal 9) and is started again")]])
    pictures["notices"] = lambda: next(notices, [])
    pictures |= {"latencies": lambda: hops, "entries": lambda: next(lines, []), "clock_s": lambda: next(clock)}
job = job._replace(profile=job.profile.__class__(chunk_s=0.05))
follow(Ports(new_ticks, stop, plans=plans, link=link, **pictures), job, Path(sys.argv[2]))
"""


def follow_apart(folder: Path, ending: str) -> tuple[int, Path]:
    np.save(folder / "rows.npy", rows(3000))
    path = folder / "scene.rrd"
    done = subprocess.run(
        [sys.executable, "-c", FEEDER, str(folder), str(path), ending], capture_output=True, check=False, cwd=ROOT
    )
    assert not done.stderr, "rerun is not to complain on the console's terminal"
    return done.returncode, path


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The scene of a drive that came to its end. Read only."""
    code, path = follow_apart(tmp_path_factory.mktemp("whole"), "stop")
    assert code == 0
    return path


@pytest.fixture(scope="module")
def in_whole(whole: Path) -> dict[str, int]:
    """The rows of each of its entities."""
    return contents(whole)


@pytest.fixture(scope="module")
def beside(tmp_path_factory: pytest.TempPathFactory) -> dict[str, int]:
    """The rows of each entity of the same drive beside which all is told that no state vector holds."""
    code, path = follow_apart(tmp_path_factory.mktemp("beside"), "beside")
    assert code == 0
    return contents(path)


@pytest.fixture(scope="module")
def killed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What was written of the same drive when the scene was killed in it. Put back what a test changes."""
    code, path = follow_apart(tmp_path_factory.mktemp("killed"), "die")
    assert code == -9
    return path


def test_a_live_drive_is_recorded_whole(in_whole: dict[str, int]) -> None:
    assert set(in_whole) >= WORLD | DRIVE
    assert in_whole["/world/ego"] == 600
    assert in_whole["/lanes/mode"] == 5 + 1
    assert in_whole["/log"] == 7


def test_a_killed_scene_leaves_what_it_had_written(killed: Path) -> None:
    printed = rerun_rrd("print", str(killed))
    assert printed.returncode == 0
    assert "/world/road/surface" in printed.stdout


def test_a_live_drive_is_one_stream_without_an_end(whole: Path) -> None:
    """Whoever follows the file reads on; the index of scene.rrd stands at its end."""
    content = whole.read_bytes()
    assert content.startswith(HEAD)
    assert content.count(HEAD + b"FOOT") == 0
    verified = rerun_rrd("verify", str(whole))
    assert "1 errors" in verified.stderr
    assert "Missing RRD footer" in verified.stdout + verified.stderr


def test_a_scene_that_was_restarted_goes_on_in_the_same_file(killed: Path) -> None:
    before, content = contents(killed), killed.read_bytes()
    try:
        code, path = follow_apart(killed.parent, "stop")
        assert code == 0
        assert path.read_bytes().startswith(content)
        found = contents(path)
    finally:
        killed.write_bytes(content)
    assert found["/world/ego"] == before["/world/ego"] + 600
    assert found["/world/road/surface"] == 2, "said again by the new process"


def test_how_the_bridge_stands_is_a_lane_of_a_live_drive_that_has_one(
    in_whole: dict[str, int], beside: dict[str, int]
) -> None:
    assert beside["/health/bridge"] == 3 + 1
    assert in_whole["/health/bridge"] == 1, "its colours only"


def test_pictures_latencies_and_words_are_shown_at_the_newest_tick(beside: dict[str, int]) -> None:
    assert 2 <= beside["/camera"] <= 7, "each picture once, and none that was not the newest"
    assert 4 <= beside["/latency"] <= 8, "once a second of the clock, of 30 batches"
    assert beside["/log"] == 7 + 1 + 1, "the operator's act and the supervisor's notice"


def test_plans_are_shown_live_as_in_the_recording_and_go_when_nobody_renews_them(beside: dict[str, int]) -> None:
    for entity in ("/world/path/plan", "/world/path/plan/places", "/map/path/plan"):
        assert beside[entity] == 1 + 10 + 1, entity
