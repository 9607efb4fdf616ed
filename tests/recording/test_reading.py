import numpy as np
import pytest

from simconsole.recording.log_header import LogHeader, vector_stream
from simconsole.recording.reading import Block, gathered, places
from simconsole.values.errors import RecordingError

HEADER = LogHeader(
    tick_hz=250,
    streams=(vector_stream(("a", "b", "c"), 1),),
    console_version="0",
    source_sha256="",
    session_sha256="",
)


def test_places_follow_the_order_asked_for() -> None:
    assert places(HEADER, None) == [0, 1, 2]
    assert places(HEADER, ("c", "a")) == [2, 0]


def test_a_column_that_is_not_there_is_named() -> None:
    with pytest.raises(RecordingError, match="'d'"):
        places(HEADER, ("a", "d"))


def test_gathered_blocks_are_one_table_in_their_order() -> None:
    blocks = [Block(np.array([1, 2]), np.array([[1.0], [2.0]])), Block(np.array([3]), np.array([[3.0]]))]
    table = gathered(HEADER, ("b",), blocks)
    assert table.columns == ("b",)
    assert table.ticks.tolist() == [1, 2, 3]
    assert table.column("b").tolist() == [1.0, 2.0, 3.0]


def test_a_recording_without_ticks_is_an_empty_table() -> None:
    table = gathered(HEADER, None, [])
    assert table.columns == ("a", "b", "c")
    assert table.vectors.shape == (0, 3)
