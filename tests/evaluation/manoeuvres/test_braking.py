"""Straight braking and coast-down, on drives whose answer is known."""

import numpy as np
import pytest

from simconsole.evaluation.manoeuvres.braking import straight_braking
from simconsole.profiles.manoeuvre import StraightBraking
from tests.evaluation.manoeuvres.driven import CAR, HZ, drive


def test_braking_at_eight_metres_per_second_squared() -> None:
    at_work = straight_braking(StraightBraking(speed_kmh=90.0, without=False), CAR)
    attempt = next(at_work)
    assert attempt.pilot is not None
    attempt.pilot.began_tick = 1  # type: ignore[attr-defined]  # as if the run-up were over
    time_s = np.arange(HZ * 3) / HZ
    speed = 24.0 - 8.0 * time_s
    spin = {f"platform__{wheel}_radps": 0.9 * speed / 0.306 for wheel in ("fl", "fr", "rl")}
    spin = {name: np.where(time_s > 0.5, values, values / 0.9) for name, values in spin.items()}
    braked = drive(
        3.0,
        vehicle__vx_mps=speed,
        vehicle__distance_m=24.0 * time_s - 4.0 * time_s**2,
        vehicle__x_m=time_s,
        vehicle__y_m=0.1 * time_s,
        vehicle__yaw_rad=-0.01 * time_s,
        vehicle__pitch_rad=np.radians(1.2),
        vehicle__ax_mps2=np.array(-8.0),
        platform__rr_radps=speed / 0.306,
        **spin,
    )
    with pytest.raises(StopIteration) as end:
        at_work.send(braked)
    values = end.value.value.values
    assert values["stopping_distance_m"] == pytest.approx(24.0**2 / 16.0 * (25.0 / 24.0) ** 2, rel=1e-3)
    assert values["mean_fully_developed_deceleration_mps2"] == pytest.approx(8.0, rel=1e-3)
    assert values["lowest_wheel_speed_share"] == pytest.approx(0.9, rel=1e-3)
    assert values["largest_yaw_angle_deg"] == pytest.approx(1.72, abs=0.01)
    assert values["pitch_angle_gradient_deg_per_g"] == pytest.approx(1.2 * 9.80665 / 8.0)
