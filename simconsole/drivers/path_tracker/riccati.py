"""Discrete linear-quadratic design in sums of one order: exponential, Riccati equation, preview gains."""

from typing import Final, NamedTuple

import numpy as np

from simconsole.drivers.path_tracker.matrices import Array, product, solved

_TERMS: Final = 12
_DOUBLINGS: Final = 40
_SETTLED: Final = 1e-12
_DIVERGED: Final = 1e60


class Gains(NamedTuple):
    """u = -feedback @ x - preview @ w, with w[j] the known disturbance j periods ahead."""

    feedback: Array  # [n]
    preview: Array  # [N]


def exponential(matrix: Array) -> Array:
    """Return the matrix exponential by scaling and squaring of the Taylor series (norm below 1/2: error 1e-16)."""
    norm = float(np.abs(matrix).sum(axis=1).max())
    squarings = max(0, int(np.ceil(np.log2(norm))) + 1) if norm > 0.0 else 0
    scaled = matrix / 2.0**squarings
    result = term = np.eye(len(matrix))
    for order in range(1, _TERMS + 1):
        term = product(term, scaled) / order
        result = result + term
    for _ in range(squarings):
        result = product(result, result)
    return result


def discretised(a: Array, b: Array, duration_s: float) -> tuple[Array, Array]:
    """Return (A, B) of x' = a x + b u with u [n, m] held constant for `duration_s`, in s."""
    n, m = b.shape
    block = np.zeros((n + m, n + m))
    block[:n, :n], block[:n, n:] = a, b
    result = exponential(block * duration_s)
    return result[:n, :n], result[:n, n:]


def riccati(a: Array, b: Array, q: Array, r: float) -> Array:
    """Return the stabilising P of P = A'PA - A'PB (r + B'PB)^-1 B'PA + Q, b of shape [n, 1].

    Structure-preserving doubling algorithm (Chu, Fan, Lin and Wang, Int. J. Control 77(8), 2004).

    Raises ValueError when it does not settle: the pair is not stabilisable.
    """
    eye = np.eye(len(a))
    g, h = product(b, b.T) / r, q
    for _ in range(_DOUBLINGS):
        inner = solved(eye + product(g, h), np.hstack((a, g)))
        wa, wg = inner[:, : len(a)], inner[:, len(a) :]
        if not float(np.abs(inner).max()) < _DIVERGED:
            break
        after = h + product(a.T, h, wa)
        g, a = g + product(a, wg, a.T), product(a, wa)
        moved, h = float(np.abs(after - h).max()), 0.5 * (after + after.T)
        if moved <= _SETTLED * float(np.abs(h).max()):
            return h
    raise ValueError("the Riccati equation has no stabilising solution")


def design(a: Array, b: Array, d: Array, q: Array, r: float, steps: int) -> Gains:
    """Return the gains that minimise sum x'Qx + r u^2 of x+ = A x + b u + d w, with w known `steps` ahead.

    Shapes: a [n, n], b and d [n, 1]. Preview by the closed loop's costate (Tomizuka, J. Dyn. Sys. 97(2), 1975).
    """
    p = riccati(a, b, q, r)
    weight = r + float(product(b.T, p, b)[0, 0])
    feedback = (product(b.T, p, a) / weight)[0]
    loop = a - b * feedback
    costate, preview = product(p, d), []
    for _ in range(steps):
        preview.append(float(product(b.T, costate)[0, 0]) / weight)
        costate = product(loop.T, costate)
    return Gains(feedback, np.array(preview))
