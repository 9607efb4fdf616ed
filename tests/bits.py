"""Arrays compared to the bit; a difference is told in one line, where pytest would compare megabytes by text."""

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

TOLD: Final = 5


def difference(one: NDArray[Any], other: NDArray[Any], names: Sequence[str] = ()) -> str:
    """Return where two arrays first differ and by what, "" if they are the same bytes; -0.0 is not 0.0.

    `names` are those of the columns (the last axis).
    """
    if (one.shape, one.dtype) != (other.shape, other.dtype):
        return f"{one.dtype} of shape {one.shape} and {other.dtype} of shape {other.shape}"
    if one.tobytes() == other.tobytes():
        return ""
    raw = [np.ascontiguousarray(array).view(np.uint8).reshape(array.size, -1) for array in (one, other)]
    unlike = np.flatnonzero((raw[0] != raw[1]).any(axis=1))
    places = [np.unravel_index(flat, one.shape) for flat in unlike[:TOLD]]
    told = (f"{_place(place, names)}: {one[place]!r} and {other[place]!r}" for place in places)
    return f"{len(unlike)} of {one.size} values differ; {', '.join(told)}"


def _place(place: tuple[Any, ...], names: Sequence[str]) -> str:
    last = int(place[-1])
    return ", ".join([*(str(int(at)) for at in place[:-1]), names[last] if last < len(names) else str(last)])
