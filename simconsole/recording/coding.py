"""A column as differences of its bit patterns: whole numbers that are small where the column is smooth. Pure.

The 64 bits of a float64, read as a whole number, grow with the value as long as the sign stays: a smooth signal is
smooth in its bits too. So a column is kept as differences of some order of these numbers, less those of another column
that runs alike. All arithmetic wraps around at 64 bits, so that every pattern comes back: NaNs, -0.0 and infinities.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

MAX_ORDER: Final = 7
"""Highest order of differences that is tried; a smooth signal gets shorter up to here, its rounding noise longer."""

MAX_DELAY: Final = 1
"""Ticks that a reference may lie behind: what one stage of the tick does, the next tick's stages start from."""

Bits = NDArray[np.int64]
"""Bit patterns of float64 as whole numbers; time runs along the last axis."""


def differences(bits: Bits, order: int) -> Bits:
    """Return differences of `order`; before its first value a column counts as 0. Undone by as many cumulative sums."""
    for _ in range(order):
        before, bits = bits, bits.copy()
        bits[..., 1:] -= before[..., :-1]
    return bits


def delayed(bits: Bits, delay: int) -> Bits:
    """Return what the column was `delay` ticks before, 0 before its first value."""
    return bits if delay == 0 else np.concatenate([np.zeros_like(bits[..., :delay]), bits[..., :-delay]], axis=-1)


def zigzag(numbers: Bits) -> Bits:
    """Fold the sign into the lowest bit, so that small negative numbers have leading zeros too."""
    folded: Bits = (numbers << 1) ^ (numbers >> 63)
    return folded


def unzigzag(folded: Bits) -> Bits:
    """Undo `zigzag`."""
    numbers: Bits = ((folded.view(np.uint64) >> np.uint64(1)).view(np.int64)) ^ -(folded & 1)
    return numbers


def encode(bits: Bits, order: int, reference: Bits | None = None, delay: int = 0) -> Bits:
    """Return the numbers that stand for a column.

    Args:
        bits: of the column.
        order: of the differences, 0 to MAX_ORDER.
        reference: bits of the column that it is compared with, None for none.
        delay: ticks that the reference lies behind, 0 to MAX_DELAY.
    """
    return zigzag(differences(bits if reference is None else bits - delayed(reference, delay), order))


def decode(numbers: Bits, order: int, reference: Bits | None = None, delay: int = 0) -> Bits:
    """Return the bits of the column that `encode` made `numbers` of, with the same order, reference and delay."""
    bits = unzigzag(numbers)
    for _ in range(order):
        bits = np.cumsum(bits)
    return bits if reference is None else bits + delayed(reference, delay)


def length_bits(numbers: Bits) -> NDArray[np.float64]:
    """Return the mean length in bits of differences along the last axis: a quick look at how small they are."""
    exponents = np.abs(numbers.astype(np.float64)).view(np.int64) >> 52  # of 0.0: 0; of 1.0: 1023
    lengths: NDArray[np.float64] = np.maximum(exponents - 1021, 0).mean(axis=-1)
    return lengths


def entropy_bits(numbers: Bits) -> float:
    """Return the entropy in bits of one of these numbers, as a compressor sees it that takes each byte by itself."""
    total = 0.0
    for plane in np.ascontiguousarray(zigzag(numbers)).view(np.uint8).reshape(-1, 8).T:
        counts = np.bincount(plane)
        shares = counts[counts > 0] / len(plane)
        total -= float((shares * np.log2(shares)).sum())
    return total
