import math

import numpy as np
import pytest

from simconsole.drivers.path_tracker.riccati import design, discretised, exponential, riccati


def test_exponential_of_a_rotation() -> None:
    turn = exponential(np.array(((0.0, -7.0), (7.0, 0.0))))
    exact = np.array(((math.cos(7.0), -math.sin(7.0)), (math.sin(7.0), math.cos(7.0))))
    assert turn == pytest.approx(exact, abs=1e-12)
    assert exponential(np.zeros((2, 2))) == pytest.approx(np.eye(2))


def test_double_integrator_is_discretised_exactly() -> None:
    a, b = discretised(np.array(((0.0, 1.0), (0.0, 0.0))), np.array(((0.0,), (1.0,))), 0.5)
    assert a == pytest.approx(np.array(((1.0, 0.5), (0.0, 1.0))))
    assert b == pytest.approx(np.array(((0.125,), (0.5,))))


def test_scalar_riccati_has_the_closed_form() -> None:
    # p = a^2 p r / (r + p) + q with a = 1, q = r = 1: the golden ratio.
    p = riccati(np.eye(1), np.eye(1), np.eye(1), 1.0)
    assert p[0, 0] == pytest.approx((1.0 + math.sqrt(5.0)) / 2.0, abs=1e-12)


def test_riccati_solution_solves_its_equation() -> None:
    a, b = discretised(np.array(((0.0, 1.0), (2.0, -0.3))), np.array(((0.0,), (1.0,))), 0.1)
    q = np.diag((1.0, 0.1))
    p = riccati(a, b, q, 0.5)
    gain = b.T @ p @ a / (0.5 + b.T @ p @ b)
    assert a.T @ p @ a - a.T @ p @ b @ gain + q == pytest.approx(p, abs=1e-9)
    assert np.abs(np.linalg.eigvals(a - b @ gain)).max() < 1.0


def test_unstabilisable_pair_is_refused() -> None:
    with pytest.raises(ValueError, match="no stabilising solution"):
        riccati(np.diag((2.0, 0.5)), np.array(((0.0,), (1.0,))), np.eye(2), 1.0)


def test_preview_beats_feedback_alone_and_nothing_beats_preview() -> None:
    a, b = discretised(np.array(((0.0, 1.0), (0.0, 0.0))), np.array(((0.0,), (1.0,))), 0.1)
    d, q, r, n = np.array(((0.0,), (0.1,))), np.diag((1.0, 0.0)), 0.01, 80
    gains = design(a, b, d, q, r, n)
    pulse = np.zeros(3 * n)
    pulse[n : n + 10] = 1.0

    def cost(preview: np.ndarray, change: np.ndarray) -> float:
        x, total = np.zeros((2, 1)), 0.0
        for k in range(2 * n):
            u = -float((gains.feedback @ x)[0]) - float(preview @ pulse[k : k + n]) + change[k]
            total += float((x.T @ q @ x)[0, 0]) + r * u * u
            x = a @ x + b * u + d * pulse[k]
        return total

    still = np.zeros(2 * n)
    best = cost(gains.preview, still)
    assert best < 0.5 * cost(np.zeros(n), still)
    dice = np.random.default_rng(7)
    print("seed 7")
    for _ in range(20):
        assert cost(gains.preview, 0.05 * dice.standard_normal(2 * n)) > best
