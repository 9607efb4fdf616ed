from pathlib import Path

import pytest

from simconsole.evaluation.sweep.journal import JOURNAL, Journal
from simconsole.evaluation.sweep.task import TaskResult
from simconsole.values.errors import RecordingError
from tests.evaluation.sweep.plans import grip


def result(index: int) -> TaskResult:
    return TaskResult(index=index, outcome="driven", ticks=10 * index, metrics={"distance_m": index / 3.0})


def test_a_journal_goes_on_where_it_was_cut_at_every_byte(tmp_path: Path) -> None:
    plan = grip(tmp_path)
    folder = tmp_path / "sweep"
    with Journal(folder, plan) as journal:
        for index in (2, 0, 1):
            journal.add(result(index))
    whole = (folder / JOURNAL).read_bytes()
    ends = [at + 1 for at, byte in enumerate(whole) if byte == ord("\n")]
    for cut in range(len(whole) + 1):
        (folder / JOURNAL).write_bytes(whole[:cut])
        with Journal(folder, plan) as journal:
            kept = [2, 0, 1][: max(0, sum(end <= cut for end in ends) - 1)]
            assert journal.results == {index: result(index) for index in kept}, cut
            for index in {0, 1, 2} - journal.results.keys():
                journal.add(result(index))
        with Journal(folder, plan) as journal:
            assert journal.results == {index: result(index) for index in range(3)}, cut
        lines = (folder / JOURNAL).read_bytes().splitlines()
        assert len(lines) == len(set(lines)) == 4, "no double rows, none missing"


def test_results_of_another_plan_are_not_mixed_with_these(tmp_path: Path) -> None:
    with Journal(tmp_path / "sweep", grip(tmp_path)):
        pass
    with pytest.raises(RecordingError, match="another plan"):
        Journal(tmp_path / "sweep", grip(tmp_path, 5))


def test_a_file_that_is_no_journal_is_left_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "sweep").mkdir()
    (tmp_path / "sweep" / JOURNAL).write_bytes(b"something else\n")
    with pytest.raises(RecordingError, match="cannot be gone on with"):
        Journal(tmp_path / "sweep", grip(tmp_path))
    assert (tmp_path / "sweep" / JOURNAL).read_bytes() == b"something else\n"
