"""Products and solutions of small matrices."""

import numpy as np
import pytest

from simconsole.drivers.path_tracker.matrices import product, solved


def test_products_are_those_of_algebra() -> None:
    dice = np.random.default_rng(3)
    one, two, three = dice.normal(size=(4, 5)), dice.normal(size=(5, 2)), dice.normal(size=(2, 7))
    assert product(one, two, three) == pytest.approx(one @ two @ three, abs=1e-12)


def test_a_solution_solves_its_equation_though_it_begins_with_zero() -> None:
    matrix, right = np.array(((0.0, 2.0, 1.0), (3.0, 0.0, -1.0), (1.0, 1.0, 1.0))), np.arange(6.0).reshape(3, 2)
    before = matrix.copy()
    assert matrix @ solved(matrix, right) == pytest.approx(right, abs=1e-12)
    assert np.array_equal(matrix, before)


def test_a_singular_matrix_has_no_finite_solution() -> None:
    assert not np.isfinite(solved(np.ones((2, 2)), np.eye(2))).all()
