import math
from collections.abc import Iterator, Sequence

import msgspec
import numpy as np
import pytest

from simconsole.recording.compare import Comparison, MessageDifference, compare
from simconsole.recording.framing import Record, SealedMessage
from simconsole.recording.log_header import LogHeader, vector_stream
from simconsole.values.errors import RecordingError
from tests.recording.conftest import with_messages


class Ticks:
    """A recording in memory."""

    def __init__(self, header: LogHeader, records: Sequence[Record]) -> None:
        self.header = header
        self._records = records

    def __iter__(self) -> Iterator[Record]:
        return iter(self._records)


def records(rows: Sequence[np.ndarray], first: int = 1) -> list[Record]:
    return [Record(tick, row, b"") for tick, row in enumerate(rows, start=first)]


def with_columns(header: LogHeader, *columns: str) -> LogHeader:
    return msgspec.structs.replace(header, streams=(vector_stream(columns, 2),))


def test_equal_recordings(header: LogHeader, rows: list[np.ndarray]) -> None:
    drive = Ticks(header, records(rows))
    assert compare(drive, drive) == Comparison(True, 40)


def test_every_field_that_differs_to_the_end(header: LogHeader, rows: list[np.ndarray]) -> None:
    other = [row.copy() for row in rows]
    other[19][3] += 0.5
    other[39][2] += 0.25
    result = compare(Ticks(header, records(rows)), Ticks(header, records(other)))
    assert (result.equal, result.ticks) == (False, 40)
    assert [(one.field, one.first_tick) for one in result.differences] == [("vehicle.vx_mps", 20), ("driver.brake", 40)]
    assert compare(Ticks(header, records(rows)), Ticks(header, records(other)), {"*": 0.5}).equal
    with pytest.raises(RecordingError, match=r"vehicle\.vz_mps"):
        compare(Ticks(header, []), Ticks(header, []), {"vehicle.vz_mps": 0.5})


def test_a_shorter_recording_differs_where_it_ends(header: LogHeader, rows: list[np.ndarray]) -> None:
    whole = Ticks(header, records(rows))
    short = compare(whole, Ticks(header, records(rows[:30])))
    assert (short.equal, short.ticks, short.differences) == (False, 30, ())
    assert short.reason == "only 30 ticks could be compared, then tick 31 against the end"
    shifted = compare(whole, Ticks(header, records(rows, 2)))
    assert shifted.reason == "only 0 ticks could be compared, then tick 1 against tick 2"


def test_recordings_of_different_rates_are_not_compared(header: LogHeader) -> None:
    slower = msgspec.structs.replace(header, tick_hz=100)
    assert compare(Ticks(header, []), Ticks(slower, [])).reason.endswith("tick_hz 250 against 100")


def test_columns_that_only_one_has_are_named_and_the_others_compared(header: LogHeader, rows: list[np.ndarray]) -> None:
    wider = with_columns(header, *header.columns[:2], "sample.new_axis", *header.columns[2:3], "vehicle.speed_mps")
    other = [np.array([*row[:2], 9.0, row[2], row[3]]) for row in rows]
    result = compare(Ticks(header, records(rows)), Ticks(wider, records(other)))
    assert (result.equal, result.only_first) == (True, ("vehicle.vx_mps",))
    assert result.only_second == ("sample.new_axis", "vehicle.speed_mps")
    names = {"vehicle.vx_mps": "vehicle.speed_mps"}
    again = compare(Ticks(header, records(rows)), Ticks(wider, records(other)), names=names)
    assert (again.equal, again.only_first, again.only_second) == (True, (), ("sample.new_axis",))
    other[4][4] += math.pi
    assert not compare(Ticks(header, records(rows)), Ticks(wider, records(other)), names=names).equal


def test_messages_are_compared_by_stream_and_tick(header: LogHeader, rows: list[np.ndarray]) -> None:
    said, unsaid = records(rows), records(rows)
    for tick, words in ((7, b"a"), (9, b"b"), (12, b"c")):
        said[tick - 1] = said[tick - 1]._replace(messages=(SealedMessage(1, words, b""),))
    unsaid[6] = said[6]
    unsaid[8] = unsaid[8]._replace(messages=(SealedMessage(1, b"B\xff", b""), SealedMessage(1, b"", b"")))
    result = compare(Ticks(with_messages(header), said), Ticks(with_messages(header), unsaid))
    assert not result.equal
    assert result.messages == (MessageDifference("acts", 9, 2, ("b",), ("B\ufffd", "")),)
    assert compare(Ticks(with_messages(header), said), Ticks(with_messages(header), said)).equal
    assert not compare(Ticks(header, records(rows)), Ticks(with_messages(header), said)).equal
    assert compare(Ticks(header, records(rows)), Ticks(with_messages(header), records(rows))).equal
