"""The review as `simconsole check --review` writes it."""

import re
from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.checks.review import ColumnReview, Review
from simconsole.evaluation.report.review_page import PLOTS, write_review
from simconsole.values.errors import RecordingError
from tests.drives.console import complaint, within


def column(name: str) -> ColumnReview:
    time_s = np.array([0.5, 1.0])
    return ColumnReview(
        column=name,
        unit="m/s",
        time_s=time_s,
        accepted=time_s,
        driven=2.0 * time_s,
        first_s=0.5,
        largest=1.0,
        largest_s=1.0,
    )


def test_every_column_is_named_and_the_first_ones_are_plotted(tmp_path: Path) -> None:
    columns = tuple(column(f"vehicle.speed_{number}_mps") for number in range(PLOTS + 3))
    review = Review("launch", "Launch <fast>", ("a <remark>",), columns)
    write_review(tmp_path / "review.html", [review], ["stop"])
    page = (tmp_path / "review.html").read_text()
    assert "Launch &lt;fast&gt;" in page
    assert "a &lt;remark&gt;" in page
    assert "Equal to the bit: stop." in page
    assert page.count("<svg") == 1
    assert len(re.findall(r"<tr><td>vehicle\.speed_\d+_mps</td><td>m/s</td>", page)) == PLOTS + 3


def test_a_page_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="cannot be written"):
        write_review(tmp_path / "nowhere" / "review.html", [], [])


def test_the_command_shows_who_left_and_who_kept_its_golden(tmp_path: Path) -> None:
    within("new", "scenario", "kept", "--out", tmp_path)
    within("new", "scenario", "left", "--out", tmp_path)
    path = tmp_path / "left.yaml"
    path.write_text(path.read_text().replace("accel_mps2: 1.5", "accel_mps2: 1.6"))
    near = tmp_path / "near.yaml"
    near.write_text(path.read_text() + "tolerances:\n  - {columns: '*', absolute: 1000.0, relative: 1000.0}\n")
    (tmp_path / "golden" / "near.csv").write_bytes((tmp_path / "golden" / "left.csv").read_bytes())
    golden = (tmp_path / "golden" / "left.csv").read_bytes()
    page = tmp_path / "review.html"
    done = within("check", tmp_path / "kept.yaml", path, near, "--review", page)
    assert done.returncode == 1
    text = page.read_text()
    assert "Equal to the bit: kept." in text
    assert "Not equal, within their tolerances: near." in text
    assert "<h2>left: left</h2>" in text
    assert "<td>ros.accel_mps2</td>" in text
    assert (tmp_path / "golden" / "left.csv").read_bytes() == golden


def test_looking_and_accepting_at_once_is_refused(tmp_path: Path) -> None:
    done = within("check", "launch_and_stop", "--review", tmp_path / "review.html", "--update-golden")
    assert done.returncode == 2
    assert "look first" in complaint(done)
