import math

import numpy as np
import pytest

from simconsole.evaluation.metrics.trajectory_errors import fitted, trajectory_errors
from tests.samples import Sample


def test_a_shifted_trajectory_errs_absolutely_and_not_from_step_to_step() -> None:
    turn = np.linspace(0.0, 3.0, 100)
    true = np.column_stack((np.cos(turn), np.sin(turn), turn))
    errors = trajectory_errors(true + np.array((0.03, 0.04, math.tau)), true, 5)
    assert errors.absolute_rms_m == pytest.approx(0.05)
    assert errors.absolute_max_m == pytest.approx(0.05)
    assert errors.heading_rms_rad == pytest.approx(0.0, abs=1e-12)
    assert errors.relative_rms_m == pytest.approx(0.0, abs=1e-12)


def test_a_scale_shows_in_each_step() -> None:
    x = np.linspace(0.0, 10.0, 101)
    true = np.column_stack((x, np.zeros((101, 2))))
    errors = trajectory_errors(true * 1.02, true, 10)
    assert errors.relative_rms_m == pytest.approx(0.02)
    assert errors.absolute_max_m == pytest.approx(0.2)
    turned = true + np.column_stack((np.zeros((101, 2)), 0.01 * x))
    assert trajectory_errors(turned, true, 10).relative_rms_rad == pytest.approx(0.01)


def test_fitting_undoes_any_motion_of_the_whole(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    true = rng.uniform(-3.0, 3.0, (50, 3))
    turn = rng.uniform(-3.0, 3.0)
    rotation = np.array(((math.cos(turn), math.sin(turn)), (-math.sin(turn), math.cos(turn))))
    moved = np.column_stack((true[:, :2] @ rotation + rng.uniform(-5.0, 5.0, 2), true[:, 2] + turn))
    errors = trajectory_errors(fitted(moved, true), true, 1)
    assert errors.absolute_max_m < 1e-9
    assert errors.heading_rms_rad < 1e-9


def test_what_cannot_be_compared_is_refused() -> None:
    with pytest.raises(ValueError, match="as many of both"):
        trajectory_errors(np.zeros((5, 3)), np.zeros((6, 3)), 1)
    with pytest.raises(ValueError, match="more than a step"):
        trajectory_errors(np.zeros((5, 3)), np.zeros((5, 3)), 5)
