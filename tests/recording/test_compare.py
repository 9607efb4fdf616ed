import math
from collections.abc import Sequence

import msgspec
import numpy as np
import pytest

from simconsole.recording.compare import Comparison, compare
from simconsole.recording.framing import Record
from simconsole.recording.log_header import LogHeader, vector_stream


def records(rows: Sequence[np.ndarray], first: int = 1) -> list[Record]:
    return [Record(tick, row, b"") for tick, row in enumerate(rows, start=first)]


def against(header: LogHeader, left: list[Record], right: list[Record], **tolerances: float) -> Comparison:
    named = {key.replace("__", "."): value for key, value in tolerances.items()}
    return compare(left, header, right, header, named)


def changed(rows: list[np.ndarray], tick: int, column: int, value: float) -> list[Record]:
    other = [row.copy() for row in rows]
    other[tick - 1][column] = value
    return records(other)


def test_equal_recordings(header: LogHeader, rows: list[np.ndarray]) -> None:
    assert against(header, records(rows), records(rows)) == Comparison(True, 40, None, "")


def test_the_first_differing_tick_and_field_with_a_window(header: LogHeader, rows: list[np.ndarray]) -> None:
    other = changed(rows, 20, 3, rows[19][3] + 0.5)
    result = against(header, records(rows), other)
    assert not result.equal
    assert result.ticks == 19
    assert result.difference is not None
    assert result.difference[:2] == (20, "vehicle.vx_mps")
    assert str(result.difference).startswith("tick 20: vehicle.vx_mps: ")
    lines = result.window.splitlines()
    assert lines[0].split() == ["17", "18", "19", ">20", "21", "22", "23"]
    assert lines[1] == "vehicle.vx_mps"
    assert lines[4].split() == ["change", "0", "0", "0", "0.5", "0", "0", "0"]


def test_one_bit_is_a_difference_without_a_tolerance(header: LogHeader, rows: list[np.ndarray]) -> None:
    value = math.nextafter(rows[4][2], math.inf)
    assert against(header, records(rows), changed(rows, 5, 2, value)).ticks == 4
    assert against(header, records(rows), changed(rows, 5, 2, value), driver__brake=1e-9).equal


@pytest.mark.parametrize(("change", "equal"), [(0.0625, True), (0.125, False), (math.nan, False), (math.inf, False)])
def test_a_tolerance_is_absolute_and_per_column(
    header: LogHeader, rows: list[np.ndarray], change: float, equal: bool
) -> None:
    base = changed(rows, 9, 3, 1.0)
    other = changed(rows, 9, 3, 1.0 + change)
    assert compare(base, header, other, header, {"vehicle.*": 0.0625}).equal is equal
    assert not compare(base, header, other, header, {"driver.*": 100.0}).equal
    assert compare(base, header, other, header, {"*": math.inf}).equal


def test_the_last_matching_pattern_counts(header: LogHeader, rows: list[np.ndarray]) -> None:
    other = changed(rows, 9, 3, rows[8][3] + 1.0)
    assert compare(records(rows), header, other, header, {"*": 0.1, "vehicle.vx_mps": 2.0}).equal
    assert not compare(records(rows), header, other, header, {"vehicle.vx_mps": 2.0, "*": 0.1}).equal


@pytest.mark.parametrize("tolerance", [-1.0, math.nan])
def test_a_tolerance_below_zero_is_a_bug(header: LogHeader, tolerance: float) -> None:
    with pytest.raises(ValueError, match="not 0 or more"):
        compare([], header, [], header, {"*": tolerance})


def test_a_shorter_recording_differs_where_it_ends(header: LogHeader, rows: list[np.ndarray]) -> None:
    result = against(header, records(rows), records(rows[:30]))
    assert not result.equal
    assert result.window == "after 30 equal ticks: tick 31 against the end"
    assert against(header, records(rows), records(rows, 2)).window == "after 0 equal ticks: tick 1 against tick 2"


def test_recordings_of_different_kinds_are_not_compared(header: LogHeader, rows: list[np.ndarray]) -> None:
    slower = msgspec.structs.replace(header, tick_hz=100)
    assert "different tick_hz" in compare([], header, [], slower).window
    other = msgspec.structs.replace(header, streams=(vector_stream((*header.columns, "more"), 2),))
    assert "different columns" in compare([], header, [], other).window


def test_many_differing_columns_are_counted_not_listed(header: LogHeader) -> None:
    wide = msgspec.structs.replace(header, streams=(vector_stream(tuple(f"c{index}" for index in range(10)), 2),))
    result = against(wide, records([np.zeros(10)]), records([np.ones(10)]))
    assert result.window.splitlines()[-1] == "and 4 more columns at tick 1"
