"""Roads as strips: points along a line with height, grade and bank, and how far the road reaches to both sides."""

from collections.abc import Iterable
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.values.numerics.array_functions import heading

Array = NDArray[np.float64]

STEP_M: Final = 1.0
"""Between two points of a strip."""


class Strips(NamedTuple):
    """Points of all roads, float64 [N] each, about STEP_M apart along their lines."""

    x_m: Array
    y_m: Array
    forward_x: Array  # direction of the line
    forward_y: Array
    height_m: Array
    grade: Array  # height per metre ahead
    bank: Array  # height per metre to the left
    left_m: Array  # to the road's edge
    right_m: Array


def strip(line: Array, bank: Array, left_m: float, right_m: float) -> Strips:
    """Return the strip along a line [N, 3] of points about STEP_M apart, banked by [N]."""
    along = np.gradient(line, axis=0)
    step = np.sqrt(along[:, 0] ** 2 + along[:, 1] ** 2)
    return Strips(
        x_m=line[:, 0],
        y_m=line[:, 1],
        forward_x=along[:, 0] / step,
        forward_y=along[:, 1] / step,
        height_m=line[:, 2],
        grade=along[:, 2] / step,
        bank=bank,
        left_m=np.full(len(line), left_m),
        right_m=np.full(len(line), right_m),
    )


def together(parts: Iterable[Strips]) -> Strips:
    """Return strips as one."""
    return Strips(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def evenly(line: Array) -> Array:
    """Return a line [N, 3] with points about STEP_M apart, at least three."""
    way = _way(line)
    keep = np.append(True, np.diff(way) > 0.0)
    count = max(3, round(float(way[-1]) / STEP_M) + 1)
    at = np.linspace(0.0, float(way[-1]), count)
    return np.stack([np.interp(at, way[keep], line[keep, axis]) for axis in range(3)], axis=1)


def rounded(height_m: Array, curve_m: float) -> Array:
    """Return heights [N], STEP_M apart, with every change of grade spread over `curve_m`: a parabolic vertical curve.

    The mean over that length of a line of straight grades is exactly that (AASHTO, Geometric Design of Highways and
    Streets: vertical curves). Both ends keep their height and their grade.
    """
    half = min(round(0.5 * curve_m / STEP_M), len(height_m) - 1)
    if half < 1:
        return height_m
    before = 2.0 * height_m[0] - height_m[half:0:-1]
    after = 2.0 * height_m[-1] - height_m[-2 : -half - 2 : -1]
    total = np.concatenate(((0.0,), np.cumsum(np.concatenate((before, height_m, after)))))
    wide = 2 * half + 1
    return np.asarray((total[wide:] - total[:-wide]) / wide)


def banks(line: Array, most: float, full_radius_m: float, fade_m: float) -> Array:
    """Return the bank [N] of a line [N, 3] STEP_M apart: into the bend, in full from a radius on; none at its ends.

    Junctions are level: towards both ends it fades over `fade_m`.
    """
    window = max(3, 2 * round(0.5 * fade_m / STEP_M) + 1)
    ahead = np.gradient(line[:, :2], axis=0)
    yaw = np.unwrap(heading(ahead[:, 1], ahead[:, 0]))
    curvature = _mean(np.gradient(yaw) / STEP_M, window)
    way = np.arange(len(line)) * STEP_M
    near = np.minimum(way, way[-1] - way) / max(fade_m, STEP_M)
    share = np.clip(near, 0.0, 1.0)
    full = np.clip(curvature * full_radius_m, -1.0, 1.0)
    return np.asarray(-most * full * share * share * (3.0 - 2.0 * share))


def _mean(values: Array, window: int) -> Array:
    """Return the mean over a window about each value; at the ends the window is filled up with the last value."""
    half = window // 2
    padded = np.concatenate((np.full(half, values[0]), values, np.full(half, values[-1])))
    total = np.concatenate(((0.0,), np.cumsum(padded)))
    return np.asarray((total[2 * half + 1 :] - total[: -(2 * half + 1)]) / (2 * half + 1))


def _way(line: Array) -> Array:
    return np.concatenate(((0.0,), np.cumsum(np.sqrt((np.diff(line[:, :2], axis=0) ** 2).sum(axis=1)))))
