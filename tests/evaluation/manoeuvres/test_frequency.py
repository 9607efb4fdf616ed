"""Frequency response of a drive whose answer is known."""

import numpy as np
import pytest

from simconsole.evaluation.manoeuvres.frequency import frequency_response, response
from simconsole.evaluation.metrics.table import Drive
from simconsole.profiles.manoeuvre import FrequencyResponse
from tests.evaluation.manoeuvres.driven import CAR, HZ, drive


def answered(frequency_hz: float, gain: float, lag_deg: float) -> Drive:
    phase = 2.0 * np.pi * frequency_hz * np.arange(30.0 * HZ) / HZ
    return drive(
        30.0,
        driver__hand_wheel_rad=0.2 * np.sin(phase),
        vehicle__yaw_rate_radps=0.2 * gain * np.sin(phase - np.radians(lag_deg)),
    )


def test_gain_and_lag_of_one_sine() -> None:
    found = response(answered(0.5, 0.3, 40.0), 0.5)
    assert found.gain_per_s == pytest.approx(0.3)
    assert found.lag_deg == pytest.approx(40.0)


def test_the_peak_is_the_largest_gain_over_the_first() -> None:
    at_work = frequency_response(FrequencyResponse(frequencies_hz=(0.2, 0.8, 1.6)), CAR)
    attempt = next(at_work)
    for frequency_hz, gain, lag_deg in ((0.2, 0.3, 10.0), (0.8, 0.45, 30.0), (1.6, 0.2, 70.0)):
        assert attempt.name == f"{frequency_hz:g} Hz"
        attempt.pilot.began_tick = 0  # type: ignore[union-attr]
        try:
            attempt = at_work.send(answered(frequency_hz, gain, lag_deg))
        except StopIteration as end:
            values = end.value.values
    assert values["steady_yaw_rate_gain_per_s"] == pytest.approx(0.3, rel=1e-3)
    assert values["yaw_rate_peak_ratio"] == pytest.approx(1.5, rel=1e-3)
    assert values["yaw_rate_peak_frequency_hz"] == 0.8
    assert values["yaw_rate_lag_at_1_hz_deg"] == pytest.approx(40.0, rel=1e-2)
