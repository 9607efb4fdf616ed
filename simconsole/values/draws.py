"""Random numbers that depend on seed, channel and tick alone, so that nobody's reading changes what others draw.

The mixing is SplitMix64 (Steele, Lea and Flood, OOPSLA 2014). A normal number is a sum of twelve even ones (Irwin and
Hall): only additions, so that every machine draws the same bits; it never exceeds six standard deviations.
"""

from collections.abc import Callable
from enum import IntEnum
from typing import Final

import numpy as np
from numpy.typing import NDArray

_MASK: Final = (1 << 64) - 1
_SHORT: Final = (1 << 16) - 1
_STEP: Final = 0x9E3779B97F4A7C15
_SCALE: Final = 1.0 / 65536.0
_ROOT_3: Final = 3.0**0.5


class Channel(IntEnum):
    """What a number is drawn for."""

    X = 1
    Y = 2
    YAW = 3
    SPEED = 4
    YAW_RATE = 5
    ACCEL_X = 6
    ACCEL_Y = 7
    DRIFT_X = 8
    DRIFT_Y = 9
    DRIFT_YAW = 10
    JITTER = 11
    LOSS = 12
    PERSON_AIM = 13
    PERSON_HAND = 14
    PERSON_CARE = 15
    WHEEL_SLIP = 16
    LIDAR = 17
    GYRO = 18
    ROBOT_ACCEL_X = 19
    ROBOT_ACCEL_Y = 20
    ROBOT_ACCEL_Z = 21
    ALLOCATION = 22
    MEASUREMENT_JITTER = 23
    MEASUREMENT_LOSS = 24


def _mixed(value: int) -> int:
    value = (value + _STEP) & _MASK
    value = ((value ^ (value >> 30)) * 0xBF58476D1CE4E5B9) & _MASK
    value = ((value ^ (value >> 27)) * 0x94D049BB133111EB) & _MASK
    return value ^ (value >> 31)


def even(seed: int, channel: Channel, number: int) -> float:
    """Return a number evenly between 0 and 1 (excluded)."""
    return (_mixed(_mixed(_mixed(seed) ^ channel) ^ number) >> 11) * 2.0**-53


def normal(seed: int, channel: Channel, number: int) -> float:
    """Return a number of mean 0 and standard deviation 1."""
    bits = _mixed(_mixed(_mixed(seed) ^ channel) ^ number)
    total = 0
    for _ in range(3):
        total += (bits & _SHORT) + (bits >> 16 & _SHORT) + (bits >> 32 & _SHORT) + (bits >> 48)
        bits = _mixed(bits)
    return (total + 6) * _SCALE - 6.0  # the mean of a sixteen-bit number is half a unit below one half


def normals(seed: int, channel: Channel, first: int, count: int) -> NDArray[np.float64]:
    """Return `count` numbers of `normal`, bit for bit, from the one numbered `first` on."""
    with np.errstate(over="ignore"):
        numbers = np.arange(count, dtype=np.uint64) + np.uint64(first & _MASK)
        bits = _all_mixed(np.uint64(_mixed(_mixed(seed) ^ channel)) ^ numbers)
        total = np.zeros(count, dtype=np.int64)
        for _ in range(3):
            for shift in (0, 16, 32, 48):
                total += (bits >> np.uint64(shift) & np.uint64(_SHORT)).astype(np.int64)
            bits = _all_mixed(bits)
    return np.asarray((total + 6) * _SCALE - 6.0, dtype=np.float64)


def _all_mixed(values: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return what `_mixed` makes of each."""
    values = values + np.uint64(_STEP)
    values = (values ^ (values >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    values = (values ^ (values >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return values ^ (values >> np.uint64(31))


def bounded(seed: int, channel: Channel, number: int) -> float:
    """Return a number evenly between -1.73 and 1.73: of mean 0 and standard deviation 1, as `normal`, without tails."""
    return _ROOT_3 * (2.0 * even(seed, channel, number) - 1.0)


def wandering(seed: int, channel: Channel, place: float, draw: Callable[[int, Channel, int], float] = normal) -> float:
    """Return a smooth curve through independent numbers, one at each whole `place` but 0, where it is 0.

    Between two of them it is a cubic without a corner; its standard deviation over a long time is 0.86.
    """
    knot = int(place)
    share = place - knot
    blend = share * share * (3.0 - 2.0 * share)
    before = draw(seed, channel, knot) if knot else 0.0
    return before + blend * (draw(seed, channel, knot + 1) - before)
