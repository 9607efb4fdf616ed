"""The map of a drive: who drove where, and what is not joined."""

import itertools
from typing import Any

import numpy as np
import pytest

from simconsole.evaluation.metrics.drive_metrics import mode_changes
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.metrics.track import JUMP_M, track
from simconsole.evaluation.report.colours import PERSON, REMOTE
from simconsole.evaluation.report.figure_map import draw_map
from simconsole.world.course import Course
from tests.evaluation.report.drawn import blank, lines, words


def axes_of(known: Any, course: Course | None) -> Any:
    drive = drive_of(*known)
    way = track(drive, course)
    figure = blank()
    draw_map(figure, drive, way, mode_changes(drive, way), course)
    return figure.axes[0]


def test_each_driver_is_named_once_and_parts_meet(known: Any) -> None:
    axes = axes_of(known, None)
    driven = [line for line in axes.get_lines() if line.get_color() in (PERSON, REMOTE) and len(line.get_xdata()) > 1]
    assert [line.get_color() for line in driven] == [PERSON, REMOTE, PERSON]
    assert len(lines(axes, "driven by the person")) == len(lines(axes, "driven by the autopilot")) == 1
    for earlier, later in itertools.pairwise(driven):
        assert (earlier.get_xdata()[-1], earlier.get_ydata()[-1]) == (later.get_xdata()[0], later.get_ydata()[0])


def test_a_vehicle_that_was_put_elsewhere_leaves_no_line_between(known: Any) -> None:
    vectors = known.vectors[:200].copy()
    x_at = known.columns.index("vehicle.x_m")
    vectors[100:, x_at] += 30.0 * JUMP_M
    axes = axes_of(known._replace(vectors=vectors), None)
    for line in axes.get_lines():
        assert np.abs(np.diff(line.get_xdata())).max(initial=0.0) < 5.0 * JUMP_M


def test_features_of_the_course_are_named_where_there_is_one(known: Any, course: Course) -> None:
    world = course.world
    texts = [text.get_text() for text in axes_of(known, course).texts]
    assert texts.count("crossing") == len(world.crossings)
    assert texts.count("traffic lights") == sum(spot.signalled for spot in world.intersections)
    assert texts.count("roundabout") == len(world.roundabouts)
    assert "crossing" not in words(axes_of(known, None))


def test_start_and_end_are_where_the_drive_began_and_ended(known: Any) -> None:
    axes = axes_of(known, None)
    for label, tick in (("start", 0), ("end", -1)):
        (mark,) = lines(axes, label)
        assert mark.get_xdata()[0] == pytest.approx(known.vectors[tick, known.columns.index("vehicle.x_m")])


def test_among_walls_the_way_is_drawn_as_it_was_driven(known: Any) -> None:
    drive = drive_of(*known)
    way = track(drive, None)
    figure = blank()
    walls = [np.array([[0.0, 0.0, 0.5], [4.0, 0.0, 0.5]]), np.array([[1.0, 1.0, 0.5], [1.0, 2.0, 0.5]])]
    draw_map(figure, drive, way, mode_changes(drive, way), None, walls)
    (axes,) = figure.axes
    (named,) = lines(axes, "walls")
    assert named.get_xdata().tolist() == [0.0, 4.0]
    assert any(line.get_ydata().tolist() == [1.0, 2.0] for line in axes.get_lines())
    plain = axes_of(known, None)
    points = [len(lines(one, "driven by the autopilot")[0].get_xdata()) for one in (axes, plain)]
    assert points[0] > 4 * points[1], "each tick, 20 cm apart"
    assert "theoretical" not in axes.get_title(loc="left")
