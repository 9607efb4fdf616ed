import numpy as np
import pytest

from simconsole.errors import ProfileError
from simconsole.golden import Golden, first_difference, read, sample, write

COLUMNS = ("sample.wheel_axis", "vehicle.vx_mps")


def driven() -> Golden:
    rows = np.arange(20.0).reshape(10, 2) / 3.0
    return sample(rows, 10, 5, COLUMNS, "00ff")


def test_text_keeps_every_bit() -> None:
    assert read(write(driven()), "x.csv") == driven()


def test_samples_are_the_ticks_of_the_rate() -> None:
    assert [tick for tick, _ in driven().samples] == [2, 4, 6, 8, 10]
    assert driven().samples[0][1] == (2.0 / 3.0, 3.0 / 3.0)


def test_one_changed_bit_is_named() -> None:
    golden = driven()
    tick, row = golden.samples[3]
    changed = golden._replace(
        samples=(*golden.samples[:3], (tick, (row[0], np.nextafter(row[1], 9.0))), golden.samples[4])
    )
    difference = first_difference(golden, changed)
    assert difference is not None
    assert (difference.tick, difference.column) == (8, "vehicle.vx_mps")
    assert first_difference(golden, driven()) is None


def test_nan_equals_nan_but_nothing_else() -> None:
    golden = driven()._replace(samples=((2, (float("nan"), 1.0)),))
    assert first_difference(golden, golden) is None
    assert first_difference(golden, golden._replace(samples=((2, (0.0, 1.0)),))) is not None


def test_a_shorter_drive_differs() -> None:
    golden = driven()
    difference = first_difference(golden, golden._replace(samples=golden.samples[:-1]))
    assert difference is not None
    assert difference.tick == 10


@pytest.mark.parametrize("text", ["", "tick,a\n1,2\n", "# simconsole golden schema 9 tick_hz 10 hash 0\ntick,a\n"])
def test_other_files_are_refused_by_name(text: str) -> None:
    with pytest.raises(ProfileError, match=r"x\.csv: line 1"):
        read(text, "x.csv")


def test_a_bad_value_is_refused_with_its_line() -> None:
    with pytest.raises(ProfileError, match=r"x\.csv: line 3"):
        read("# simconsole golden schema 1 tick_hz 10 hash 0\ntick,a\n1,x\n", "x.csv")
