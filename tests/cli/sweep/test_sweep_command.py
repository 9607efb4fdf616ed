from pathlib import Path

from simconsole.evaluation.sweep.results import RESULTS
from simconsole.recording.bundles.bundle import open_bundle
from tests.drives.console import complaint, results, simconsole
from tests.evaluation.sweep.plans import write_plan

GRIP = {"environment.friction": [0.3, 1.0]}


def test_a_worst_case_is_driven_again_into_a_bundle_that_replays(tmp_path: Path) -> None:
    plan = write_plan(tmp_path, values=GRIP)
    swept = simconsole("sweep", plan, "--jobs", 1, "--out", tmp_path / "sweep", "--json")
    assert swept.returncode == 0, swept.stderr
    assert results(swept)["outcomes"] == {"driven": 2}
    assert {path.name for path in (tmp_path / "sweep").iterdir()} == {RESULTS, "sweep.html", "sweep.jsonl"}
    again = simconsole("sweep", plan, "--drive", 1, "--out", tmp_path / "drive", "--json")
    assert again.returncode == 0, again.stderr
    assert results(again)["digest"] == open_bundle(tmp_path / "drive").manifest.digest
    assert results(again)["digest"] in (tmp_path / "sweep" / "sweep.jsonl").read_text()
    assert simconsole("replay", tmp_path / "drive").returncode == 0


def test_a_drive_that_cannot_be_driven_is_told_and_is_code_1(tmp_path: Path) -> None:
    plan = write_plan(tmp_path, values=GRIP)
    (tmp_path / "script.yaml").write_text("points: []\n")
    done = simconsole("sweep", plan, "--jobs", 1, "--out", tmp_path / "sweep", "--json")
    assert (done.returncode, results(done)["outcomes"]) == (1, {"refused": 2})
    assert "script.yaml" in (tmp_path / "sweep" / "sweep.html").read_text()


def test_options_that_do_not_go_together_are_refused(tmp_path: Path) -> None:
    plan = write_plan(tmp_path, values=GRIP)
    assert "--scheduler" in complaint(simconsole("sweep", plan, "--engine", "dask"))
    assert "--scheduler" in complaint(simconsole("sweep", plan, "--scheduler", "tcp://127.0.0.1:1"))
    assert "--drive: value 2: 0 to 1" in complaint(simconsole("sweep", plan, "--drive", 2))
    assert "nowhere.yaml" in complaint(simconsole("sweep", tmp_path / "nowhere.yaml"))
