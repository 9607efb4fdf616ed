"""No clock judges a test, that of Hypothesis neither."""

from hypothesis import given
from hypothesis import strategies as st

from tests.patience import pause


def test_an_example_of_hypothesis_may_take_its_time() -> None:
    tries: list[int] = []

    @given(st.integers(0, 2))
    def slow_at_first(number: int) -> None:
        tries.append(number)
        pause(0.3 if len(tries) == 1 else 0.0)

    slow_at_first()
    assert set(tries) == {0, 1, 2}
