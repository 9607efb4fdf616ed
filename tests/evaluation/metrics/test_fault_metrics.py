"""When which fault was on, from the rows of a drive."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.fault_metrics import FaultSpan, fault_spans
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.report.page import write_report
from tests.evaluation.conftest import Known


@pytest.fixture
def faulty(known: Known) -> Known:
    rows = known.vectors.copy()
    masks = np.zeros(len(rows))
    masks[10:20] += 1
    masks[15:30] += 4
    masks[40:50] += 1
    rows[:, known.columns.index("events.faults")] = masks
    return Known(rows, known.columns, known.tick_hz)


def test_every_span_of_every_fault_in_order(faulty: Known) -> None:
    spans = fault_spans(drive_of(*faulty), ["unplug device wheel", "noise axis wheel"])
    assert spans == [
        FaultSpan("unplug device wheel", 11, 20),
        FaultSpan("fault 2", 16, 30),
        FaultSpan("unplug device wheel", 41, 50),
    ]


def test_metrics_and_page_name_them(faulty: Known, tmp_path: Path) -> None:
    found = write_report(tmp_path / "r.html", drive_of(*faulty), None, "title", faults=["unplug <wheel>"])
    assert found["faults"][0] == {
        "fault": "unplug <wheel>",
        "first_tick": 11,
        "last_tick": 20,
        "first_s": 0.22,
        "last_s": 0.4,
    }
    page = (tmp_path / "r.html").read_text("utf-8")
    assert "<h2>Faults</h2>" in page
    assert "unplug &lt;wheel&gt;</td><td class=n>0.220 s</td><td class=n>0.400 s" in page


def test_a_drive_without_faults_has_none_and_says_nothing(known: Known, tmp_path: Path) -> None:
    assert metrics(drive_of(*known), None)["faults"] == []
    write_report(tmp_path / "r.html", drive_of(*known), None, "title")
    assert "Faults" not in (tmp_path / "r.html").read_text("utf-8")
