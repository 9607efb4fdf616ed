"""Finds the rules by which a drive's columns are packed: one pass over its blocks, in constant memory. Pure."""

from collections.abc import Iterator, Sequence
from hashlib import blake2b
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.recording.coding import MAX_DELAY, MAX_ORDER, Bits, differences, entropy_bits, length_bits
from simconsole.recording.packing import READABLE, Coded, Constant, Copy, Plain, Rule, Rules

SAMPLE_TICKS: Final = 512
"""Ticks in a row that are kept of a block to choose the coding by."""

MAX_SAMPLES: Final = 8
"""Samples that are measured at least, of a long drive; spread evenly over it, and fewer than twice as many."""

SCREEN_STEP: Final = 8
"""References are screened by every so-many-th tick of the samples; only the best are measured by all of them."""

SCREENED: Final = 2
"""References of each order and delay that are measured."""

MIN_GAIN_BITS: Final = 0.3
"""A reference must shorten a value by so much on average: it makes two columns to read of one."""

NEARLY_COPY_BITS: Final = 1.0
"""A column that costs less beside another says the same: then it is coded even if people read it."""

_START: Final = MAX_ORDER + MAX_DELAY
"""Ticks at the start of a sample that are not measured: there differences reach before it."""


class _Pair(NamedTuple):
    gain_bits: float
    column: int
    rule: Coded
    reference: int


class RuleFinder:
    """Give it every block of a drive in order, then ask for the rules."""

    def __init__(self, columns: Sequence[str]) -> None:
        self._columns = tuple(columns)
        self._first: Bits | None = None
        self._constant = np.ones(len(columns), bool)
        self._hashers = [blake2b(digest_size=16) for _ in columns]
        self._samples: list[Bits] = []
        self._stride = 1  # blocks from one sample to the next
        self._blocks = 0

    def add(self, vectors: NDArray[np.float64]) -> None:
        """Look at a block of state vectors (n, columns), n at least 1."""
        bits = np.ascontiguousarray(vectors.T).view(np.int64)
        if self._first is None:
            self._first = bits[:, 0].copy()
        self._constant &= (bits == self._first[:, None]).all(axis=1)
        for hasher, column in zip(self._hashers, bits, strict=True):
            hasher.update(column)
        if self._blocks % self._stride == 0:
            start = max((bits.shape[1] - SAMPLE_TICKS) // 2, 0)
            self._samples.append(bits[:, start : start + SAMPLE_TICKS].copy())
            if len(self._samples) == 2 * MAX_SAMPLES:
                self._samples = self._samples[::2]
                self._stride *= 2
        self._blocks += 1

    def rules(self) -> dict[str, Rule]:
        """Return a rule for each column, such as hold for all blocks."""
        found: dict[str, Rule] = {}
        seen: dict[bytes, str] = {}
        for index, (name, hasher) in enumerate(zip(self._columns, self._hashers, strict=True)):
            original = seen.setdefault(hasher.digest(), name)
            if self._first is not None and self._constant[index]:
                found[name] = Constant(int(self._first[index]))
            else:
                found[name] = Plain() if original == name else Copy(original)
        return {**found, **self._coded(found)} if self._first is not None else dict.fromkeys(self._columns, Plain())

    def _coded(self, rules: Rules) -> dict[str, Rule]:
        """Return the rules of those of the plain columns that are better coded."""
        kept = [index for index, name in enumerate(self._columns) if isinstance(rules[name], Plain)]
        samples = [sample[kept] for sample in self._samples if sample.shape[1] > _START]
        if not kept or not samples:
            return {}
        names = [self._columns[index] for index in kept]
        orders = _best_orders(samples)
        pairs = _references(samples, names, [cost_bits for cost_bits, _ in orders])
        taken: dict[int, _Pair] = {}
        for pair in sorted(pairs, key=lambda pair: pair.gain_bits, reverse=True):
            if pair.column not in taken and not _leads_to(taken, pair.reference, pair.column):
                taken[pair.column] = pair
        coded = {names[at]: pair.rule for at, pair in taken.items()}
        own = {name: Coded(order) for name, (_, order) in zip(names, orders, strict=True) if order}
        return {**{name: rule for name, rule in own.items() if not name.startswith(READABLE)}, **coded}


def _by_order(samples: Sequence[Bits]) -> Iterator[list[Bits]]:
    """Yield the differences of all columns, order after order from 0 on."""
    parts = list(samples)
    yield parts
    for _ in range(MAX_ORDER):
        parts = [differences(part, 1) for part in parts]
        yield parts


def _in_a_row(parts: Sequence[Bits], delay: int = 0) -> Bits:
    """Return what is measured of all samples, as it was `delay` ticks before: (columns, ticks)."""
    return np.concatenate([part[:, _START - delay : part.shape[1] - delay] for part in parts], axis=1)


def _best_orders(samples: Sequence[Bits]) -> list[tuple[float, int]]:
    """Return of each column the lowest cost in bits and its order, without a reference."""
    costs = [[entropy_bits(column) for column in _in_a_row(parts)] for parts in _by_order(samples)]
    return [min((cost_bits, order) for order, cost_bits in enumerate(each)) for each in zip(*costs, strict=True)]


def _references(samples: Sequence[Bits], names: Sequence[str], costs_bits: Sequence[float]) -> list[_Pair]:
    """Return codings with a reference that cost less than a column does alone, the best of each column and reference.

    Differences of a column less its reference are its differences less those of the reference, for all arithmetic wraps
    around: they are worked out once for each column, not for each pair.
    """
    best: dict[tuple[int, int], _Pair] = {}
    for order, parts in enumerate(_by_order(samples)):
        now = _in_a_row(parts)
        for delay in range(MAX_DELAY + 1):
            then = _in_a_row(parts, delay)
            screen = then[:, ::SCREEN_STEP].copy()
            for at, cost_bits in enumerate(costs_bits):
                if cost_bits < NEARLY_COPY_BITS:
                    continue
                limit = NEARLY_COPY_BITS if names[at].startswith(READABLE) else cost_bits - MIN_GAIN_BITS
                for other in _screened(now[at, ::SCREEN_STEP], screen, at):
                    gain_bits = cost_bits - entropy_bits(now[at] - then[other])
                    worse = (at, other) in best and gain_bits <= best[at, other].gain_bits
                    if cost_bits - gain_bits < limit and not worse:
                        best[at, other] = _Pair(gain_bits, at, Coded(order, names[other], delay), other)
    return list(best.values())


def _screened(column: Bits, others: Bits, at: int) -> list[int]:
    """Return the columns that look the most like `column`, which is number `at` of them."""
    lengths = length_bits(column - others)
    lengths[at] = np.inf
    return [int(other) for other in lengths.argsort()[:SCREENED]]


def _leads_to(coded: dict[int, _Pair], start: int, goal: int) -> bool:
    """Return whether the references from column `start` on come to column `goal`."""
    at: int | None = start
    while at is not None and at != goal:
        at = coded[at].reference if at in coded else None
    return at is not None
