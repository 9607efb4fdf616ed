"""Checks that look at a whole drive: the order of its modes, and the figures of its metrics."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.table import Drive, runs
from simconsole.profiles.faults import ModeName, fault_label
from simconsole.profiles.scenario import MetricCheck
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.signals import Mode
from simconsole.world.kinds.worlds import open_world


def judge_modes(wanted: Sequence[ModeName], driven: Sequence[tuple[int, int]]) -> list[str]:
    """Return what is wrong with the order of modes, nothing where none is asked for.

    Args:
        wanted: the modes in their order.
        driven: those of the drive, each with the tick at which it began.
    """
    names = [Mode(mode).name.lower() for _, mode in driven]
    if not wanted or names == list(wanted):
        return []
    at = next(
        (place for place, (one, two) in enumerate(zip(wanted, names, strict=False)) if one != two),
        min(len(wanted), len(names)),
    )
    if at < len(names):
        told = f"tick {driven[at][0]}: {names[at]}, not {wanted[at] if at < len(wanted) else 'any more'}"
    else:
        told = f"{wanted[at]} did not come"
    return [f"modes: {told}; driven {', '.join(names)}"]


def modes_of(drive: Drive) -> list[tuple[int, int]]:
    """Return the modes of a drive in their order, each with the tick at which it began."""
    found = runs(block[:, 0] for block in drive.read(("arbitration.mode",)))
    return [(drive.first_tick + int(at), int(mode)) for at, mode in zip(found.starts, found.values, strict=True)]


def judge_metrics(checks: Sequence[MetricCheck], found: Mapping[str, float]) -> list[str]:
    """Return what is wrong with the figures of a drive's metrics; one that there is not is wrong, too."""
    problems = []
    for check in checks:
        if check.metric not in found:
            problems.append(f"metrics: the drive has no {check.metric}; it has {', '.join(sorted(found))}")
            continue
        low = -math.inf if check.min is None else check.min
        high = math.inf if check.max is None else check.max
        value = found[check.metric]
        if not low <= value <= high:  # so that NaN always fails
            problems.append(f"{check.metric}: {value:.6g} not in {low:g} to {high:g}")
    return problems


def numbers_of(drive: Drive, resolved: ResolvedSession) -> Iterator[tuple[str, float]]:
    """Yield the numbers of a drive's metrics by dotted name."""
    route = None if resolved.world is None else open_world(resolved.world).route
    faults = [fault_label(fault) for fault in resolved.session.scenario.faults]
    yield from numbers(metrics(drive, route, faults=faults))


def numbers(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, float]]:
    """Yield the numbers of nested plain values by dotted name; of a list how many it has (`mode_changes.count`)."""
    for key, value in values.items():
        name = f"{prefix}{key}"
        if isinstance(value, Mapping):
            yield from numbers(value, f"{name}.")
        elif isinstance(value, (list, tuple)):
            yield f"{name}.count", float(len(value))
        elif isinstance(value, (int, float)):
            yield name, float(value)
