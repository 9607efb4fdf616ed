import numpy as np
import pytest

from simconsole.evaluation.checks.whole_drive import judge_metrics, judge_modes, modes_of, numbers
from simconsole.evaluation.metrics.table import drive_of
from simconsole.profiles.scenario import MetricCheck
from simconsole.values.signals import Mode

DRIVEN = [(1, Mode.PARKED), (100, Mode.MANUAL), (200, Mode.AUTONOMOUS)]


def test_modes_in_their_order_are_right_and_none_are_any() -> None:
    assert judge_modes(("parked", "manual", "autonomous"), DRIVEN) == []
    assert judge_modes((), DRIVEN) == []


@pytest.mark.parametrize(
    ("wanted", "told"),
    [
        (("parked", "autonomous"), "modes: tick 100: manual, not autonomous; driven parked, manual, autonomous"),
        (("parked", "manual"), "modes: tick 200: autonomous, not any more; driven parked, manual, autonomous"),
        (
            ("parked", "manual", "autonomous", "stopped"),
            "modes: stopped did not come; driven parked, manual, autonomous",
        ),
    ],
)
def test_another_order_is_named_where_it_begins(wanted: tuple[str, ...], told: str) -> None:
    assert judge_modes(wanted, DRIVEN) == [told]  # type: ignore[arg-type]  # names of modes


def test_modes_are_read_from_a_drive() -> None:
    rows = np.repeat([0.0, 1.0, 3.0], [4, 3, 2])[:, np.newaxis]
    assert modes_of(drive_of(rows, ("arbitration.mode",), 100)) == [(1, 0), (5, 1), (8, 3)]


def test_figures_are_held_against_their_bounds() -> None:
    found = dict(numbers({"a": {"b": 2.0, "c": "text", "d": [1, 2]}, "e": float("nan")}))
    assert found["a.d.count"] == 2.0
    assert judge_metrics((MetricCheck(metric="a.b", min=2.0, max=2.0),), found) == []
    assert judge_metrics((MetricCheck(metric="a.b", max=1.5),), found) == ["a.b: 2 not in -inf to 1.5"]
    assert len(judge_metrics((MetricCheck(metric="e"),), found)) == 1, "NaN is outside every bound"
    assert judge_metrics((MetricCheck(metric="a.c"),), found)[0].startswith("metrics: the drive has no a.c; it has a.b")
