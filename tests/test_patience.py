"""No clock judges a test, that of Hypothesis neither."""

from hypothesis import given
from hypothesis import strategies as st

from tests.patience import pause

TRIES: list[int] = []


@given(st.integers(0, 2))
def test_an_example_of_hypothesis_may_take_its_time(number: int) -> None:
    TRIES.append(number)
    pause(0.3 if len(TRIES) == 1 else 0.0)
