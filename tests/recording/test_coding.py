import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from simconsole.recording.coding import (
    MAX_DELAY,
    MAX_ORDER,
    Bits,
    decode,
    delayed,
    differences,
    encode,
    entropy_bits,
    length_bits,
    unzigzag,
    zigzag,
)
from tests.bits import difference

PATTERNS = st.integers(-(1 << 63), (1 << 63) - 1)


@st.composite
def two_columns(draw: st.DrawFn) -> tuple[Bits, Bits]:
    size = draw(st.integers(1, 40))
    pair = [draw(st.lists(PATTERNS, min_size=size, max_size=size)) for _ in range(2)]
    return np.array(pair[0], np.int64), np.array(pair[1], np.int64)


@given(two_columns(), st.integers(0, MAX_ORDER), st.booleans(), st.integers(0, MAX_DELAY))
def test_every_bit_pattern_comes_back(columns: tuple[Bits, Bits], order: int, beside: bool, delay: int) -> None:
    bits, reference = columns[0], columns[1] if beside else None
    assert not difference(decode(encode(bits, order, reference, delay), order, reference, delay), bits)


@given(st.lists(PATTERNS, min_size=1))
def test_zigzag_is_undone_and_keeps_small_numbers_small(numbers: list[int]) -> None:
    given_bits = np.array(numbers, np.int64)
    assert unzigzag(zigzag(given_bits)).tolist() == numbers
    assert zigzag(np.array([0, -1, 1, -2, 2])).tolist() == [0, 1, 2, 3, 4]


def test_a_straight_line_has_no_second_differences() -> None:
    assert differences(np.array([7, 10, 13, 16]), 2).tolist() == [7, -4, 0, 0]


def test_a_delayed_copy_costs_its_first_value_only() -> None:
    source = np.array([5, 6, 9])
    assert delayed(source, 1).tolist() == [0, 5, 6]
    assert unzigzag(encode(np.array([4, 5, 6]), 0, source, 1)).tolist() == [4, 0, 0]


def test_costs_grow_with_the_numbers() -> None:
    still, moving = np.zeros(512, np.int64), np.random.default_rng(1).integers(-(1 << 20), 1 << 20, 512)
    assert (entropy_bits(still), float(length_bits(still))) == (0.0, 0.0)
    assert float(length_bits(moving)) == pytest.approx(20, abs=2)
    assert entropy_bits(moving) > 15.0
