"""Products and solutions of small matrices, in an order that is the same on every processor.

What numpy hands to BLAS is added up in the order that suits the processor: of two machines the last bits differ. A
design that does so makes every drive of the autopilot another one. Here each number is rounded at one place only.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def product(one: Array, *others: Array) -> Array:
    """Return the matrix product of two or more, from the left: [n, k] times [k, m] is [n, m]."""
    for other in others:
        total = one[:, :1] * other[:1]
        for at in range(1, len(other)):
            total = total + one[:, at : at + 1] * other[at : at + 1]
        one = total
    return one


def solved(matrix: Array, right: Array) -> Array:
    """Return X of `matrix` X = `right`, [n, n] and [n, m], by elimination with partial pivoting.

    A singular matrix gives values that are not finite, and no warning.
    """
    count = len(matrix)
    rows = np.hstack((matrix, right))
    with np.errstate(all="ignore"):
        for at in range(count):
            pivot = at + int(np.argmax(np.abs(rows[at:, at])))
            rows[[at, pivot]] = rows[[pivot, at]]
            rows[at] = rows[at] / rows[at, at]
            others = np.arange(count) != at
            rows[others] = rows[others] - rows[others, at : at + 1] * rows[at]
    return rows[:, count:]
