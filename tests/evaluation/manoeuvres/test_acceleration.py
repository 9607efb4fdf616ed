"""Full throttle, on a drive whose answer is known."""

import numpy as np
import pytest

from simconsole.evaluation.manoeuvres.acceleration import acceleration
from simconsole.profiles.manoeuvre import Acceleration
from tests.evaluation.manoeuvres.driven import CAR, HZ, drive


@pytest.mark.parametrize(("top_mps", "known"), [(50.0, True), (25.0, False)])
def test_the_time_counts_from_the_first_motion_and_is_left_out_where_the_car_is_too_slow(
    top_mps: float, known: bool
) -> None:
    at_work = acceleration(Acceleration(), CAR)
    next(at_work)
    time_s = np.arange(60.0 * HZ) / HZ
    with pytest.raises(StopIteration) as end:
        at_work.send(drive(60.0, vehicle__vx_mps=np.clip(2.5 * (time_s - 1.0), 0.0, top_mps)))
    values = end.value.value.values
    assert values["top_speed_kmh"] == pytest.approx(3.6 * top_mps)
    assert values.get("time_s") == (pytest.approx(100.0 / 3.6 / 2.5, abs=0.05) if known else None)
