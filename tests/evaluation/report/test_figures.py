from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from simconsole.evaluation.metrics.drive_metrics import mode_changes, track
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.report.colours import END, PERSON, REMOTE, START, THEORY
from simconsole.evaluation.report.figures import map_svg, traces_svg
from simconsole.world.course import Course


def drawn(known: Any, course: Course | None) -> tuple[str, str]:
    drive = drive_of(*known)
    way = track(drive, course)
    changes = mode_changes(drive, way)
    return map_svg(drive, way, changes, course), traces_svg(drive, way, changes, course)


@pytest.fixture(scope="module")
def svgs(known: Any, course: Course) -> tuple[str, str]:
    return drawn(known, course)


def test_same_drive_same_bytes(known: Any, course: Course, svgs: tuple[str, str]) -> None:
    assert drawn(known, course) == svgs


def test_both_are_whole_svg_without_a_date(svgs: tuple[str, str]) -> None:
    for svg in svgs:
        assert ElementTree.fromstring(svg).tag.endswith("svg")
        assert "<dc:date>" not in svg
        assert "<!DOCTYPE" not in svg


def test_map_has_both_paths_and_both_ends(svgs: tuple[str, str]) -> None:
    for colour in (THEORY, PERSON, REMOTE, START, END):
        assert colour in svgs[0]


def test_map_shows_the_driven_path_where_it_was(known: Any, course: Course, svgs: tuple[str, str]) -> None:
    moved = known.rows.copy()
    moved[:, known.columns.index("vehicle.y_m")] += 5.0
    other, _ = drawn(known._replace(rows=moved), course)
    assert other != svgs[0]


@pytest.mark.parametrize("with_course", [True, False])
def test_odd_drives_are_drawn_too(known: Any, course: Course, with_course: bool) -> None:
    still = known._replace(rows=np.repeat(known.rows[:1], 20, axis=0))
    by_hand = known._replace(rows=known.rows[:200])
    one = known._replace(rows=known.rows[:1])
    for odd in (still, by_hand, one):
        for svg in drawn(odd, course if with_course else None):
            assert ElementTree.fromstring(svg).tag.endswith("svg")
