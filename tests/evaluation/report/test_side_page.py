"""Two drives side by side."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.report.exports import write_side_by_side
from simconsole.evaluation.report.paired_page import Side
from simconsole.evaluation.report.side_page import write_side_page
from simconsole.values.errors import RecordingError
from simconsole.world.course import Course


def page_of(path: Path, sides: tuple[Side, Side]) -> str:
    write_side_page(path / "page.html", sides, ({"driver": "person"}, {"driver": "<ROS>", "trial": "2"}))
    return (path / "page.html").read_text("utf-8")


def test_drives_of_one_route_are_over_their_place_on_it(tmp_path: Path, known: Any, course: Course) -> None:
    shorter = known._replace(vectors=known.vectors[:900])
    text = page_of(tmp_path, (Side("A&1", drive_of(*known), course), Side("B", drive_of(*shorter), course)))
    assert "<h1>A&amp;1 and B</h1>" in text
    assert "<td>driver</td><td>person</td><td>&lt;ROS&gt;</td>" in text
    assert "<td>trial</td><td>-</td><td>2</td>" in text
    assert "<tr><th>Duration</th><td class=n>30.0 s</td><td class=n>18.0 s</td><td class=n>-12.0 s</td></tr>" in text
    for part in ("The whole drives", "What the autopilot drove", "What the person drove"):
        assert f"<h3>{part}</h3>" in text
    assert "Lateral deviation, left positive (deviation / cm): A&amp;1 from -2.00 to 30.0; B from -2.00 to 30.0" in text


def test_a_deviation_that_is_much_larger_gets_axes_of_its_own(tmp_path: Path, known: Any, course: Course) -> None:
    aside = known.vectors.copy()
    aside[:, [known.columns.index("vehicle.x_m"), known.columns.index("vehicle.y_m")]] += 3.0
    text = page_of(
        tmp_path,
        (Side("near", drive_of(*known), course), Side("far", drive_of(aside, known.columns, known.tick_hz), course)),
    )
    assert "Lateral deviation: near (deviation / cm): near from" in text
    assert "Lateral deviation: far (deviation / cm): far from" in text


def test_drives_without_a_common_route_are_shown_too(tmp_path: Path, known: Any, course: Course) -> None:
    by_hand = known.vectors.copy()
    by_hand[:, known.columns.index("arbitration.mode")] = 1.0
    hand = drive_of(np.asarray(by_hand), known.columns, known.tick_hz)
    text = page_of(tmp_path, (Side("one", drive_of(*known), course), Side("other", hand, None)))
    assert "What the autopilot drove: only in one of the two." in text
    assert "Lateral deviation" not in text


def test_a_bundle_beside_itself_is_refused(short: Path, tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="two different ones"):
        write_side_by_side(short, short, tmp_path / "page.html")
    assert not (tmp_path / "page.html").exists()
