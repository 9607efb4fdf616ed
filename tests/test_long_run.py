"""The page of the long run, and the seeds of sampled checks."""

import datetime
from types import SimpleNamespace
from typing import Any

from tests.long_run import Check, figure, page
from tests.samples import draw_seed, sample_of

DAY = datetime.date(2026, 1, 2)


def config(**options: object) -> Any:
    return SimpleNamespace(option=SimpleNamespace(**options))


def test_a_run_is_told_check_by_check_and_failures_stand_out() -> None:
    checks = [
        Check("tests/b.py::test_b[1|2]", [], 5.4, True),
        Check("tests/a.py::test_a", ["D10 polling: 80 us (at most 4 ms)", "walk: 200 M ticks"], 600.0, False),
    ]
    told = page(checks, 77, DAY)
    assert "Seed 77: 1 passed, 1 failed." in told
    assert told.endswith(
        "| tests/a.py::test_a | D10 polling: 80 us (at most 4 ms)<br>walk: 200 M ticks | 10 min | FAILED |\n"
        "| tests/b.py::test_b[1/2] | - | 5 s | passed |\n"
    )


def test_figures_are_those_of_faults_and_of_anything_else_that_was_measured() -> None:
    assert figure("case", "D10") is None
    assert figure("fault", "D10 | polling | 80 us | at most 4 ms") == "D10 polling: 80 us (at most 4 ms)"
    assert figure("fault", "D10 | polling | 80 us | ") == "D10 polling: 80 us"
    assert figure("walk", "2 M\n ticks") == "walk: 2 M ticks"


def test_seeds_stay_in_the_sample_and_are_drawn_anew_in_the_long_run() -> None:
    stays = config(long=False, seed=None)
    draw_seed(stays)
    assert stays.option.seed == 0
    given = config(long=True, seed=5)
    draw_seed(given)
    assert given.option.seed == 5
    drawn = [config(long=True, seed=None) for _ in range(2)]
    for each in drawn:
        draw_seed(each)
    assert drawn[0].option.seed != drawn[1].option.seed
    again = [sample_of(given, "a"), sample_of(given, "a"), sample_of(given, "b"), sample_of(stays, "a")]
    assert again[0] == again[1]
    assert len({each.seed for each in again}) == 3
    assert (again[0].of(1, 9), again[3].of(1, 9)) == (9, 1)
