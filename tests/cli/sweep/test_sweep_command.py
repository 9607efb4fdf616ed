import re
import shlex
from html import unescape
from pathlib import Path

import pyarrow.parquet
import yaml

from simconsole.evaluation.sweep.results import RESULTS
from simconsole.recording.bundles.bundle import open_bundle
from tests.drives.console import complaint, results, within
from tests.evaluation.sweep.plans import SCRIPT, SESSION, write_plan

GRIP = {"environment.friction": [0.3, 1.0]}


def test_a_worst_case_is_driven_again_into_a_bundle_that_replays(tmp_path: Path) -> None:
    plan = write_plan(tmp_path, values=GRIP)
    swept = within("sweep", plan, "--jobs", 1, "--out", tmp_path / "sweep", "--json")
    assert swept.returncode == 0, swept.stderr
    assert results(swept)["outcomes"] == {"driven": 2}
    assert {path.name for path in (tmp_path / "sweep").iterdir()} == {RESULTS, "sweep.html", "sweep.jsonl"}
    again = within("sweep", plan, "--drive", 1, "--out", tmp_path / "drive", "--json")
    assert again.returncode == 0, again.stderr
    assert results(again)["digest"] == open_bundle(tmp_path / "drive").manifest.digest
    assert results(again)["digest"] in (tmp_path / "sweep" / "sweep.jsonl").read_text()
    assert within("replay", tmp_path / "drive").returncode == 0


def test_the_commands_of_the_page_drive_what_they_name_and_replay_it(tmp_path: Path) -> None:
    """A session that is driven, and a scenario that fails: the bundles of both have the digests of the sweep."""
    scenario = {
        "schema": 1,
        "title": "too fast",
        "duration_s": 3,
        "session": {**SESSION, "devices": {"driver": "none"}},
        "script": SCRIPT,
        "checks": [{"column": "vehicle.vx_mps", "min": 0.0, "max": 0.1}],
    }
    (tmp_path / "scenario.yaml").write_text(yaml.safe_dump(scenario))
    plan = write_plan(tmp_path, scenarios=["scenario.yaml"], duration_s=4.0)
    swept = within("sweep", plan, "--jobs", 1, "--out", tmp_path / "sweep", "--json")
    assert results(swept)["outcomes"] == {"driven": 1, "failed": 1}
    page = (tmp_path / "sweep" / "sweep.html").read_text()
    commands = set(re.findall("<code>(.*?)</code>", page))
    assert len(commands) == 2
    digests = pyarrow.parquet.read_table(tmp_path / "sweep" / RESULTS)["digest"].to_pylist()
    for command in sorted(unescape(command) for command in commands):
        drive, replay = (shlex.split(part)[1:] for part in command.split("; "))
        again = within(*drive, "--json")
        index = int(drive[drive.index("--drive") + 1])
        assert again.returncode == index, again.stderr
        assert results(again)["digest"] == digests[index] == open_bundle(Path(replay[-1])).manifest.digest
        assert within(*replay).returncode == 0


def test_a_drive_that_cannot_be_driven_is_told_and_is_code_1(tmp_path: Path) -> None:
    plan = write_plan(tmp_path, values=GRIP)
    (tmp_path / "script.yaml").write_text("points: []\n")
    done = within("sweep", plan, "--jobs", 1, "--out", tmp_path / "sweep", "--json")
    assert (done.returncode, results(done)["outcomes"]) == (1, {"refused": 2})
    assert "script.yaml" in (tmp_path / "sweep" / "sweep.html").read_text()


def test_a_scheduler_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    plan = write_plan(tmp_path, values=GRIP)
    words = ("sweep", plan, "--engine", "dask", "--scheduler", "nonsense", "--out", tmp_path / "sweep")
    assert "--scheduler: value nonsense:" in complaint(within(*words))


def test_options_that_do_not_go_together_are_refused(tmp_path: Path) -> None:
    plan = write_plan(tmp_path, values=GRIP)
    assert "--scheduler" in complaint(within("sweep", plan, "--engine", "dask"))
    assert "--scheduler" in complaint(within("sweep", plan, "--scheduler", "tcp://127.0.0.1:1"))
    assert "--drive: value 2: 0 to 1" in complaint(within("sweep", plan, "--drive", 2))
    assert "nowhere.yaml" in complaint(within("sweep", tmp_path / "nowhere.yaml"))
