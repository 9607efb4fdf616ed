import numpy as np

from simconsole.evaluation.manoeuvres.attempt import Line, Panel
from simconsole.evaluation.report.figure_words import panels_words


def test_a_plot_is_told_by_the_spans_of_its_named_lines() -> None:
    x = np.arange(3.0)
    lines = (Line("driven", x, np.array([0.5, np.nan, 2.0])), Line("", x, x + 9.0), Line("gone", x, np.full(3, np.nan)))
    assert panels_words([Panel("Speed", "t, s", "km/h", lines)]) == (
        "Speed (km/h): driven from 0.50 to 2.00; gone nothing."
    )


def test_of_lines_without_names_the_first_is_told() -> None:
    x = np.arange(3.0)
    assert panels_words([Panel("Yaw", "t, s", "deg", (Line("", x, x + 1.0), Line("", x, x)))]).endswith(
        "Yaw (deg): from 1.00 to 3.00."
    )
