import numpy as np
import pytest

from simconsole.evaluation.checks.golden import Comparison, Difference, Golden, Sample, head, line, readable, step_ticks
from simconsole.profiles.scenario import Tolerance
from simconsole.values.errors import ProfileError

COLUMNS = ("sample.wheel_axis", "vehicle.vx_mps")
ROWS = np.arange(20.0).reshape(10, 2) / 3.0
TICKS = (2, 4, 6, 8, 10)


def text(rows: np.ndarray = ROWS, ticks: tuple[int, ...] = TICKS) -> str:
    return head("00ff", 10, COLUMNS) + "".join(line(tick, rows[tick - 1]) for tick in ticks)


def read(written: str) -> Golden:
    return Golden(written.splitlines(keepends=True), "x.csv")


def difference(
    accepted: str, rows: np.ndarray, ticks: tuple[int, ...] = TICKS, columns: tuple[str, ...] = COLUMNS
) -> Difference | None:
    comparison = Comparison(read(accepted), columns)
    for tick in ticks:
        comparison.see(tick, rows[tick - 1])
    return comparison.first_difference()


def test_text_keeps_every_bit() -> None:
    golden = read(text())
    assert (golden.hash, golden.tick_hz, golden.columns) == ("00ff", 10, COLUMNS)
    samples: list[Sample] = list(golden)
    assert samples == [(tick, tuple(ROWS[tick - 1].tolist())) for tick in TICKS]


def test_samples_are_the_ticks_of_the_rate() -> None:
    assert [step_ticks(10, 5), step_ticks(250, 10), step_ticks(50, 100)] == [2, 25, 1]


def test_one_changed_bit_is_named() -> None:
    changed = ROWS.copy()
    changed[7, 1] = np.nextafter(changed[7, 1], 9.0)
    changed[9, 0] += 1.0
    assert difference(text(), changed) == (8, "vehicle.vx_mps", ROWS[7, 1], changed[7, 1])
    assert difference(text(), ROWS) is None


def test_only_columns_of_both_are_compared() -> None:
    changed = ROWS[:, ::-1].copy()
    assert difference(text(), changed, columns=("vehicle.vx_mps", "sample.wheel_axis")) is None
    assert difference(text(), changed, columns=("vehicle.vx_mps", "new")) is None
    assert difference(text(), changed, columns=("new", "vehicle.vx_mps")) is not None


def test_nan_equals_nan_but_nothing_else() -> None:
    nan = ROWS.copy()
    nan[1, 0] = np.nan
    assert difference(text(nan), nan) is None
    assert difference(text(nan), ROWS) is not None


def test_a_shorter_drive_differs() -> None:
    assert difference(text(), ROWS, TICKS[:-1]) == (10, "tick", 10.0, 4.0)
    assert difference(text(), ROWS, (4, 6, 8, 10)) == (2, "tick", 2.0, 4.0)
    assert difference(text(ticks=TICKS[:-1]), ROWS) is None, "as far as it was accepted; the hash tells"


def test_what_was_driven_and_never_accepted_is_told() -> None:
    longer = Comparison(read(text(ticks=TICKS[:-1])), COLUMNS)
    for tick in TICKS:
        longer.see(tick, ROWS[tick - 1])
    assert (longer.first_difference(), longer.compared, longer.unaccepted) == (None, 4, 10)
    assert compared(ROWS).unaccepted is None


@pytest.mark.parametrize("written", ["", "tick,a\n1,2\n", "# simconsole golden schema 9 tick_hz 10 hash 0\ntick,a\n"])
def test_other_files_are_refused_by_name(written: str) -> None:
    with pytest.raises(ProfileError, match=r"x\.csv: line 1"):
        read(written)


@pytest.mark.parametrize(("row", "why"), [("1,x", "not a number"), ("1", "1 values, not 2"), ("", "not a number")])
def test_a_bad_value_is_refused_with_its_line(row: str, why: str) -> None:
    with pytest.raises(ProfileError, match=rf"x\.csv: line 3: .*{why}"):
        list(read(f"# simconsole golden schema 1 tick_hz 10 hash 0\ntick,a\n{row}\n"))


def compared(rows: np.ndarray, *tolerances: Tolerance) -> Comparison:
    comparison = Comparison(read(text()), COLUMNS, tolerances)
    for tick in TICKS:
        comparison.see(tick, rows[tick - 1])
    return comparison


def test_a_tolerance_is_for_its_columns_alone_and_the_last_counts() -> None:
    changed = ROWS.copy()
    changed[7] += 0.01
    near = Tolerance(columns="vehicle.*", absolute=0.02)
    assert [one.first.column for one in compared(changed, near).differences()] == ["sample.wheel_axis"]
    assert compared(changed, near, Tolerance(columns="sample.wheel_axis", relative=0.01)).first_difference() is None
    assert compared(changed, near, Tolerance(columns="*", ignore=True)).first_difference() is None
    assert compared(changed, near, Tolerance(columns="vehicle.*", absolute=0.001)).first_difference() is not None


def test_nan_is_beyond_every_tolerance_but_what_is_ignored() -> None:
    changed = ROWS.copy()
    changed[3, 0] = np.nan
    assert compared(changed, Tolerance(columns="*", absolute=1e9)).first_difference() is not None
    assert compared(changed, Tolerance(columns="sample.*", ignore=True)).first_difference() is None


def test_differences_are_told_in_the_order_in_which_they_begin() -> None:
    changed = ROWS.copy()
    changed[3:, 1] += np.array([0.5, 2.0, 0.1, 3.0, 0.1, 0.1, 1.0])
    changed[7:, 0] -= 1.0
    found = compared(changed).differences()
    assert [(one.first.column, one.first.tick, one.largest_tick) for one in found] == [
        ("vehicle.vx_mps", 4, 10),
        ("sample.wheel_axis", 8, 8),
    ]
    lines = readable(found, 10)
    assert len(lines) == 3
    assert lines[1].split() == ["vehicle.vx_mps", "0.400", "s", "2.33333", "2.83333", "1", "1.000", "s"]
    assert readable(found * 6, 10)[-1] == "and 2 more columns"
    assert readable([], 10) == []
