import numpy as np
import pytest

from simconsole.values.planned_path import FIELDS, MOST_BYTES, MOST_PLACES, PlannedPath, from_bytes, to_bytes


@pytest.mark.parametrize("count", [0, 1, 21, MOST_PLACES])
def test_a_plan_comes_back_as_it_was(count: int) -> None:
    plan = PlannedPath(3_599_123_456_789, np.sqrt(np.arange(float(count * FIELDS))).reshape(count, FIELDS))
    content = to_bytes(plan)
    assert len(content) <= MOST_BYTES
    found = from_bytes(content)
    assert found.t_ns == plan.t_ns
    np.testing.assert_array_equal(found.places, plan.places)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "0 bytes"),
        (bytes(7), "7 bytes"),
        (bytes(8 * 3), "24 bytes"),
        (bytes(MOST_BYTES + 8 * FIELDS), "at most 64 places"),
        (np.full(5, np.nan).tobytes(), "not finite"),
    ],
)
def test_what_is_no_plan_is_refused(content: bytes, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        from_bytes(content)
