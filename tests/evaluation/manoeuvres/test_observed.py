"""A watched drive, whose answer is known."""

import numpy as np
import pytest

from simconsole.evaluation.manoeuvres.attempt import Attempt
from simconsole.evaluation.manoeuvres.observed import JERK_WINDOW_S, jerks, observed
from simconsole.profiles.manoeuvre import Observed
from tests.evaluation.manoeuvres.driven import CAR, HZ, drive


def test_a_watched_drive_is_described() -> None:
    at_work = observed(Observed(from_s=1.0, until_s=3.0), CAR, 4.0)
    assert next(at_work) == Attempt("script", None, 4.0)
    time_s = (1 + np.arange(HZ * 4)) / HZ
    running = np.where(time_s > 2.0, 0.0, 1.0)
    seen = drive(
        4.0,
        vehicle__vx_mps=np.sin(time_s),
        vehicle__x_m=-time_s,
        vehicle__y_m=np.array(0.0),
        vehicle__yaw_rad=np.array(0.0),
        vehicle__ax_mps2=time_s,
        vehicle__engine_radps=100.0 * time_s,
        vehicle__engine_running=running,
        vehicle__distance_m=time_s,
        vehicle__gear=np.where((time_s > 1.5) & (time_s <= 1.75) | (time_s > 2.5), 0.0, 1.0),
        command__gear=np.where(time_s > 2.5, 0.0, 1.0),
        vehicle__gear_fault=np.where(time_s > 3.5, 8.0, 1.0),
    )
    with pytest.raises(StopIteration) as end:
        at_work.send(seen)
    values = end.value.value.values
    assert values["engine_stalled"] == 1.0
    assert values["end_engine_running"] == 0.0
    assert values["rolled_back_m"] == pytest.approx(2.0, abs=0.01)
    assert values["lowest_engine_speed_rpm"] == pytest.approx(955.0, abs=5.0)
    assert values["highest_jerk_mps3"] == pytest.approx(1.0), "the acceleration rises by 1 m/s2 in a second"
    assert values["longest_neutral_s"] == pytest.approx(0.25, abs=0.01), "the neutral that is asked for does not count"
    assert values["clutch_overheated"] == 0.0, "a grating gear, and the heat comes after the part that counts"


def test_a_jerk_is_the_change_of_an_averaged_acceleration() -> None:
    step = np.where(np.arange(HZ) < HZ // 2, 0.0, 0.5)
    assert jerks(step, HZ).max() == pytest.approx(0.5 / JERK_WINDOW_S, rel=0.05)
    assert jerks(step[:5], HZ).tolist() == [0.0], "shorter than the average"
