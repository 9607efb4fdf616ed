"""Panels of a manoeuvre: two beside each other, and which line has which colour."""

import numpy as np

from simconsole.evaluation.manoeuvres.attempt import Line, Panel
from simconsole.evaluation.report.colours import LIMIT
from simconsole.evaluation.report.figure_panels import draw_panels
from tests.evaluation.report.drawn import blank

X = np.arange(3.0)


def panel(*labels: str) -> Panel:
    return Panel("Title", "x", "y", tuple(Line(label, X, X + place) for place, label in enumerate(labels)))


def test_an_odd_panel_leaves_its_neighbours_place_empty() -> None:
    for count in (1, 2, 3, 4):
        figure = blank()
        draw_panels(figure, (panel("a"),) * count)
        seen = [axes.get_visible() for axes in figure.axes]
        assert seen == [True] * count + [False] * (len(seen) - count)
        assert len(seen) - count == (count == 3)


def test_cones_are_grey_beside_a_named_line_and_lines_alone_are_not() -> None:
    figure = blank()
    draw_panels(figure, (panel("driven", "", ""), panel("", "")))
    driven, *cones = figure.axes[0].get_lines()
    assert driven.get_color() != LIMIT
    assert {line.get_color() for line in cones} == {LIMIT}
    first, second = figure.axes[1].get_lines()
    assert LIMIT not in (first.get_color(), second.get_color())
    assert first.get_color() != second.get_color()
    assert [axes.get_legend() is not None for axes in figure.axes] == [True, False]


def test_more_lines_than_colours_are_drawn_too() -> None:
    figure = blank()
    draw_panels(figure, (panel(*"abcdefgh"),))
    assert [line.get_ydata()[0] for line in figure.axes[0].get_lines()] == list(range(8))
