import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from simconsole.recording.packing import Coded, Constant, Copy, Plain, Rule, needed, pack, problem, stored, unpack
from tests.bits import difference

RULES: dict[str, Rule] = {
    "a": Plain(),
    "b": Copy("a"),
    "c": Constant(-1),
    "d": Coded(2, "e", 1),
    "e": Coded(3),
    "f": Copy("d"),
}


@given(arrays(np.int64, (20, 6), elements=st.integers(-(1 << 63), (1 << 63) - 1)))
def test_a_block_comes_back_to_the_bit(bits: np.ndarray) -> None:
    """NaNs of every payload, both zeros, subnormals, infinities: a float64 is its pattern."""
    bits[:, 1], bits[:, 2], bits[:, 5] = bits[:, 0], -1, bits[:, 3]
    vectors = bits.view(np.float64)
    kept = pack(RULES, vectors)
    assert tuple(kept) == stored(RULES) == ("a", "d", "e")
    assert not difference(unpack(RULES, kept, tuple(RULES), 20), vectors)


def test_a_column_needs_what_it_refers_to_and_no_more() -> None:
    vectors = np.arange(24.0).reshape(4, 6)
    vectors[:, 1], vectors[:, 5] = vectors[:, 0], vectors[:, 3]
    kept = pack(RULES, vectors)
    assert needed(RULES, ("f",)) == ("d", "e")
    assert needed(RULES, ("b", "c")) == ("a",)
    part = {name: kept[name] for name in needed(RULES, ("f", "b"))}
    assert unpack(RULES, part, ("f", "b"), 4).tolist() == vectors[:, [5, 0]].tolist()


@pytest.mark.parametrize(
    ("rule", "found"),
    [
        (Copy("nowhere"), "'nowhere', which is not stored"),
        (Copy("c"), "'c', which is not stored"),
        (Coded(99), "order 99"),
        (Coded(-1), "order -1"),
        (Coded(1, "b", 2), "delay 2"),
        (Coded(1, "a"), "refers to itself"),
        (Coded(1, "b"), "refers to itself"),
    ],
)
def test_rules_that_cannot_be_followed_are_named(rule: Rule, found: str) -> None:
    rules = {"a": rule, "b": Coded(0, "a"), "c": Constant(0)}
    assert found in str(problem(rules))


def test_good_rules_have_no_problem() -> None:
    assert problem(RULES) is None
