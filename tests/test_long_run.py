"""The page of the long run, and the seeds of sampled checks."""

import datetime
from types import SimpleNamespace
from typing import Any

from tests.long_run import PAGE, Check, figure, is_there, page, rows, rows_of
from tests.samples import draw_seed, sample_of

DAY = datetime.date(2026, 1, 2)


def config(**options: object) -> Any:
    return SimpleNamespace(option=SimpleNamespace(**options))


CHECKS = [
    Check("tests/b.py::test_b[1|2]", [], 5.4, True),
    Check("tests/a.py::test_a", ["D10 polling: 80 us (at most 4 ms)", "walk: 200 M ticks"], 600.0, False),
]


def test_a_run_is_told_check_by_check_and_failures_stand_out() -> None:
    failed, passed = page(rows(CHECKS, 77, DAY)).splitlines()[-2:]
    assert failed.startswith("| tests/a.py::test_a | D10 polling: 80 us (at most 4 ms)<br>walk: 200 M ticks | 10 min |")
    assert failed.endswith("| 2026-01-02 | 77 | FAILED |")
    assert passed.startswith("| tests/b.py::test_b[1/2] | - | 5 s |")
    assert passed.endswith("| 2026-01-02 | 77 | passed |")


def test_a_run_of_some_renews_their_rows() -> None:
    before = rows(CHECKS, 77, DAY)
    assert rows_of(page(before)) == before
    again = {**rows_of(page(before)), **rows([CHECKS[1]._replace(passed=True)], 78, DAY)}
    assert again["tests/a.py::test_a"].endswith("| 78 | passed |\n")
    assert again["tests/b.py::test_b[1/2]"] == before["tests/b.py::test_b[1/2]"]


def test_all_that_stands_in_the_page_passed() -> None:
    found = rows_of(PAGE.read_text("utf-8"))
    assert len(found) > 50
    assert [row for row in found.values() if not row.endswith("| passed |\n")] == []


def test_a_test_that_is_no_more_is_known() -> None:
    root = PAGE.parents[1]
    assert is_there("tests/test_long_run.py::test_a_test_that_is_no_more_is_known[1]", root)
    assert not is_there("tests/test_long_run.py::test_that_never_was", root)
    assert not is_there("tests/no_such_file.py::test_a", root)


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
