"""Functions of angles and lengths for whole arrays, with the same bits on every processor.

numpy computes its own by what the processor has: with AVX-512 the last bits are others than without. What a drive's
state comes from is computed here, number by number; for what is only drawn or told, numpy's are good enough.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def _each(function: Callable[..., float], *arrays: Array) -> Array:
    numbers = map(function, *(array.ravel().tolist() for array in arrays))
    return np.fromiter(numbers, np.float64, arrays[0].size).reshape(arrays[0].shape)


def cosine(angle_rad: Array) -> Array:
    """Return the cosine of each angle, in the array's shape."""
    return _each(math.cos, angle_rad)


def sine(angle_rad: Array) -> Array:
    """Return the sine of each angle, in the array's shape."""
    return _each(math.sin, angle_rad)


def heading(y: Array, x: Array) -> Array:
    """Return the angle of each vector in rad, between -pi and pi; both arrays have one shape."""
    return _each(math.atan2, y, x)


def exponential(exponent: Array) -> Array:
    """Return e to the power of each number.

    Raises:
        OverflowError: a number is above 709.
    """
    return _each(math.exp, exponent)


def cube_root(number: Array) -> Array:
    """Return the real cube root of each number."""
    return _each(math.cbrt, number)
