import numpy as np
import pytest

from simconsole.world import traffic_columns as at
from simconsole.world.people.yielding import FAR_M, Crossed, occupied_ahead

# Lane 0 of 50 m, lane 1 of 10 m with a strip 2 m after its beginning, lane 2.
LENGTHS = np.array((50.0, 10.0, 100.0))


def path() -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
    found = np.zeros(at.PATH, np.int64)
    found[at.COUNT] = 3
    found[at.LANES : at.LANES + 3] = 0, 1, 2
    return found


@pytest.mark.parametrize(
    ("front_m", "occupied", "left_m"),
    [(20.0, 1, 32.0), (20.0, 0, FAR_M), (52.2, 1, -0.2), (53.0, 1, FAR_M), (1.0, 1, FAR_M)],
)
def test_way_to_the_next_strip_that_is_not_free(front_m: float, occupied: int, left_m: float) -> None:
    crossed = Crossed(
        over=np.array([0], np.int64),
        over_starts=np.array([0, 0, 1, 1], np.int64),
        near_m=np.array([2.0]),
        occupied=np.array([occupied], np.int64),
    )
    assert occupied_ahead(LENGTHS, path(), front_m, crossed, 40.0) == pytest.approx(left_m)
