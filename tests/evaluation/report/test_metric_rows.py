"""How figures are written."""

import pytest

from simconsole.evaluation.report.metric_rows import METRICS, MetricRow, rounded


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (0.816, "0.82"),
        (-9.994, "-9.99"),
        (9.996, "10.0"),
        (23.04, "23.0"),
        (99.96, "100"),
        (2513.4, "2513"),
    ],
)
def test_numbers_are_rounded_by_their_size(value: float, text: str) -> None:
    assert rounded(value) == text


def test_counts_stay_whole_and_units_are_those_of_people() -> None:
    assert MetricRow("lights", "Lights", "", "").written(3) == "3"
    assert MetricRow("error_m", "Error", "cm", "", 100.0).written(0.0123) == "1.23 cm"
    assert MetricRow("error_m", "Error", "cm", "", 100.0).written(None) == "-"


def test_every_figure_says_what_it_means() -> None:
    assert all(row.meaning and row.label for row in METRICS)
    assert len({row.key for row in METRICS}) == len(METRICS)
