"""Parts of a drive and what is plotted of them."""

import numpy as np
import pytest

from simconsole.evaluation.manoeuvres.attempt import part, traces, undriven
from tests.evaluation.manoeuvres.driven import HZ, drive


def test_a_part_keeps_the_simulated_time_of_its_ticks() -> None:
    whole = drive(2.0, speed=np.arange(2.0 * HZ))
    inner = part(part(whole, 100), 50, 60)
    assert inner.column("speed").tolist() == list(range(150, 160))
    assert inner.time_s == pytest.approx(whole.time_s[150:160])
    assert inner.first_tick == 151


def test_a_plot_begins_at_zero_and_is_thinned_alike_in_both_axes() -> None:
    late = part(drive(2.0, speed=np.arange(2.0 * HZ)), HZ)
    (line,) = traces("Speed", "speed / m/s", {"seen": (late, late.column("speed"))}, every=10).lines
    assert line.label == "seen"
    assert line.x[0] == 0.0
    assert np.diff(line.x) == pytest.approx(10.0 / HZ)
    assert line.y.tolist() == list(range(HZ, 2 * HZ, 10))


def test_a_car_that_is_too_slow_is_told_with_attempt_and_speed() -> None:
    result = undriven("with ABS", 100.0)
    assert (result.values, result.panels) == ({}, ())
    assert result.problem == "with ABS: the car has not held 100 km/h, where the manoeuvre begins"
