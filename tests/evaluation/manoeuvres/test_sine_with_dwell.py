"""Sine with dwell, on drives whose answer is known."""

import math

import numpy as np
import pytest

from simconsole.evaluation.manoeuvres.sine_with_dwell import completion_s, wave
from simconsole.profiles.manoeuvre import SineWithDwell


def test_the_sine_holds_its_second_peak() -> None:
    spec = SineWithDwell()
    assert completion_s(spec) == pytest.approx(1.0 / 0.7 + 0.5)
    assert wave(spec, 0.25 / 0.7) == pytest.approx(1.0)
    assert wave(spec, 0.75 / 0.7) == wave(spec, 0.75 / 0.7 + 0.49) == -1.0
    assert wave(spec, completion_s(spec) - 1e-9) == pytest.approx(0.0, abs=1e-6)
    assert wave(spec, completion_s(spec) + 0.5) == 0.0
    steps = np.diff([wave(spec, time_s) for time_s in np.arange(0.0, 3.0, 0.001)])
    assert np.abs(steps).max() < 1.01 * math.tau * 0.7 * 0.001, "no jump"
