"""The page of two drives, from drives in memory."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.metrics.table import Drive, drive_of
from simconsole.evaluation.report.paired_page import Side, separation_m, write_paired_report
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.differences import FieldDifference
from simconsole.values.errors import RecordingError


@pytest.fixture
def drives(short: Path) -> tuple[Drive, Drive]:
    """A drive, and the same 3 m to the left and 4 m ahead."""
    table = open_bundle(short).log.table()
    moved = table.vectors.copy()
    moved[:, table.columns.index("vehicle.x_m")] += 4.0
    moved[:, table.columns.index("vehicle.y_m")] += 3.0
    return drive_of(table.vectors, table.columns, 250), drive_of(moved, table.columns, 250)


def differing(field: str) -> FieldDifference:
    return FieldDifference(
        field=field, unit="m", first_tick=7, largest=4.0, largest_tick=9, ticks=3, around=((7, 0.0, 4.0),)
    )


def test_how_far_apart(drives: tuple[Drive, Drive]) -> None:
    assert separation_m(*drives) == pytest.approx(np.full(drives[0].ticks, 5.0))


def test_names_are_text_and_long_lists_are_counted(drives: tuple[Drive, Drive], tmp_path: Path) -> None:
    sides = Side("<was>", drives[0], None), Side("is & was", drives[1], None)
    fields = [differing(f"vehicle.field_{number}") for number in range(50)]
    found = write_paired_report(tmp_path / "pair.html", "<title>", ["a <note>"], sides, fields)
    page = (tmp_path / "pair.html").read_text()
    assert list(found) == ["<was>", "is & was"]
    for text in ("&lt;was&gt;", "is &amp; was", "&lt;title&gt;", "a &lt;note&gt;", "vehicle.field_39", "and 10 more"):
        assert text in page
    for text in ("<was>", "<note>", "vehicle.field_40<"):
        assert text not in page
    assert page.count("whole drive") == 1


def test_a_page_that_cannot_be_written_is_told(drives: tuple[Drive, Drive], tmp_path: Path) -> None:
    sides = Side("one", drives[0], None), Side("two", drives[1], None)
    with pytest.raises(RecordingError, match="cannot be written"):
        write_paired_report(tmp_path / "nowhere" / "pair.html", "title", [], sides, [])
