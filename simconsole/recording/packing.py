"""How the columns of a drive are packed: a rule for each of them, found by looking at the whole drive. Pure.

A column is left out where it is one value throughout, or equal to another to the bit. The others are stored: plain, or
coded as simconsole.recording.coding describes. A rule names columns, so that a file that holds the rules needs no more.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

import msgspec
import numpy as np
from numpy.typing import NDArray

from simconsole.recording.coding import MAX_DELAY, MAX_ORDER, Bits, decode, encode

READABLE: Final = (
    *("sample.", "ros.", "ecu.", "events.", "driver.", "command."),
    *("vehicle.x_m", "vehicle.y_m", "vehicle.yaw_rad", "vehicle.vx_mps", "vehicle.gear"),
)
"""How columns begin that people plot: stored plain, so that every program that opens the file can read them. The other
columns of the vehicle, and the platform's inner state, take a third less room coded; what costs nothing plain, as modes
and reasons, is plain as well."""


class Constant(msgspec.Struct, frozen=True, tag="constant", tag_field="rule", forbid_unknown_fields=True):
    """Left out: one value in all ticks, here its bit pattern."""

    bits: int


class Copy(msgspec.Struct, frozen=True, tag="copy", tag_field="rule", forbid_unknown_fields=True):
    """Left out: equal to another column, which is stored."""

    of: str


class Plain(msgspec.Struct, frozen=True, tag="plain", tag_field="rule", forbid_unknown_fields=True):
    """Stored as it is."""


class Coded(msgspec.Struct, frozen=True, tag="coded", tag_field="rule", forbid_unknown_fields=True):
    """Stored as differences of its bit patterns, less those of a reference; a reference is stored too."""

    order: int
    reference: str | None = None
    delay: int = 0


Rule = Constant | Copy | Plain | Coded
Rules = Mapping[str, Rule]
"""Column name to rule, in the order of the state vector."""

Stored = NDArray[Any]
"""A stored column of a block: float64 if it is plain, int64 if it is coded."""


def stored(rules: Rules) -> tuple[str, ...]:
    """Return the columns that are not left out, in the order of the state vector."""
    return tuple(name for name, rule in rules.items() if isinstance(rule, Plain | Coded))


def source_of(rules: Rules, name: str) -> str | None:
    """Return the column that the rule of `name` refers to, None if it needs no other."""
    match rules[name]:
        case Copy(of=source) | Coded(reference=source):
            return source
    return None


def needed(rules: Rules, columns: Iterable[str]) -> tuple[str, ...]:
    """Return the stored columns without which `columns` cannot be had."""
    found = set()
    for name in columns:
        at: str | None = name
        while at is not None and at not in found:
            found.add(at)
            at = source_of(rules, at)
    return tuple(name for name in stored(rules) if name in found)


def problem(rules: Rules) -> str | None:
    """Return why these rules cannot be followed, None if they can."""
    for name, rule in rules.items():
        if isinstance(rule, Coded) and not (0 <= rule.order <= MAX_ORDER and 0 <= rule.delay <= MAX_DELAY):
            return f"{name}: order {rule.order}, delay {rule.delay}: up to {MAX_ORDER} and {MAX_DELAY}"
        passed, at = {name}, source_of(rules, name)
        while at is not None:
            if not isinstance(rules.get(at), Plain | Coded):
                return f"{name}: refers to {at!r}, which is not stored"
            if at in passed:
                return f"{name}: refers to itself"
            passed.add(at)
            at = source_of(rules, at)
    return None


def pack(rules: Rules, vectors: NDArray[np.float64]) -> dict[str, Stored]:
    """Return what is stored of a block of state vectors (n, columns), by column: float64 if plain, int64 if coded."""
    columns = dict(zip(rules, np.ascontiguousarray(vectors.T), strict=True))
    found: dict[str, Stored] = {}
    for name in stored(rules):
        rule, values = rules[name], columns[name]
        if isinstance(rule, Coded):
            reference = None if rule.reference is None else columns[rule.reference].view(np.int64)
            found[name] = encode(values.view(np.int64), rule.order, reference, rule.delay)
        else:
            found[name] = values
    return found


def unpack(rules: Rules, kept: Mapping[str, Stored], columns: Sequence[str], ticks: int) -> NDArray[np.float64]:
    """Return a block of `ticks` rows of these columns (ticks, columns) from the stored columns that they need."""
    known: dict[str, Bits] = {}
    found = np.empty((ticks, len(columns)))
    for index, name in enumerate(columns):
        found[:, index] = _bits(rules, kept, name, ticks, known).view(np.float64)
    return found


def _bits(rules: Rules, kept: Mapping[str, Stored], name: str, ticks: int, known: dict[str, Bits]) -> Bits:
    """Return the bits of a column, and keep it in `known` beside those that it refers to."""
    if name in known:
        return known[name]
    source = source_of(rules, name)
    reference = None if source is None else _bits(rules, kept, source, ticks, known)
    match rules[name]:
        case Constant(bits=bits):
            found = np.full(ticks, bits, np.int64)
        case Coded(order=order, delay=delay):
            found = decode(kept[name], order, reference, delay)
        case _:
            found = kept[name].view(np.int64) if reference is None else reference
    known[name] = found
    return found
