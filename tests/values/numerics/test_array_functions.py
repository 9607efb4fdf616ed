"""Functions of whole arrays: those of numbers, in the array's shape."""

import math

import numpy as np
import pytest

from simconsole.values.numerics.array_functions import cosine, cube_root, exponential, heading, sine


@pytest.mark.parametrize(
    ("function", "number"), [(cosine, math.cos), (sine, math.sin), (exponential, math.exp), (cube_root, math.cbrt)]
)
def test_each_number_is_that_of_the_function_of_one(function: object, number: object) -> None:
    given = np.linspace(-4.0, 9.0, 24).reshape(2, 3, 4)[:, ::2]
    found = function(given)  # type: ignore[operator]
    assert found.shape == given.shape
    assert found.tolist() == [[[number(x) for x in row] for row in part] for part in given.tolist()]  # type: ignore[operator]


def test_headings_are_those_of_the_vectors() -> None:
    assert heading(np.array((0.0, 1.0, -1.0, 0.0)), np.array((1.0, 0.0, -1.0, -2.0))) == pytest.approx(
        np.array((0.0, 0.5 * math.pi, -0.75 * math.pi, math.pi))
    )


def test_nothing_has_no_functions() -> None:
    assert cosine(np.zeros((0, 3))).shape == (0, 3)
