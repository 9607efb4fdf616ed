import numpy as np

from tests.bits import difference


def test_the_same_bits_do_not_differ() -> None:
    rows = np.array([[1.0, np.nan], [-0.0, np.inf]])
    assert difference(rows, rows.copy()) == ""
    assert difference(rows[:, 0], np.ascontiguousarray(rows[:, 0])) == ""


def test_what_differs_first_is_told() -> None:
    rows = np.zeros((1000, 3))
    other = rows.copy()
    other[7, 1] = -0.0
    other[700:, 2] = np.nan
    assert difference(rows, other, ("x_m", "y_m", "z_m")).startswith(
        "301 of 3000 values differ; 7, y_m: np.float64(0.0) and np.float64(-0.0), 700, z_m: np.float64(0.0) and"
    )
    assert difference(rows[:, 1], other[:, 1]) == "1 of 1000 values differ; 7: np.float64(0.0) and np.float64(-0.0)"


def test_shapes_and_types_are_told() -> None:
    told = "float64 of shape (2,) and float32 of shape (2, 1)"
    assert difference(np.zeros(2), np.zeros((2, 1), np.float32)) == told
