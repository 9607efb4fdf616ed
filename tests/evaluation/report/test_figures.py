import re
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from numpy.typing import NDArray

from simconsole.evaluation.metrics.drive_metrics import mode_changes
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.metrics.track import track
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


def lines(svg: str, colour: str) -> list[NDArray[np.float64]]:
    """Return each line of a colour, but those of legend and labels, by points close together; y upwards."""
    drawn = (each.attrib for each in ElementTree.fromstring(svg).iter())
    texts = (each["d"] for each in drawn if f"stroke: {colour}" in each.get("style", ""))
    points = (np.array(re.findall(r"[ML] (\S+) (\S+)", text), dtype=float) * (1.0, -1.0) for text in texts)
    return [dense(each) for each in points if len(each) > 3]


def dense(line: NDArray[np.float64]) -> NDArray[np.float64]:
    lengths = np.concatenate(([0.0], np.hypot(*np.diff(line, axis=0).T).cumsum()))
    at = np.linspace(0.0, lengths[-1], 1000)
    return np.column_stack([np.interp(at, lengths, each) for each in line.T])


def test_map_shows_the_driven_path_where_it_was(known: Any, course: Course, svgs: tuple[str, str]) -> None:
    theory = course.offset(0.0, 0.0, course.length_m, 1.0)
    (ruler,) = lines(svgs[0], THEORY)
    unit_m = np.ptp(theory, axis=0) / np.ptp(ruler, axis=0)
    assert unit_m[0] == pytest.approx(unit_m[1], rel=0.01), "as long in x as in y"
    driven = known.vectors[:, [known.columns.index(f"vehicle.{name}") for name in ("x_m", "y_m")]]
    for colour, parts in ((PERSON, [driven[:251], driven[1250:]]), (REMOTE, [driven[250:1251]])):
        shown = [theory.min(axis=0) + (line - ruler.min(axis=0)) * unit_m for line in lines(svgs[0], colour)]
        assert len(shown) == len(parts)
        for line, part in zip(shown, parts, strict=True):
            gaps_m = np.hypot(*(line[:, None, :] - part[None, :, :]).transpose(2, 0, 1))
            assert gaps_m.min(axis=1).max() < 0.5, "nothing is drawn where the car was not"
            assert gaps_m.min(axis=0).max() < 0.5, "and wherever it was something is drawn"


@pytest.mark.parametrize("with_course", [True, False])
def test_odd_drives_are_drawn_too(known: Any, course: Course, with_course: bool) -> None:
    still = known._replace(vectors=np.repeat(known.vectors[:1], 20, axis=0))
    by_hand = known._replace(vectors=known.vectors[:200])
    one = known._replace(vectors=known.vectors[:1])
    for odd in (still, by_hand, one):
        for svg in drawn(odd, course if with_course else None):
            assert ElementTree.fromstring(svg).tag.endswith("svg")
