"""Lights, stands before them and others who went first, counted from the rows of a drive, by who drove."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.encounters import encounters
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.metrics.track import track
from simconsole.evaluation.report.page import write_report
from simconsole.values.signals import FAR, Mode
from tests.evaluation.conftest import Known

NOTHING = {"lights_passed": 0, "lights_stood_at": 0, "let_pass": 0}


@pytest.fixture
def in_town(known: Known) -> Known:
    """Two lights by the person, who stands at the first, one by the autopilot, and people at three crossings."""
    rows = known.vectors.copy()

    def put(name: str, first: int, after: int, value: float) -> None:
        rows[first:after, known.columns.index(name)] = value

    def light(first: int, line: int, after: int) -> None:
        put("situation.signal_distance_m", first, line, 0.4)
        put("situation.signal_distance_m", line, after, -0.2)

    rows[:, known.columns.index("situation.tick")] = np.arange(1.0, len(rows) + 1.0)
    put("vehicle.vx_mps", 0, len(rows), 10.0)
    put("vehicle.vy_mps", 0, len(rows), 0.0)
    put("situation.signal_distance_m", 0, len(rows), FAR)
    put("situation.yield_m", 0, len(rows), FAR)
    put("arbitration.mode", 0, 25, float(Mode.MANUAL))
    put("arbitration.mode", 25, len(rows), float(Mode.AUTONOMOUS))
    light(2, 6, 8)
    put("vehicle.vx_mps", 3, 5, 0.0)
    light(12, 16, 18)
    light(30, 34, 36)
    put("vehicle.vx_mps", 38, 40, 0.0)  # not before a light
    put("situation.yield_m", 0, 4, 12.0)
    put("situation.yield_m", 20, 24, 12.0)
    put("situation.yield_m", 40, 44, -1.0)
    return Known(rows, known.columns, known.tick_hz)


def test_each_is_counted_for_who_drove(in_town: Known) -> None:
    drive = drive_of(*in_town)
    assert encounters(drive, track(drive, None)) == {
        "whole": {"lights_passed": 3, "lights_stood_at": 1, "let_pass": 3},
        "autonomous": {"lights_passed": 1, "lights_stood_at": 0, "let_pass": 1},
        "manual": {"lights_passed": 2, "lights_stood_at": 1, "let_pass": 2},
    }


def test_a_line_that_is_behind_at_once_is_another_one(in_town: Known) -> None:
    rows = in_town.vectors.copy()
    column = in_town.columns.index("situation.signal_distance_m")
    rows[:, column] = 40.0
    rows[20:, column] = -0.5
    drive = drive_of(rows, in_town.columns, in_town.tick_hz)
    found = encounters(drive, track(drive, None))
    assert found is not None
    assert found["whole"]["lights_passed"] == 0


def test_a_world_without_rules_and_an_older_drive_have_none(known: Known, in_town: Known) -> None:
    rows = in_town.vectors.copy()
    rows[:, in_town.columns.index("situation.tick")] = 0.0
    assert metrics(drive_of(rows, in_town.columns, in_town.tick_hz), None)["road"] is None
    kept = [at for at, name in enumerate(known.columns) if not name.startswith("situation.")]
    older = drive_of(known.vectors[:, kept], [known.columns[at] for at in kept], known.tick_hz)
    assert encounters(older, track(older, None)) is None


def test_metrics_and_page_tell_them(in_town: Known, tmp_path: Path) -> None:
    found = write_report(tmp_path / "r.html", drive_of(*in_town), None, "title")
    assert found["road"]["manual"] != NOTHING
    page = (tmp_path / "r.html").read_text("utf-8")
    assert "<tr><th>Lights passed</th><td class=n>3</td><td class=n>1</td><td class=n>2</td></tr>" in page
    assert "<tr><th>Somebody had to be let pass</th><td class=n>3</td><td class=n>1</td><td class=n>2</td></tr>" in page
    assert "<tr><th>Rules broken</th><td class=n>0</td>" in page
