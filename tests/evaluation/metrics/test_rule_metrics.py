"""Broken rules of the road as a table, from the rows of a drive."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.rule_metrics import RULES, RuleEvent, plain_events, rule_events
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.report.page import write_report
from simconsole.values.signals import FAR, Rules
from tests.evaluation.conftest import Known


@pytest.fixture
def lawless(known: Known) -> Known:
    rows = known.vectors.copy()

    def put(name: str, first: int, after: int, value: float) -> None:
        rows[first:after, known.columns.index(name)] = value

    put("vehicle.vx_mps", 0, len(rows), 15.0)
    put("vehicle.vx_mps", 15, 16, 20.0)
    put("situation.speed_limit_mps", 0, 40, 13.89)
    put("situation.speed_limit_mps", 40, len(rows), FAR)
    put("rules.speeding", 10, 20, 1.0)
    put("rules.speeding", 30, 31, 1.0)
    put("rules.red_light", 12, 14, 1.0)
    put("rules.off_road", 45, len(rows), 1.0)
    return Known(rows, known.columns, known.tick_hz)


def test_every_breach_in_order(lawless: Known) -> None:
    drive = drive_of(*lawless)
    distance = drive.column("vehicle.distance_m")
    assert rule_events(drive) == [
        RuleEvent("speeding", 11, 20, float(distance[10]), 20.0, 13.89),
        RuleEvent("red_light", 13, 14, float(distance[12]), 15.0, 13.89),
        RuleEvent("speeding", 31, 31, float(distance[30]), 15.0, 13.89),
        RuleEvent("off_road", 46, drive.ticks, float(distance[45]), 15.0, None),
    ]


def test_metrics_and_page_tell_them(lawless: Known, tmp_path: Path) -> None:
    found = write_report(tmp_path / "r.html", drive_of(*lawless), None, "title")
    assert found["rules"] == plain_events(drive_of(*lawless))
    assert found["rules"][0]["limit_kmh"] == pytest.approx(50.0, abs=0.01)
    page = (tmp_path / "r.html").read_text("utf-8")
    assert "<h2>Rules of the road</h2>" in page
    assert "red light passed</td><td class=n>0.26 s</td><td class=n>0.28 s" in page


def test_who_obeys_and_a_drive_from_before_there_were_rules_has_none(known: Known, tmp_path: Path) -> None:
    assert metrics(drive_of(*known), None)["rules"] == []
    kept = [at for at, name in enumerate(known.columns) if not name.startswith(("rules.", "situation."))]
    older = drive_of(known.vectors[:, kept], [known.columns[at] for at in kept], known.tick_hz)
    assert rule_events(older) == []
    write_report(tmp_path / "r.html", drive_of(*known), None, "title")
    assert "Rules of the road" not in (tmp_path / "r.html").read_text("utf-8")


def test_every_rule_has_its_words() -> None:
    assert tuple(RULES) == Rules._fields[: len(RULES)]
    assert np.unique(list(RULES.values())).size == len(RULES)
