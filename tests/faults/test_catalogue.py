"""Every case of the catalogue has a test, and what these saw is kept by case."""

from tests.faults import cases
from tests.faults.catalogue import CATALOGUE, marks, places
from tests.faults.figures import Seen, cells, lines, seen, table, updated

NUMBERS = {case.number for case in CATALOGUE}


def test_the_catalogue_has_68_cases() -> None:
    assert len(NUMBERS) == len(CATALOGUE) == 68
    counted = {letter: sum(number[0] == letter for number in NUMBERS) for letter in "DRNPCF"}
    assert counted == {"D": 13, "R": 13, "N": 19, "P": 12, "C": 5, "F": 6}
    assert {number for case in cases.CASES for number in case.number.split()} <= NUMBERS


def test_each_case_has_a_test_and_each_mark_a_case() -> None:
    tested = set(places())
    assert not NUMBERS - tested, "cases without a test"
    assert not tested - NUMBERS, "marks of no case"


def test_a_mark_is_found_wherever_it_stands() -> None:
    source = '@pytest.mark.fault("D01")\ndef test_a(): ...\n\nX = pytest.param(1, marks=pytest.mark.fault("N02"))\n'
    assert sorted(marks(source)) == ["D01", "N02"]
    assert not list(marks('@pytest.mark.parametrize("fault", ["D01"])\ndef test_b(): ...'))


def test_figures_of_a_run_are_kept_by_case() -> None:
    run = [
        [("case", "D10"), ("fault", "D10 | polling | 80 us | at most 4 ms")],
        [("case", "D10"), ("case", "R09"), ("seed", "1")],
        [("other", "text")],
    ]
    found = seen(run)
    assert found == {"D10": Seen(2, {"polling": "80 us (at most 4 ms)"}), "R09": Seen(1, {})}
    assert list(lines(found, whole=False)) == [
        "faults: 2 of 68 cases, 3 tests passed, 1 figures",
        "  D10 polling: 80 us (at most 4 ms)",
    ]
    assert not list(lines({}, whole=True))


def test_a_run_of_long_checks_alone_leaves_the_other_figures() -> None:
    before = {"D10": "3 tests passed<br>polling: 1 us<br>share: 0", "R09": "1 tests passed"}
    found = {"D10": Seen(1, {"polling": "2 us"})}
    assert updated(before, found, whole=False) == before | {"D10": "3 tests passed<br>polling: 2 us<br>share: 0"}
    assert updated(before, found, whole=True) == before | {"D10": "1 tests passed<br>polling: 2 us"}
    assert cells(table(before))["D10"] == before["D10"]
