import pytest

from simconsole.drivers.robots.allocation.methods_table import PAPER, MethodRow, methods_table


def test_the_table_has_the_papers_columns_and_does_not_beat_it() -> None:
    rows = [
        MethodRow("exact", 10.0, 10.0, (10.0,), (0.0002,)),
        MethodRow("auction", 10.0, 10.0, (10.0, 11.0), (0.002, 0.004)),
    ]
    assert rows[1].deviation == pytest.approx(0.05)
    assert rows[1].mean_time_s == pytest.approx(0.003)
    text = methods_table("a scene", rows)
    assert text.splitlines()[1].split() == ["method", "best", "cost", "computing", "time", "deviation"]
    assert "auction" in text
    assert "3.000 ms" in text
    assert "5.00 %" in text
    assert PAPER in text


def test_rounding_is_no_deviation_and_nothing_to_do_is_none() -> None:
    assert MethodRow("exact", 1.0, 1.0, (1.0 - 1e-15,), (1.0,)).deviation == 0.0
    assert MethodRow("exact", 0.0, 0.0, (0.0,), (1.0,)).deviation == 0.0
