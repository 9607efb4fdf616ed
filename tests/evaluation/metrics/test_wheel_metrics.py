"""How much of the car's torque the wheel gave, from the rows of a drive."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.metrics.wheel_metrics import force_feedback
from simconsole.evaluation.report.page import write_report
from tests.evaluation.conftest import Known


def with_wheel(known: Known, share: float, first: int, last: int, enabled: float = 1.0) -> Known:
    """Let the wheel give all of the car's torque, but for some ticks."""
    rows = known.vectors.copy()
    shares = np.ones(len(rows))
    shares[first:last] = share
    rows[:, known.columns.index("torque.car_share")] = shares * enabled
    rows[:, known.columns.index("torque.enabled")] = enabled
    return Known(rows, known.columns, known.tick_hz)


def test_least_share_and_how_long_it_was_below_one(known: Known) -> None:
    drive = with_wheel(known, 0.62, 100, 250)
    drive.vectors[120, drive.columns.index("torque.car_share")] = 0.4
    drive.vectors[120, drive.columns.index("vehicle.vx_mps")] = -20.0
    found = force_feedback(drive_of(*drive))
    assert found == {"least_share": 0.4, "least_at_kmh": 72.0, "eased_s": 3.0, "eased_from_s": pytest.approx(2.02)}


def test_servo_and_wheel_that_is_let_go_of_give_nothing_of_the_cars_torque(known: Known) -> None:
    assert force_feedback(drive_of(*with_wheel(known, 0.0, 0, 1500))) is None
    assert force_feedback(drive_of(*with_wheel(known, 0.5, 0, 1500, enabled=0.0))) is None
    some = force_feedback(drive_of(*with_wheel(known, 0.0, 100, 250)))
    assert some == {"least_share": 1.0, "least_at_kmh": 36.0, "eased_s": 0.0, "eased_from_s": None}


def test_drive_that_did_not_record_the_share_has_none(known: Known) -> None:
    at = known.columns.index("torque.car_share")
    columns = tuple(name for name in known.columns if name != "torque.car_share")
    assert force_feedback(drive_of(np.delete(known.vectors, at, axis=1), columns, known.tick_hz)) is None


def test_report_shows_it(known: Known, tmp_path: Path) -> None:
    found = write_report(tmp_path / "r.html", drive_of(*with_wheel(known, 0.62, 100, 250)), None, "title")
    text = (tmp_path / "r.html").read_text("utf-8")
    assert found["force_feedback"]["least_share"] == 0.62
    assert "<td>62 % at 36 km/h</td>" in text
    assert "<td>3.0 s, from 2.02 s</td>" in text
    write_report(tmp_path / "all.html", drive_of(*with_wheel(known, 1.0, 0, 0)), None, "title")
    assert "Eased" not in (tmp_path / "all.html").read_text("utf-8")
