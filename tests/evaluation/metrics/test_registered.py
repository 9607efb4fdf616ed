"""A metric of another package: installed beside us, found everywhere where ours are, and refused where it is wrong."""

import math
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.evaluation.metrics.registered import GROUP, Driven, Figure, OwnMetric, measured, registered
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.metrics.track import track
from simconsole.values.errors import MetricError, ProfileError
from tests.drives.console import environment
from tests.drives.console import simconsole as command
from tests.installed import installed
from tests.paths import ROOT

USED = """
import json, sys
from pathlib import Path
import pyarrow.parquet
import simconsole
from simconsole.cli.main import main
folder = Path(sys.argv[1])
session = {
    "schema": 1,
    "scenario": {"vehicle": "ball"},
    "outputs": {"bridge": None, "hud": None, "scene": None, "sound": None},
    "devices": {"driver": "none"},
    "mode": {"pacing": "free", "tick_hz": 50},
}
(folder / "stands.yaml").write_text(json.dumps({**session, "scenario": {"vehicle": "ball", "duration_s": 2.0}}))
bounds = [{"metric": "own.quick.standing_s", "min": 2.0, "max": 2.0}]
scenario = {"schema": 1, "title": "stands", "duration_s": 2, "session": session, "metrics": bounds}
(folder / "scenario.yaml").write_text(json.dumps(scenario))
plan = {"schema": 1, "sessions": ["stands.yaml"], "scenarios": ["scenario.yaml"]}
(folder / "plan.yaml").write_text(json.dumps(plan))

drive = simconsole.load(folder / "stands.yaml").run(duration_s=2.0, out=folder / "bundle")
assert drive.metrics["own"] == {"quick": {"standing_s": 2.0, "accel_rms_mps2": None}}, drive.metrics["own"]
assert main(["report", str(folder / "bundle")]) == 0
page = (folder / "bundle" / "report.html").read_text()
assert "<tr><td>quick</td><td>standing_s</td><td class=n>2</td></tr>" in page
assert main(["check", str(folder / "scenario.yaml"), "--update-golden"]) == 0
(folder / "scenario.yaml").write_text(json.dumps({**scenario, "metrics": [{**bounds[0], "max": 1.0, "min": 0.0}]}))
assert main(["check", str(folder / "scenario.yaml")]) == 1
(folder / "scenario.yaml").write_text(json.dumps(scenario))
assert main(["sweep", str(folder / "plan.yaml"), "--jobs", "1", "--out", str(folder / "swept")]) == 0
table = pyarrow.parquet.read_table(folder / "swept" / "results.parquet").to_pydict()
assert table["metrics.own.quick.standing_s"] == [2.0, 2.0], table
"""


def test_a_metric_of_another_package_stands_where_ours_do(tmp_path: Path) -> None:
    assert command("new", "metric", "quick", "--out", tmp_path).returncode == 0
    installed(tmp_path, GROUP, quick="METRIC")
    (tmp_path / "here").mkdir()
    words = [sys.executable, "-c", USED, str(tmp_path / "here")]
    path = os.pathsep.join((str(tmp_path), str(ROOT)))
    done = subprocess.run(words, capture_output=True, text=True, check=False, env=environment(PYTHONPATH=path))
    assert done.returncode == 0, done.stdout + done.stderr


def driven() -> Driven:
    columns = ("vehicle.x_m", "vehicle.y_m", "vehicle.vx_mps", "vehicle.vy_mps", "arbitration.mode")
    drive = drive_of(np.zeros((3, len(columns))), columns, 50)
    return Driven(drive, track(drive, None), None)


def fails(seen: Driven) -> dict[str, float]:
    raise KeyError("speed")


@pytest.mark.parametrize(
    ("measure", "told"),
    [
        (fails, "metric quick: KeyError: 'speed'"),
        (lambda seen: None, "metric quick: TypeError: "),
        (lambda seen: {"share": "x"}, "metric quick: ValueError: "),
        (lambda seen: {"other_m": 1.0}, "metric quick: other_m: one of share"),
        (lambda seen: {"share": math.nan}, "metric quick: share: value nan: a finite number, 0 to 1"),
        (lambda seen: {"share": math.inf}, "metric quick: share: value inf: a finite number"),
        (lambda seen: {"share": 1.5}, "metric quick: share: value 1.5: a finite number, 0 to 1"),
    ],
)
def test_what_breaks_its_promise_is_one_line(measure: Callable[[Driven], Any], told: str) -> None:
    with pytest.raises(MetricError, match=f"^{told}") as error:
        measured("quick", OwnMetric({"share": Figure("a share", 0.0, 1.0)}, measure), driven())
    assert "\n" not in str(error.value)


def test_a_figure_that_a_drive_has_not_is_none() -> None:
    metric = OwnMetric({"share": Figure("a share", 0.0, 1.0), "way_m": Figure("a way")}, lambda seen: {"share": 1})
    assert measured("quick", metric, driven()) == {"share": 1.0, "way_m": None}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("raise RuntimeError('no\\nlicence')", "quick:METRIC: RuntimeError: no licence"),
        ("METRIC = 1", "quick:METRIC: an OwnMetric"),
    ],
)
def test_what_cannot_be_loaded_is_one_line(
    text: str, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    installed(tmp_path, GROUP, quick="METRIC")
    (tmp_path / "quick.py").write_text(text)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "quick", raising=False)
    with pytest.raises(ProfileError, match=f"^simconsole.metrics: value quick: {told}") as error:
        registered()
    assert "\n" not in str(error.value)
    sys.modules.pop("quick", None)
