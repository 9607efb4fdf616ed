import numpy as np
import pytest

from simconsole.evaluation.metrics.thinning import path_thinned, thinned


def test_extremes_and_ends_are_kept() -> None:
    values = np.sin(np.arange(100_000) / 997.0)
    values[54_321], values[12_345] = 9.0, -9.0
    kept = thinned(values, 1000)
    assert len(kept) <= 1002
    assert {0, 99_999, 54_321, 12_345} <= set(kept.tolist())
    assert (np.diff(kept) > 0).all()


def test_short_series_stay_whole() -> None:
    assert thinned(np.zeros(7), 10).tolist() == list(range(7))
    assert thinned(np.arange(11.0), 10)[-1] == 10


def test_path_is_thinned_by_length() -> None:
    x = np.concatenate((np.zeros(500), np.linspace(0.0, 100.0, 2001)))  # it stood still first
    kept = path_thinned(x, np.zeros(len(x)), 1.0)
    assert 100 <= len(kept) <= 103
    assert kept[0] == 0
    assert kept[-1] == len(x) - 1
    assert np.diff(x[kept]).max() <= 1.1
    assert path_thinned(np.zeros(4), np.zeros(4), 1.0).tolist() == [0, 3]


@pytest.mark.parametrize("count", [11, 29, 30, 31, 99, 100, 101])
def test_no_extreme_of_a_bin_is_lost_whatever_the_length(count: int) -> None:
    values = np.sin(np.arange(count) * 1.7) * np.arange(count)
    kept = thinned(values, 10)
    size = -(-count // 5)
    wanted = {0, count - 1}
    for start in range(0, count, size):
        part = values[start : start + size]
        wanted |= {start + int(part.argmin()), start + int(part.argmax())}
    assert kept.tolist() == sorted(wanted)
