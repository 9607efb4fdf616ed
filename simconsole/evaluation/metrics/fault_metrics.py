"""When which fault was on: the bits of `events.faults` as spans. Pure."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from simconsole.evaluation.metrics.table import Drive, runs


class FaultSpan(NamedTuple):
    """A fault from its first tick to its last one."""

    fault: str
    first_tick: int
    last_tick: int


def fault_spans(drive: Drive, names: Sequence[str]) -> list[FaultSpan]:
    """Return every span of every fault, in the order of their first ticks.

    Args:
        drive: The drive.
        names: What the faults of its scenario are called, in their order; a bit without a name is called by its place.
    """
    masks = runs(block[:, 0] for block in drive.read(("events.faults",)))
    edges = np.append(masks.starts, drive.ticks)
    bits = masks.values.astype(np.int64)
    found = []
    for place in range(int(bits.max()).bit_length()):
        on = np.diff((bits >> place & 1).astype(np.int8), prepend=0, append=0)
        name = names[place] if place < len(names) else f"fault {place}"
        for first, after in zip(edges[on > 0].tolist(), edges[on < 0].tolist(), strict=True):
            found.append(FaultSpan(name, drive.first_tick + first, drive.first_tick + after - 1))
    return sorted(found, key=lambda span: (span.first_tick, span.last_tick))


def plain_spans(drive: Drive, names: Sequence[str]) -> list[dict[str, Any]]:
    """Return the spans as plain values, times in s."""
    return [
        {
            **span._asdict(),
            "first_s": span.first_tick / drive.tick_hz,
            "last_s": span.last_tick / drive.tick_hz,
        }
        for span in fault_spans(drive, names)
    ]
