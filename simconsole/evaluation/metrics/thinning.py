"""Fewer points for the same picture."""

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.metrics.table import Array


def thinned(values: Array, most: int) -> NDArray[np.int64]:
    """Return at most about `most` ascending indices into `values` that keep its first, last and every extreme.

    The values are cut into bins of equal count; each keeps its smallest and its largest.
    """
    count = len(values)
    if count <= most:
        return np.arange(count)
    bins = max(1, most // 2)
    size = -(-count // bins)
    starts = np.arange(0, count, size)
    whole = values[: count // size * size].reshape(-1, size)
    lowest, highest = whole.argmin(axis=1), whole.argmax(axis=1)
    if len(whole) < len(starts):  # the last bin is shorter; no copy is made to fill it up
        rest = values[starts[-1] :]
        lowest, highest = np.append(lowest, rest.argmin()), np.append(highest, rest.argmax())
    return np.unique(np.concatenate(((0, count - 1), starts + lowest, starts + highest)))


def path_thinned(x: Array, y: Array, step: float) -> NDArray[np.int64]:
    """Return indices of points along a way, about `step` of length apart, first and last included."""
    way = np.cumsum(np.hypot(np.diff(x, prepend=x[0]), np.diff(y, prepend=y[0])))
    marks = np.searchsorted(way, np.arange(0.0, way[-1], step))
    return np.unique(np.concatenate((marks, (0, len(x) - 1))))
