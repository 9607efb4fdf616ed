from collections.abc import Iterator, Sequence
from typing import Any, cast

import numpy as np
import pytest

from simconsole.evaluation.metrics import table
from simconsole.evaluation.metrics.table import drive_of, read_at_once, recorded_drive, runs
from simconsole.recording.log_header import LogHeader, vector_stream
from simconsole.recording.reading import Block, LogTable, gathered, places
from simconsole.values.errors import RecordingError


def test_columns_by_name_and_time_by_tick(known: Any) -> None:
    drive = drive_of(known.vectors, known.columns, 50, first_tick=101)
    assert drive.column("vehicle.vx_mps").tolist() == [10.0] * 1500
    assert drive.time_s[0] == pytest.approx(2.02)
    with pytest.raises(RecordingError, match=r"vehicle\.nothing is missing"):
        drive.column("vehicle.nothing")


@pytest.mark.parametrize(
    ("rows", "words"), [(np.zeros((0, 2)), "0 ticks"), (np.zeros((5, 3)), "3 columns, must be 2"), ([], "0 ticks")]
)
def test_rows_that_fit_nothing_are_refused(rows: Any, words: str) -> None:
    with pytest.raises(RecordingError, match=words):
        drive_of(rows, ("a.a", "b.b"), 250)


def test_runs_are_found_across_blocks() -> None:
    values = np.array([3.0, 3.0, 1.0, 1.0, 1.0, 2.0, 3.0, 3.0])
    for cuts in ([], [2], [1, 4], [5, 6, 7], [1, 2, 3, 4, 5, 6, 7]):
        found = runs(np.split(values, cuts))
        assert found.starts.tolist() == [0, 2, 5, 6]
        assert found.ends.tolist() == [2, 5, 6, 8]
        assert found.values.tolist() == [3.0, 1.0, 2.0, 3.0]


class Reader:
    """A recording of which only blocks are read; what it holds may change."""

    def __init__(self, count: int, size: int) -> None:
        streams = (vector_stream(("a", "b"), 0),)
        self.header = LogHeader(tick_hz=50, streams=streams, console_version="", source_sha256="", session_sha256="")
        self.rows = np.arange(2.0 * count).reshape(count, 2)
        self.passes: list[Sequence[str] | None] = []
        self._size = size

    def table(self) -> LogTable:
        return gathered(self.header, None, self.blocks(None))

    def blocks(self, columns: Sequence[str] | None) -> Iterator[Block]:
        self.passes.append(columns)
        at = places(self.header, columns)
        for start in range(0, len(self.rows), self._size):
            part = self.rows[start : start + self._size, at]
            yield Block(np.arange(start + 11, start + 11 + len(part)), part)


def test_a_recorded_drive_is_read_column_by_column_and_says_how_far_it_is() -> None:
    reader: Any = Reader(10, 4)
    told: list[float] = []
    drive = recorded_drive(reader, told.append)
    assert (drive.ticks, drive.tick_hz, drive.first_tick) == (10, 50, 11)
    assert drive.column("b").tolist() == reader.rows[:, 1].tolist()
    b, a = drive.columns("b", "a")
    assert (a.tolist(), b.tolist()) == (reader.rows[:, 0].tolist(), reader.rows[:, 1].tolist())
    assert reader.passes == [(), ("b",), ("b", "a")]
    assert told == pytest.approx([1.0, 1.4, 1.8, 2.0, 2.4, 2.8, 3.0])
    with pytest.raises(RecordingError, match="no column 'c'"):
        drive.column("c")


def test_a_recording_that_grows_or_shrinks_while_it_is_read() -> None:
    reader: Any = Reader(10, 4)
    drive = recorded_drive(reader)
    more = np.vstack((reader.rows, reader.rows))
    reader.rows = more
    assert drive.column("a").tolist() == more[:10, 0].tolist()
    reader.rows = more[:9]
    with pytest.raises(RecordingError, match="only 9 of its 10 ticks"):
        drive.column("a")
    with pytest.raises(RecordingError, match="0 ticks: nothing to report"):
        recorded_drive(cast("Any", Reader(0, 4)))


def test_a_short_drive_is_read_at_once_and_a_long_one_as_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    reader: Any = Reader(10, 4)
    drive = read_at_once(reader, 9)
    assert (drive.ticks, drive.tick_hz, drive.first_tick) == (9, 50, 11)
    assert [drive.column(name).tolist() for name in "ab"] == reader.rows[:9].T.tolist()
    assert reader.passes == [None]
    monkeypatch.setattr(table, "IN_MEMORY", 19)
    assert read_at_once(reader, 10).column("b").tolist() == reader.rows[:, 1].tolist()
    assert reader.passes[1:] == [(), ("b",)]


@pytest.mark.parametrize("size", [1, 3, 4, 10, 100])
def test_windows_are_parts_of_the_columns(size: int) -> None:
    reader: Any = Reader(40, size)
    drive = recorded_drive(reader)
    spans = [(0, 3), (2, 9), (9, 10), (20, 40)]
    found = list(drive.windows(("b", "a"), spans))
    for (first, after), window in zip(spans, found, strict=True):
        assert window["a"].tolist() == reader.rows[first:after, 0].tolist()
        assert window["b"].tolist() == reader.rows[first:after, 1].tolist()
    before = len(reader.passes)
    assert list(drive.windows(("a",), [])) == []
    assert len(reader.passes) == before, "nothing is read for nothing"
