import math
import tracemalloc

import numpy as np
import pytest

from simconsole.recording.differences import Differences, FieldDifference, allowed_differences
from simconsole.values.errors import RecordingError

COLUMNS = ("vehicle.vx_mps", "driver.brake", "memory.mode_ticks")


def found(first: np.ndarray, second: np.ndarray, **tolerances: float) -> tuple[FieldDifference, ...]:
    named = {key.replace("__", "."): value for key, value in tolerances.items()}
    differences = Differences(COLUMNS, allowed_differences(COLUMNS, named))
    for tick, (one, two) in enumerate(zip(first, second, strict=True), start=1):
        differences.add(tick, one, two)
    return differences.found()


@pytest.fixture
def table() -> np.ndarray:
    return np.random.default_rng(3).uniform(-1.0, 1.0, (30, 3))


def test_equal_drives_have_none(table: np.ndarray) -> None:
    assert found(table, table.copy()) == ()


def test_each_field_with_its_first_tick_how_far_and_how_often(table: np.ndarray) -> None:
    other = table.copy()
    other[19:22, 0] += [0.5, -2.0, 1.0]
    other[9, 2] += 7.0
    later, earlier = found(table, other)[::-1]
    assert (earlier.field, earlier.unit, earlier.first_tick, earlier.ticks) == ("memory.mode_ticks", "ticks", 10, 1)
    assert (later.field, later.unit, later.first_tick, later.ticks) == ("vehicle.vx_mps", "m/s", 20, 3)
    assert (later.largest, later.largest_tick) == (abs(table[20, 0] - other[20, 0]), 21)
    assert later.values == (table[19, 0], other[19, 0])
    assert later.around == tuple((tick, table[tick - 1, 0], other[tick - 1, 0]) for tick in range(17, 24))


@pytest.mark.parametrize(("tick", "ticks"), [(1, [1, 2, 3, 4]), (2, [1, 2, 3, 4, 5]), (29, [26, 27, 28, 29, 30])])
def test_around_ends_where_the_drive_does(table: np.ndarray, tick: int, ticks: list[int]) -> None:
    other = table.copy()
    other[tick - 1, 1] += 1.0
    (difference,) = found(table, other)
    assert [at for at, _, _ in difference.around] == ticks


def test_one_bit_is_a_difference_without_a_tolerance(table: np.ndarray) -> None:
    other = table.copy()
    other[4, 1] = math.nextafter(other[4, 1], math.inf)
    assert len(found(table, other)) == 1
    assert found(table, other, driver__brake=1e-9) == ()


@pytest.mark.parametrize(
    ("first", "second", "largest"),
    [(0.0, -0.0, 0.0), (math.nan, 1.0, math.inf), (math.inf, -math.inf, math.inf), (1.0, math.inf, math.inf)],
)
def test_values_that_are_no_numbers_differ(table: np.ndarray, first: float, second: float, largest: float) -> None:
    one, two = table.copy(), table.copy()
    one[7, 0], two[7, 0] = first, second
    (difference,) = found(one, two)
    assert (difference.first_tick, difference.largest) == (8, largest)
    one[7, 0] = two[7, 0]
    assert found(one, two) == ()


@pytest.mark.parametrize(("change", "differs"), [(0.0625, 0), (0.125, 1), (math.nan, 1), (math.inf, 1)])
def test_a_tolerance_is_absolute_and_of_its_field(table: np.ndarray, change: float, differs: int) -> None:
    one, two = table.copy(), table.copy()
    one[8, 0], two[8, 0] = 1.0, 1.0 + change
    assert len(found(one, two, vehicle__vx_mps=0.0625)) == differs
    assert len(found(one, two, driver__brake=100.0)) == 1


def test_an_infinite_tolerance_ignores_a_field(table: np.ndarray) -> None:
    other = table + 1e6
    other[3, 0] = math.nan
    assert found(table, other, **{"*": math.inf}) == ()
    assert [one.field for one in found(table, other, **{"[!v]*": math.inf})] == ["vehicle.vx_mps"]


def test_the_last_matching_pattern_counts() -> None:
    assert allowed_differences(COLUMNS, {"*": 0.1, "vehicle.*": 2.0}).tolist() == [2.0, 0.1, 0.1]
    assert allowed_differences(COLUMNS, {"vehicle.*": 2.0, "*": 0.1}).tolist() == [0.1, 0.1, 0.1]


@pytest.mark.parametrize(
    ("pattern", "tolerance", "words"),
    [("*", -1.0, "0 or more"), ("*", math.nan, "0 or more"), ("vehicle.vx_kmh", 1.0, "no field")],
)
def test_a_tolerance_that_means_nothing_is_refused(pattern: str, tolerance: float, words: str) -> None:
    with pytest.raises(RecordingError, match=words) as caught:
        allowed_differences(COLUMNS, {pattern: tolerance})
    assert pattern in str(caught.value)


def test_memory_does_not_grow_with_the_drives(table: np.ndarray) -> None:
    """Fields that differ in every tick cost what fields that differ once do."""
    peaks = []
    for ticks in (100, 10_000):
        differences = Differences(COLUMNS, np.zeros(3))
        tracemalloc.start()
        for tick in range(ticks):
            differences.add(tick, table[tick % 30].copy(), table[(tick + 1) % 30].copy())
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 1.5 * peaks[0] + 4096
