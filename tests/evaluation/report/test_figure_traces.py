"""The drive over its distance: deviation, speed, steering, modes."""

import itertools
from typing import Any

import numpy as np
import pytest

from simconsole.evaluation.metrics.drive_metrics import mode_changes
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.metrics.track import track
from simconsole.evaluation.report.figure_traces import draw_traces
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from simconsole.world.course import Course
from tests.evaluation.report.drawn import blank, lines, words


def axes_of(known: Any, course: Course | None) -> Any:
    drive = drive_of(*known)
    way = track(drive, course)
    figure = blank()
    draw_traces(figure, drive, way, mode_changes(drive, way), course)
    return figure.axes


def test_deviation_of_person_and_autopilot_are_apart_and_in_cm(known: Any, course: Course) -> None:
    lateral = axes_of(known, course)[0]
    (autopilot,) = lines(lateral, "autopilot")
    assert np.nanmax(np.abs(autopilot.get_ydata())) == pytest.approx(2.0, abs=0.01)
    (worst,) = (line for line in lateral.get_lines() if str(line.get_label()).startswith("max "))
    assert worst.get_label() == f"max {abs(worst.get_ydata()[0]):.2f} cm"
    assert lines(lateral, "person") == []
    low, high = lateral.get_ylim()
    assert low < -2.0 < 2.0 < high < 30.0, "the person's 30 cm do not decide the scale"
    by_person = axes_of(known, course)[1]
    (person,) = lines(by_person, "person")
    assert np.nanmax(person.get_ydata()) == pytest.approx(30.0, abs=0.01)
    assert 30.0 < by_person.get_ylim()[1] < 60.0
    assert by_person.get_ylabel() == "deviation / cm"


def test_metres_of_a_person_are_told_in_metres(known: Any, course: Course) -> None:
    drive = drive_of(*known)
    way = track(drive, course)
    far = way._replace(lateral_m=np.where(way.autonomous, way.lateral_m, 7.25))
    figure = blank()
    draw_traces(figure, drive, far, mode_changes(drive, far), course)
    assert [axes.get_ylabel() for axes in figure.axes[:2]] == ["deviation / cm", "deviation / m"]
    assert figure.axes[0].get_ylim()[1] < 10.0
    assert len(lines(figure.axes[1], "max 7.25 m")) == 1


def test_speed_is_in_km_h_beside_the_limit(known: Any, course: Course) -> None:
    speed = axes_of(known, course)[2]
    (driven,) = lines(speed, "driven")
    assert driven.get_ydata() == pytest.approx(36.0)
    assert len(lines(speed, "limit 50 km/h")) == 1
    assert lines(axes_of(known, None)[1], "limit 50 km/h") == []


def test_modes_fill_the_distance_without_gap_in_their_colours(known: Any) -> None:
    modes = axes_of(known, None)[3]
    bars = [(bar.get_x(), bar.get_width(), bar.get_facecolor()) for bar in modes.patches]
    assert len(bars) == 3
    for (x, width, _), (following, _, _) in itertools.pairwise(bars):
        assert x + width == pytest.approx(following)
    assert bars[0][2] == bars[2][2] != bars[1][2]
    assert words(modes) == {mode_label(Mode.MANUAL), mode_label(Mode.AUTONOMOUS)}


def test_without_a_course_the_panel_says_why_it_is_empty(known: Any) -> None:
    lateral = axes_of(known, None)[0]
    assert words(lateral) == {"no course in this world"}


def test_hand_over_and_take_over_are_marked_and_nothing_else(known: Any, course: Course) -> None:
    axes = axes_of(known, course)
    upright = [line for line in axes[3].get_lines() if len(set(line.get_xdata())) == 1]
    assert len(upright) == 2


def test_of_a_robot_there_are_speed_yaw_rate_and_mode(known: Any) -> None:
    drive = drive_of(*known)
    way = track(drive, None)
    figure = blank()
    draw_traces(figure, drive, way, mode_changes(drive, way), None, robot=True)
    assert [axes.get_ylabel() for axes in figure.axes] == ["speed / km/h", "yaw rate / deg/s", "mode"]
    (turning,) = (line for line in figure.axes[1].get_lines() if len(line.get_xdata()) > 2)
    assert np.abs(turning.get_ydata()).max() == pytest.approx(
        np.degrees(np.abs(known.vectors[:, known.columns.index("vehicle.yaw_rate_radps")]).max())
    )
