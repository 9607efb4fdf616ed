import msgspec
import numpy as np
import pytest

from simconsole.recording.log_header import LogHeader, vector_stream
from simconsole.recording.matching import matched, renamed
from simconsole.values.errors import RecordingError


def test_equal_columns_are_taken_as_they_are() -> None:
    match = matched(("a", "b"), ("a", "b"))
    row = np.array([1.0, 2.0])
    assert match.of_first(row) is row
    assert match.of_second(row) is row
    assert (match.columns, match.only_first, match.only_second) == (("a", "b"), (), ())


def test_columns_are_matched_by_name_in_any_order() -> None:
    match = matched(("a", "gone", "b"), ("b", "new", "a", "newer"))
    assert match.columns == ("b", "a")
    assert match.of_first(np.array([1.0, 2.0, 3.0])).tolist() == [3.0, 1.0]
    assert match.of_second(np.array([10.0, 20.0, 30.0, 40.0])).tolist() == [10.0, 30.0]
    assert (match.only_first, match.only_second) == (("gone",), ("new", "newer"))


def test_columns_go_by_the_names_that_they_have_now(header: LogHeader) -> None:
    names = {"driver.brake": "driver.brake_share", "never.was": "nothing"}
    assert renamed(header, names) == (*header.columns[:2], "driver.brake_share", "vehicle.vx_mps")
    assert renamed(header) == header.columns


def test_two_columns_of_one_name_are_refused(header: LogHeader) -> None:
    twice = msgspec.structs.replace(header, streams=(vector_stream(("a", "b"), 0),))
    with pytest.raises(RecordingError, match="two columns 'b'"):
        renamed(twice, {"a": "b"})
